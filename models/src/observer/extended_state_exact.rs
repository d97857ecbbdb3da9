//! Linear extended state observer in discrete time without discretisation error: measurement and input held over a
//! sample (zero-order hold).
//!
//! With M = A - L C of (11) and (12) the predictor is
//!
//! ```text
//! z+ = exp(M T) z + S (B u + L y),      S = integral of exp(M s) over 0 .. T,      exp(M T) = I + M S
//! ```
//!
//! stable for any T. Its estimate at a sample uses the samples before. The current form predicts with the plain model
//! and corrects with the newest sample (Miklosovic, Radke, Gao 2006, "Discrete implementation and generalization of the
//! extended state observer"), with gains that give it the same poles:
//!
//! ```text
//! z- = exp(A T) z + (b T^2/2, b T, 0) u        z = z- + G (y - z1-)
//! ```

use super::extended_state::{ExtendedState, Gains};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Terms of the Taylor series of S for a scaled step of at most a half in the maximum norm: remainder below 1e-18.
const TERMS: u32 = 16;
/// Largest scaled step, for a matrix with a norm of at most 2.
const LARGEST_STEP: f64 = 0.25;
/// Doublings up to which S is computed, from 1e-300 to 1e300 in one sample.
const MAX_DOUBLINGS: u32 = 2000;
/// Doublings for which exp(N h) = I + N S loses no more than some last digits. Each takes two bits of what is left of the
/// exponential by the difference of ever larger numbers; beyond, the exponential is squared instead.
const DIRECT_DOUBLINGS: u32 = 4;

/// S, and exp(M T).
struct Transition {
    integral: Matrix3<f64>,
    exponential: Matrix3<f64>,
}

/// Scaling and squaring. In the coordinates z1, z2/w, z3/w^2 and the time w t, with w = max(L1, L2^(1/2), L3^(1/3), 1/T),
/// all elements of the matrix N are at most 1; S doubles as S(2h) = S(h) + exp(N h) S(h).
fn transition(gains: Gains, duration: f64) -> Transition {
    let [first, second, third] = gains;
    let rate = first.abs().max(second.abs().sqrt()).max(libm::cbrt(third.abs())).max(1.0 / duration);
    let scaled = [first / rate, second / rate / rate, third / rate / rate / rate];
    // N X for the companion matrix N: three products per column.
    let times = |x: &Matrix3<f64>| {
        Matrix3::from_fn(|row, column| {
            let next = if row < 2 { x[(row + 1, column)] } else { 0.0 };
            next - scaled[row] * x[(0, column)]
        })
    };
    let mut step = rate * duration;
    let mut doublings = 0;
    while step > LARGEST_STEP && doublings < MAX_DOUBLINGS {
        step *= 0.5;
        doublings += 1;
    }
    // Horner: S = h (I + N h/2 (I + N h/3 (I + ...))).
    let mut integral = Matrix3::identity();
    for term in (2..=TERMS).rev() {
        integral = Matrix3::identity() + times(&integral) * (step / f64::from(term));
    }
    integral *= step;
    let mut exponential = Matrix3::identity() + times(&integral);
    for doubling in 0..doublings {
        integral += exponential * integral;
        exponential = if doubling < DIRECT_DOUBLINGS {
            Matrix3::identity() + times(&integral)
        } else {
            exponential * exponential
        };
    }
    // Back to z1, z2, z3 and t.
    let powers = [1.0, rate, rate * rate];
    let back = |x: Matrix3<f64>, factor: f64| {
        Matrix3::from_fn(|row, column| x[(row, column)] * powers[row] / powers[column] * factor)
    };
    Transition { integral: back(integral, 1.0 / rate), exponential: back(exponential, 1.0) }
}

/// One sample of the predictor: z+ = Ad z + Bd (u, y).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExactPredictor {
    /// Ad, row by row.
    pub transition: [[f64; 3]; 3],
    /// First column of Bd.
    pub input: [f64; 3],
    /// Second column of Bd.
    pub measurement: [f64; 3],
}

impl ExactPredictor {
    /// For gains L of (11), an input gain b \[y/(s2 V)\] and a sample time \[s\].
    pub fn new(gains: Gains, input_gain: f64, sample_time: f64) -> Self {
        let Transition { integral, exponential } = transition(gains, sample_time);
        let measurement = integral * Vector3::from(gains);
        let input = integral.column(1) * input_gain;
        let row = |row: usize| [exponential[(row, 0)], exponential[(row, 1)], exponential[(row, 2)]];
        Self { transition: [row(0), row(1), row(2)], input: input.into(), measurement: measurement.into() }
    }

    /// The estimate after a sample with held measurement and input \[V\].
    #[inline(always)]
    pub fn step(&self, z: ExtendedState, measurement: f64, input: f64) -> ExtendedState {
        let row = |row: usize| {
            let [first, second, third] = self.transition[row];
            first * z.position
                + second * z.velocity
                + third * z.extended
                + (self.input[row] * input + self.measurement[row] * measurement)
        };
        ExtendedState { position: row(0), velocity: row(1), extended: row(2) }
    }
}

/// One sample of the current form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExactCorrector {
    /// G, in 1, 1/s, 1/s2.
    pub gains: [f64; 3],
    input_gain: f64,
    sample_time: f64,
}

impl ExactCorrector {
    /// With the poles exp(M T) of the predictor with gains L of (11). Of their characteristic polynomial
    /// s^3 - c1 s^2 + c2 s - c3 the gains are
    ///
    /// ```text
    /// G1 = 1 - c3      G3 = (1 - c1 + c2 - c3) / T^2      G2 = (3 - c1 - G1) / T - G3 T / 2
    /// ```
    ///
    /// computed without the cancellation: c3 = exp(-L1 T), det(I - exp(M T)) = L3 det S, 3 - c1 = -tr(M S).
    pub fn new(gains: Gains, input_gain: f64, sample_time: f64) -> Self {
        let [first, second, third] = gains;
        let s = transition(gains, sample_time).integral;
        let trace = first * s[(0, 0)] + second * s[(0, 1)] + third * s[(0, 2)] - s[(1, 0)] - s[(2, 1)];
        let position = -libm::expm1(-first * sample_time);
        // Row by row divided by T, as det S is of the order T^3.
        let extended = third * sample_time * (s / sample_time).determinant();
        let velocity = (trace - position) / sample_time - 0.5 * extended * sample_time;
        Self { gains: [position, velocity, extended], input_gain, sample_time }
    }

    /// The estimate at the end of a sample with held input \[V\], with the measurement at that end.
    #[inline(always)]
    pub fn step(&self, z: ExtendedState, measurement: f64, input: f64) -> ExtendedState {
        let predicted = predict(z, self.input_gain * input, self.sample_time);
        correct(predicted, self.gains, measurement - predicted.position)
    }
}

/// z- of the plain model with a constant acceleration `driven` = b u \[y/s2\] beside the extended state.
#[inline(always)]
pub fn predict(z: ExtendedState, driven: f64, duration: f64) -> ExtendedState {
    let acceleration = z.extended + driven;
    ExtendedState {
        position: z.position + duration * (z.velocity + 0.5 * duration * acceleration),
        velocity: z.velocity + duration * acceleration,
        extended: z.extended,
    }
}

/// z- + G e
#[inline(always)]
pub fn correct(z: ExtendedState, [position, velocity, extended]: [f64; 3], error: f64) -> ExtendedState {
    z.plus(error, ExtendedState { position, velocity, extended })
}

#[cfg(test)]
mod tests {
    use super::super::extended_state::{ExtendedStateModel, LinearInjection, gains_from_bandwidth};
    use super::*;
    use proptest::prelude::*;

    fn relative(value: f64, expected: f64) -> f64 {
        (value / expected - 1.0).abs()
    }

    /// exp(M T) for the triple eigenvalue -w: e^-tau (I + N + N^2 / 2) with N = M T + tau I, which is nilpotent.
    fn triple_eigenvalue(bandwidth: f64, duration: f64) -> Matrix3<f64> {
        let [l1, l2, l3] = gains_from_bandwidth(bandwidth);
        let m = Matrix3::new(-l1, 1.0, 0.0, -l2, 0.0, 1.0, -l3, 0.0, 0.0);
        let n = (m + Matrix3::identity() * bandwidth) * duration;
        (Matrix3::identity() + n + n * n * 0.5) * libm::exp(-bandwidth * duration)
    }

    proptest! {
        #[test]
        fn triple_eigenvalue_has_a_closed_form(bandwidth in 1.0..3000.0f64, duration in 1e-5..2e-2f64) {
            let computed = ExactPredictor::new(gains_from_bandwidth(bandwidth), 1.0, duration).transition;
            let closed = triple_eigenvalue(bandwidth, duration);
            for row in 0..3 {
                for column in 0..3 {
                    // In the scaled coordinates, where all elements are of the same order.
                    let scale = libm::pow(bandwidth, row as f64 - column as f64);
                    let difference = (computed[row][column] - closed[(row, column)]) / scale;
                    prop_assert!(difference.abs() < 2e-13, "{row} {column}: {difference:e}");
                }
            }
        }

        #[test]
        fn any_gains_agree_with_fine_runge_kutta(
            first in 0.0..600.0f64, second in 0.0..1e5f64, third in 0.0..1e7f64, b in -4e3..4e3f64,
        ) {
            let gains = [first, second, third];
            let model = ExtendedStateModel { injection: LinearInjection { gains }, input_gain: b };
            let z = ExtendedState { position: 0.2, velocity: -3.0, extended: 500.0 };
            let exact = ExactPredictor::new(gains, b, 1e-3).step(z, -0.4, 0.8);
            let fine = model.runge_kutta(z, (-0.4, -0.4), 0.8, 1e-3, 400);
            prop_assert!((exact.position - fine.position).abs() < 1e-12);
            prop_assert!((exact.velocity - fine.velocity).abs() < 1e-10);
            prop_assert!((exact.extended - fine.extended).abs() < 1e-8);
        }

        #[test]
        fn current_form_has_the_predictors_poles(
            first in 1.0..600.0f64, second in 0.0..1e5f64, third in 0.0..1e7f64,
        ) {
            let gains = [first, second, third];
            let predictor = Matrix3::from(ExactPredictor::new(gains, 1.0, 1e-3).transition).transpose();
            // Column by column from unit vectors.
            let corrector = ExactCorrector::new(gains, 1.0, 1e-3);
            let column = |position, velocity, extended| {
                let z = corrector.step(ExtendedState { position, velocity, extended }, 0.0, 0.0);
                Vector3::new(z.position, z.velocity, z.extended)
            };
            let current = Matrix3::from_columns(&[
                column(1.0, 0.0, 0.0), column(0.0, 1.0, 0.0), column(0.0, 0.0, 1.0),
            ]);
            let invariants = |m: &Matrix3<f64>| [m.trace(), (m * m).trace(), m.determinant()];
            for (own, other) in invariants(&predictor).iter().zip(invariants(&current)) {
                prop_assert!((own - other).abs() < 1e-10, "{own} {other}");
            }
        }

        #[test]
        fn current_gains_of_a_triple_pole_have_a_closed_form(bandwidth in 1.0..3000.0f64, duration in 1e-5..5e-3f64) {
            let gains = ExactCorrector::new(gains_from_bandwidth(bandwidth), 1.0, duration).gains;
            let (p, q) = (libm::exp(-bandwidth * duration), -libm::expm1(-bandwidth * duration));
            let closed = [
                -libm::expm1(-3.0 * bandwidth * duration),
                1.5 * q * q * (1.0 + p) / duration,
                q * q * q / (duration * duration),
            ];
            prop_assert!(relative(gains[0], closed[0]) < 1e-12);
            prop_assert!(relative(gains[1], closed[1]) < 1e-15 / (bandwidth * duration) + 1e-12);
            prop_assert!(relative(gains[2], closed[2]) < 1e-11);
        }
    }

    /// Asserts where an observer comes to in a sample of `duration` \[s\] whose first gain, of these powers of 10, dwarfs the
    /// others; nothing where it does not.
    fn assert_follows(powers: [f64; 3], duration: f64) {
        // As those of a nonlinear injection, frozen at a large error.
        let gains = powers.map(|power| libm::pow(10.0, power));
        // Within the sample the first gain has done its work and the others have hardly begun.
        let has_settled = gains[0] * duration > 40.0 && gains[1] * duration < 1e-2 * gains[0];
        if !has_settled || gains[2] * duration * duration >= 1e-2 * gains[0] {
            return;
        }
        let z = ExactPredictor::new(gains, 0.0, duration).step(ExtendedState::default(), 1.0, 0.0);
        assert!((z.position - 1.0).abs() < 1e-1, "{gains:?} {z:?}");
        // By the first gain what is left of the error is 1 / gains[0], of which the others make the rest; or the last
        // digits of the position, 1, if they are more.
        let rest = gains[1] + gains[2] * duration;
        let (velocity, rounding) = (rest / gains[0], 16.0 * f64::EPSILON * rest * duration);
        assert!((z.velocity - velocity).abs() < 1e-1 * velocity + rounding, "{gains:?} {z:?}");
    }

    proptest! {
        #[test]
        fn gains_far_beyond_the_sample_rate_follow_the_measurement(
            first in 3.0..14.0f64, second in -2.0..6.0f64, third in -3.0..7.0f64, duration in 1e-6..1.0f64,
        ) {
            assert_follows([first, second, third], duration);
        }
    }

    #[test]
    fn a_first_gain_near_the_last_digit_follows_but_for_rounding() {
        assert_follows(
            [13.990_980_419_506_375, 4.859_884_790_348_056, 3.007_014_442_728_235_2],
            0.925_733_680_020_041_7,
        );
    }

    #[test]
    fn extreme_gains_stay_finite() {
        for gains in [[0.0; 3], gains_from_bandwidth(1e-6), gains_from_bandwidth(1e6)] {
            for duration in [1e-6, 1.0] {
                let z = ExactPredictor::new(gains, 1.0, duration).step(ExtendedState::default(), 1.0, 1.0);
                assert!(z.largest_magnitude() < 1e13, "{gains:?} {duration}: {z:?}");
                let gains = ExactCorrector::new(gains, 1.0, duration).gains;
                assert!(gains.iter().all(|gain| gain.is_finite()), "{gains:?}");
            }
        }
    }
}
