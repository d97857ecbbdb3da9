//! State estimators, one per file, and what they share.

pub mod ball_observer;
mod ball_observer_settings;
mod bearing_observer;
mod current_course;
pub mod drem;
mod estimate;
pub mod extended_state;
pub mod extended_state_exact;
pub mod factored_covariance;
pub mod fal;
pub mod flux_regression;
pub mod gauss_newton;
pub mod kalman;
pub mod kalman_filter;
mod least_squares_window;
pub mod newton;
mod newton_settings;
pub mod polynomial_newton;
pub mod process_model;
pub mod reduced_newton;
pub mod rig_kalman;
pub mod rig_measurement;
pub mod rig_model;
pub mod rig_observer;
mod sample_window;
pub mod sampled_extended_state;
mod saved_count;
mod square_window;
mod step_length;
pub mod windowed_newton;

pub use bearing_observer::{BearingObserver, BearingObserverSettings};
pub use estimate::Estimate;
use estimate::{CONVERGED, largest_magnitude};
