//! Dynamic regressor extension and mixing (DREM) for the flux offset: equations (10) to (13) and Proposition 6 of
//! "Sensorless control of the levitated ball".
//!
//! The regression theta^5 + c4 theta^4 + ... + c0 = 0 goes through four filters H_j = p / (p + b_j), which remove the
//! constant theta^5. What is left is linear in theta, theta^2, theta^3, theta^4:
//!
//! ```text
//! sum_q H_j[c_q] theta^q = -H_j[c_0]      j, q = 1..4
//! ```
//!
//! and Cramer's rule for theta alone: Delta theta = Q with Delta = kappa det(H_j\[c_q\]) and Q the same determinant with
//! the right side as its first column. The paper's gradient theta^' = gamma Delta (Q - Delta theta^) is solved exactly over
//! a sample, because gamma Delta^2 spans ten decades.

use crate::signal::FirstOrderHold;
use serde::{Deserialize, Serialize};

/// Gain and scale of the mixed equation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MixingSettings {
    /// gamma \[1/s\]
    pub gain: f64,
    /// kappa, brings Delta to the order of one
    pub excitation_scale: f64,
}

/// Delta theta = Q.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MixedEquation {
    /// Delta
    pub excitation: f64,
    /// Q
    pub right_side: f64,
}

impl MixedEquation {
    /// The estimate of theta after `sample_time` \[s\] of the gradient.
    #[inline]
    pub fn improve(&self, settings: &MixingSettings, estimate: f64, sample_time: f64) -> f64 {
        let excitation = settings.excitation_scale * self.excitation;
        let right_side = settings.excitation_scale * self.right_side;
        let exponent = settings.gain * excitation * excitation * sample_time;
        // (1 - e^-a) / a
        let share = if exponent > 1e-8 { -libm::expm1(-exponent) / exponent } else { 1.0 - 0.5 * exponent };
        estimate + settings.gain * sample_time * share * excitation * (right_side - excitation * estimate)
    }
}

/// Gain of the gradient divided by `level`^2 + Delta^2, a common remedy against a Delta that spans decades; not in the
/// paper.
#[inline]
pub fn normalised(settings: &MixingSettings, level: f64, equation: &MixedEquation) -> MixingSettings {
    let excitation = settings.excitation_scale * equation.excitation;
    let scale = level * level + excitation * excitation;
    MixingSettings { gain: if scale > 0.0 { settings.gain / scale } else { 0.0 }, ..*settings }
}

/// The twenty low-passes by which the four filters are realised: H_j\[c\] = c - b_j / (p + b_j) \[c\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drem {
    /// By filter, then by coefficient.
    low_passes: [[f64; 5]; 4],
    coefficients: [f64; 5],
}

impl Drem {
    /// Filters that have seen nothing but `coefficients`, so that they put out zero.
    pub fn at_rest(coefficients: [f64; 5]) -> Self {
        Self { low_passes: [coefficients; 4], coefficients }
    }

    /// Filters that start from zero, so that they take the first coefficients for a jump.
    pub fn from_zero(coefficients: [f64; 5]) -> Self {
        Self { low_passes: [[0.0; 5]; 4], coefficients }
    }

    /// Goes on to the next `coefficients`, with the low-passes over the time since the last ones.
    #[inline]
    pub fn advance(&mut self, holds: &[FirstOrderHold; 4], coefficients: [f64; 5]) {
        for (states, hold) in self.low_passes.iter_mut().zip(holds) {
            for ((state, past), present) in states.iter_mut().zip(self.coefficients).zip(coefficients) {
                *state = hold.after(*state, past, present);
            }
        }
        self.coefficients = coefficients;
    }

    /// H_j\[c_q\], by filter, then by coefficient c0 to c4.
    #[inline]
    pub fn filtered(&self) -> [[f64; 5]; 4] {
        self.low_passes.map(|states| core::array::from_fn(|q| self.coefficients[q] - states[q]))
    }

    /// The mixed equation at the newest sample, without the scale kappa.
    #[inline]
    pub fn mix(&self) -> MixedEquation {
        let rows = self.filtered();
        // Minors of the columns c3, c4, then of c2, c3, c4.
        let pair = |i: usize, j: usize| rows[i][3] * rows[j][4] - rows[j][3] * rows[i][4];
        let pairs = [pair(0, 1), pair(0, 2), pair(0, 3), pair(1, 2), pair(1, 3), pair(2, 3)];
        let [p01, p02, p03, p12, p13, p23] = pairs;
        let c2 = rows.map(|row| row[2]);
        let cofactors = [
            c2[1] * p23 - c2[2] * p13 + c2[3] * p12,
            -(c2[0] * p23 - c2[2] * p03 + c2[3] * p02),
            c2[0] * p13 - c2[1] * p03 + c2[3] * p01,
            -(c2[0] * p12 - c2[1] * p02 + c2[2] * p01),
        ];
        let expand =
            |column: usize| -> f64 { rows.iter().zip(cofactors).map(|(row, c)| row[column] * c).sum() };
        MixedEquation { excitation: expand(1), right_side: -expand(0) }
    }
}
