//! Estimates of the magnetic bearing's state.

use crate::plant::magnetic_bearing::State;

/// Relative size of the last flux correction up to which an estimate counts as converged.
pub(super) const CONVERGED: f64 = 1e-6;

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
pub(super) fn largest_magnitude<const N: usize>(differences: [f64; N]) -> f64 {
    let larger = |largest: f64, difference: &f64| {
        let magnitude = difference.abs();
        if magnitude > largest { magnitude } else { largest }
    };
    differences.iter().fold(0.0, larger).min(f64::MAX)
}
