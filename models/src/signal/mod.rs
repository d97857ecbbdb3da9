//! Signals around a plant: noise and quantisation of sensors, low-passes, references.

mod ball_reference_filter;
mod first_order_hold;
mod noise;
pub mod reference_filter;
mod sensor;

pub use ball_reference_filter::{BallReferenceFilter, SmoothReference};
pub use first_order_hold::FirstOrderHold;
pub use noise::GaussianNoise;
pub use sensor::quantise;
