//! Signals around a plant: noise and quantisation of sensors, low-passes, references.

mod ball_reference;
mod first_order_hold;
mod noise;
mod reference_filter;
mod sensor;

pub use ball_reference::BallReference;
pub use first_order_hold::FirstOrderHold;
pub use noise::GaussianNoise;
pub use reference_filter::{ReferenceFilter, SmoothReference};
pub use sensor::quantise;
