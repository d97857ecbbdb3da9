//! State estimators, one per file, and what they share.

pub mod ball_observer;
mod ball_observer_settings;
mod bearing_observer;
mod current_course;
pub mod drem;
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

use crate::plant::magnetic_bearing::State;

/// Relative size of the last flux correction up to which an estimate counts as converged.
const CONVERGED: f64 = 1e-6;

/// Result of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// State at the newest sample.
    pub state: State,
    /// Largest component of Y - H(w) \[m\] after the last iteration, of the reduced-order observer the residual of
    /// (7), of the Kalman filter the size of the innovation.
    pub residual: f64,
    /// Iterations made, at most d.
    pub iterations: u32,
    /// Whether the last iteration still moved the flux by less than a millionth of its size; of the Kalman filter
    /// whether the innovation fits its standard deviation.
    pub converged: bool,
}

/// Maximum norm of finite numbers' differences, finite also when one overflows.
#[inline]
fn largest_magnitude<const N: usize>(differences: [f64; N]) -> f64 {
    let larger = |largest: f64, difference: &f64| {
        let magnitude = difference.abs();
        if magnitude > largest { magnitude } else { largest }
    };
    differences.iter().fold(0.0, larger).min(f64::MAX)
}
