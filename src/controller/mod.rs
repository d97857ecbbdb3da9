//! Control laws, one family per file.

pub mod bearing_feedback;
pub mod flux_cascade;
mod saturation;

pub use saturation::saturate;
