//! Signals around a plant: noise and quantisation of sensors.

mod noise;
pub mod reference_filter;
mod sensor;

pub use noise::GaussianNoise;
pub use sensor::quantise;
