//! Flux offset from the polynomial regression itself, a damped Newton iteration in time instead of DREM. Beyond the paper.
//!
//! ```text
//! theta^' = -G sat(f(theta^) / max(f'(theta^), 0.3)),   f = theta^5 + c4 theta^4 + ... + c0
//! ```
//!
//! At rest f = l^5 - l^3 with f' = 2 at l = 1: no excitation is needed. The other roots at rest are l = 0 and l = -1; the
//! floor of the slope keeps the sign of the step right for every l > 0. The speed is limited to G / 5.
//!
//! What drives the flux apart from the integral of the induced voltage, a wrong resistance or an offset of the voltage, appears
//! as an offset that wanders. An integral term d with d' = -G_I sat(f / f') learns it; with G_I = (G / 2)^2 both errors
//! decay as a double pole at -G / 2.

use super::flux_regression::residual_and_slope;

/// Smallest slope that divides the residual; it is 2 at rest.
const SMALLEST_SLOPE: f64 = 0.3;
/// Largest correction of the normalised flux that a sample may ask for.
const LARGEST_CORRECTION: f64 = 0.2;

/// Correction the regression asks for at the offset `estimate`, the negative of Newton's step, limited.
#[inline]
pub fn limited_error(coefficients: &[f64; 5], estimate: f64) -> f64 {
    let (residual, slope) = residual_and_slope(coefficients, estimate);
    // Compared in this order NaN passes, for the caller to see.
    (residual / slope.max(SMALLEST_SLOPE)).clamp(-LARGEST_CORRECTION, LARGEST_CORRECTION)
}
