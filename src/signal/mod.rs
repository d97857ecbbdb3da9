//! Signals around a plant: noise and quantisation of sensors.

mod noise;
mod sensor;

pub use noise::GaussianNoise;
pub use sensor::quantise;
