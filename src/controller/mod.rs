//! Control laws, one family per file.

pub mod bearing_feedback;
mod saturation;

pub use saturation::saturate;
