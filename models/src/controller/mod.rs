//! Control laws, one family per file.

pub mod ball_feedback_linearisation;
pub mod bearing_feedback;
mod bearing_law;
pub mod digital_pid;
pub mod disturbance_rejection;
pub mod flux_cascade;
mod saturation;

pub use bearing_law::BearingLaw;
pub use saturation::{saturate, saturate_between};
