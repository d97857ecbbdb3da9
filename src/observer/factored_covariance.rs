//! Covariance of (position, velocity, flux) as P = U D U^T, U unit upper triangular and D diagonal.
//!
//! The factors are updated, never P: every new diagonal element is a sum or a quotient of non-negative numbers, so
//! P cannot lose its symmetry or its sign to round-off, whatever the ratio of P to the measurement's variance.
//!
//! G. J. Bierman, *Factorization Methods for Discrete Sequential Estimation*, 1977: chapter V for the measurement,
//! chapter VI and Agee-Turner's rank-one update for the process noise. No square root is needed.

use crate::plant::magnetic_bearing::ForceEffect;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// U and D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FactoredCovariance {
    /// Diagonal of D, in m2, m2/s2, Wb2.
    diagonal: [f64; 3],
    /// U12 \[s\]
    position_velocity: f64,
    /// U13 \[m/Wb\]
    position_flux: f64,
    /// U23 \[m/(s Wb)\]
    velocity_flux: f64,
}

/// What a position measurement is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionGain {
    /// Weights of the innovation in position \[1\], velocity \[1/s\] and flux \[Wb/m\].
    pub weights: [f64; 3],
    /// Variance of the innovation, P11 + R \[m2\].
    pub innovation_variance: f64,
}

impl FactoredCovariance {
    /// Independent components with the given variances, in m2, m2/s2, Wb2.
    pub fn diagonal(variances: [f64; 3]) -> Self {
        Self { diagonal: variances, position_velocity: 0.0, position_flux: 0.0, velocity_flux: 0.0 }
    }

    /// Whether all factors are finite and no variance is negative.
    pub fn is_valid(&self) -> bool {
        self.diagonal.iter().all(|variance| variance.is_finite() && *variance >= 0.0)
            && (self.position_velocity + self.position_flux + self.velocity_flux).is_finite()
    }

    /// P = U D U^T
    pub fn matrix(&self) -> Matrix3<f64> {
        let (p, q, r) = (self.position_velocity, self.position_flux, self.velocity_flux);
        let [_, second, third] = self.diagonal;
        let (p12, p13, p23) = (second * p + third * q * r, third * q, third * r);
        let [p11, p22, p33] = self.variances();
        Matrix3::new(p11, p12, p13, p12, p22, p23, p13, p23, p33)
    }

    /// P11, P22, P33 in m2, m2/s2, Wb2.
    #[inline]
    pub fn variances(&self) -> [f64; 3] {
        let (p, q, r) = (self.position_velocity, self.position_flux, self.velocity_flux);
        let [first, second, third] = self.diagonal;
        [first + second * p * p + third * q * q, second + third * r * r, third]
    }

    /// P33 \[Wb2\]; U has ones on its diagonal, so it is D33.
    #[inline]
    pub fn flux_variance(&self) -> f64 {
        self.diagonal[2]
    }

    /// P := F P F^T with the Jacobian F of a step over `duration` \[s\] with the given force effect slope. F is
    /// itself unit upper triangular: U := F U, and D stands.
    #[inline]
    pub fn advance(&mut self, slope: ForceEffect, duration: f64) {
        self.position_flux += duration * self.velocity_flux + slope.position;
        self.position_velocity += duration;
        self.velocity_flux += slope.velocity;
    }

    /// P := P + diag(0, 0, `variance`), `variance` in Wb2.
    #[inline]
    pub fn add_flux_noise(&mut self, variance: f64) {
        if variance <= 0.0 {
            return;
        }
        let third = self.diagonal[2];
        let kept = third / (third + variance);
        // What the flux's own share of P + variance e3 e3^T leaves is again of rank one.
        let rest = ForceEffect { position: self.position_flux, velocity: self.velocity_flux };
        self.diagonal[2] = third + variance;
        self.position_flux *= kept;
        self.velocity_flux *= kept;
        self.add_force_noise(rest, variance * kept);
    }

    /// P := P + `variance` g g^T with g = (position, velocity, 0) of `direction`.
    #[inline]
    pub fn add_force_noise(&mut self, direction: ForceEffect, variance: f64) {
        let [first, second, third] = self.diagonal;
        let addition = variance * direction.velocity * direction.velocity;
        let position = direction.position - direction.velocity * self.position_velocity;
        let (mut kept, sum) = (1.0, second + addition);
        if addition > 0.0 {
            kept = second / sum;
            self.position_velocity += variance * direction.velocity / sum * position;
        }
        self.diagonal = [first + variance * kept * position * position, sum, third];
    }

    /// P := (I - K h^T) P for a measurement of the position with `variance` R > 0 \[m2\]; returns K.
    #[inline]
    pub fn measure_position(&mut self, variance: f64) -> PositionGain {
        let [first, second, third] = self.diagonal;
        let (p, q, r) = (self.position_velocity, self.position_flux, self.velocity_flux);
        let (second_p, third_q) = (second * p, third * q);
        // Innovation variance from the first one, two and three columns of U.
        let one = variance + first;
        let two = one + p * second_p;
        let three = two + q * third_q;
        let (kept_first, kept_second, kept_third) = (variance / one, one / two, two / three);
        self.diagonal = [first * kept_first, second * kept_second, third * kept_third];
        // Without cancellation also for R far below P11: 1 - P11 / (P11 + R) is R / (P11 + R).
        self.position_velocity = p * kept_first;
        self.position_flux = q * (variance / two);
        self.velocity_flux = r - second_p * q / two;
        let weights = [(three - variance) / three, (second_p + r * third_q) / three, third_q / three];
        PositionGain { weights, innovation_variance: three }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    /// Factors of very different sizes.
    fn covariance() -> impl Strategy<Value = FactoredCovariance> {
        ([-12.0..0.0f64, -12.0..0.0f64, -12.0..0.0f64], [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]).prop_map(
            |(exponents, [p, q, r])| FactoredCovariance {
                diagonal: exponents.map(|exponent| libm::pow(10.0, exponent)),
                position_velocity: p,
                position_flux: q,
                velocity_flux: r,
            },
        )
    }

    /// Largest deviation, in units of the terms that add up to `expected`.
    fn deviation(actual: Matrix3<f64>, expected: Matrix3<f64>, terms: Matrix3<f64>) -> f64 {
        (actual - expected).component_div(&terms).amax()
    }

    proptest! {
        #[test]
        fn steps_are_those_of_the_dense_covariance(
            covariance in covariance(), exponent in -12.0..0.0f64, position in 0.0..1.0f64, velocity in 0.0..1.0f64,
        ) {
            let variance = libm::pow(10.0, exponent);
            let dense = covariance.matrix();
            let absolute = dense.abs();

            let mut moved = covariance;
            moved.advance(ForceEffect { velocity, position }, 1e-3);
            let f = Matrix3::new(1.0, 1e-3, position, 0.0, 1.0, velocity, 0.0, 0.0, 1.0);
            prop_assert!(deviation(moved.matrix(), f * dense * f.transpose(), f * absolute * f.transpose()) < 1e-12);

            let mut noisy = covariance;
            noisy.add_flux_noise(variance);
            let noise = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, variance));
            prop_assert!(deviation(noisy.matrix(), dense + noise, absolute + noise) < 1e-12);

            let mut pushed = covariance;
            pushed.add_force_noise(ForceEffect { velocity, position }, variance);
            let g = Vector3::new(position, velocity, 0.0);
            let push = g * g.transpose() * variance;
            prop_assert!(deviation(pushed.matrix(), dense + push, absolute + push) < 1e-12);

            let mut measured = covariance;
            let gain = measured.measure_position(variance);
            // Joseph's form; h = (1, 0, 0).
            let k = dense.column(0) / (dense[(0, 0)] + variance);
            let h = Vector3::new(1.0, 0.0, 0.0);
            let kept = Matrix3::identity() - k * h.transpose();
            let expected = kept * dense * kept.transpose() + k * k.transpose() * variance;
            let prior = dense.diagonal().map(libm::sqrt);
            let difference = measured.matrix() - expected;
            for row in 0..3 {
                prop_assert!((gain.weights[row] - k[row]).abs() <= 1e-12 * prior[row] / prior[0]);
                for column in 0..3 {
                    prop_assert!(difference[(row, column)].abs() <= 1e-12 * prior[row] * prior[column]);
                }
            }
            prop_assert!(measured.is_valid());
        }
    }

    #[test]
    fn repeated_measurements_average() {
        // n measurements of the same position leave the variance 1 / (1 / P + n / R), here over 30 decades.
        let mut covariance = FactoredCovariance::diagonal([1e6, 1.0, 1.0]);
        for _ in 0..1000 {
            covariance.measure_position(1e-24);
        }
        let expected = 1e-27;
        assert!((covariance.matrix()[(0, 0)] - expected).abs() < 1e-12 * expected);
    }
}
