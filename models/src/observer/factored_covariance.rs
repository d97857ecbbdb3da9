//! Covariance of N states as P = U D U^T, U unit upper triangular and D diagonal.
//!
//! The factors are updated, never P: every new diagonal element is a sum or a quotient of non-negative numbers, so
//! P cannot lose its symmetry or its sign to round-off, whatever the ratio of P to the measurement's variance.
//!
//! G. J. Bierman, *Factorization Methods for Discrete Sequential Estimation*, 1977: chapter V for the measurement,
//! chapter VI for the time update (modified weighted Gram-Schmidt, Thornton) and Agee-Turner's rank-one update for the
//! process noise. No square root is needed.

use core::array::from_fn;

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};
use serde_big_array::{Array, BigArray};

/// U and D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FactoredCovariance<const N: usize> {
    /// Diagonal of D, in the squared units of the states.
    #[serde(with = "BigArray")]
    diagonal: [f64; N],
    /// Rows of U, of which only what is right of the diagonal is used.
    #[serde(with = "BigArray")]
    unit: [Array<f64, N>; N],
}

/// What a measurement of the first state is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain<const N: usize> {
    /// Weights of the innovation in the states; the first is a number without unit.
    pub weights: [f64; N],
    /// Variance of the innovation, P11 + R.
    pub innovation_variance: f64,
}

#[expect(clippy::needless_range_loop, reason = "rows and columns of triangles, as in the book")]
impl<const N: usize> FactoredCovariance<N> {
    /// Independent states with the given variances.
    pub const fn from_variances(variances: [f64; N]) -> Self {
        Self { diagonal: variances, unit: [Array([0.0; N]); N] }
    }

    /// From D and the part of U right of its diagonal.
    #[inline]
    pub fn from_factors(diagonal: [f64; N], unit: [[f64; N]; N]) -> Self {
        Self { diagonal, unit: unit.map(Array) }
    }

    /// Whether all factors are finite and no variance is negative.
    pub fn is_valid(&self) -> bool {
        let upper = (0..N).flat_map(|row| (row + 1..N).map(move |column| self.unit[row][column]));
        self.diagonal.iter().all(|variance| variance.is_finite() && *variance >= 0.0)
            && upper.sum::<f64>().is_finite()
    }

    /// Element of U.
    #[inline(always)]
    fn factor(&self, row: usize, column: usize) -> f64 {
        if row == column { 1.0 } else { self.unit[row][column] }
    }

    /// P = U D U^T
    pub fn matrix(&self) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|row, column| {
            let (row, column) = (row.min(column), row.max(column));
            sum((column..N).map(|k| self.diagonal[k] * self.factor(row, k) * self.factor(column, k)))
        })
    }

    /// Diagonal of P.
    #[inline]
    pub fn variances(&self) -> [f64; N] {
        from_fn(|row| sum((row..N).map(|k| self.diagonal[k] * self.factor(row, k) * self.factor(row, k))))
    }

    /// Last element of P: U has ones on its diagonal, so it is that of D.
    #[inline]
    pub fn last_variance(&self) -> f64 {
        self.diagonal[N - 1]
    }

    /// P := F P F^T with F unit upper triangular, of which the part right of the diagonal is given: U := F U, and D stands.
    #[inline]
    pub fn advance(&mut self, slope: [[f64; N]; N]) {
        for column in 1..N {
            for row in 0..column {
                let terms = (row + 1..=column).map(|k| slope[row][k] * self.factor(k, column));
                self.unit[row][column] += sum(terms);
            }
        }
    }

    /// P := F P F^T + Q for any F and a Q in factors.
    #[inline]
    pub fn propagate(&mut self, slope: &[[f64; N]; N], noise: &Self) {
        // P = [F U, U_Q] diag(D, D_Q) [F U, U_Q]^T: the rows are made orthogonal, the last one first.
        let mut own: [[f64; N]; N] = from_fn(|row| {
            from_fn(|column| sum((0..=column).map(|k| slope[row][k] * self.factor(k, column))))
        });
        let mut added: [[f64; N]; N] =
            from_fn(|row| from_fn(|column| if row > column { 0.0 } else { noise.factor(row, column) }));
        let weights = self.diagonal;
        for last in (0..N).rev() {
            let weighted: [f64; N] = from_fn(|k| weights[k] * own[last][k]);
            let weighted_noise: [f64; N] = from_fn(|k| noise.diagonal[k] * added[last][k]);
            let product = |own: &[f64; N], added: &[f64; N]| {
                sum((0..N).map(|k| weighted[k] * own[k]))
                    + sum((last..N).map(|k| weighted_noise[k] * added[k]))
            };
            let variance = product(&own[last], &added[last]);
            self.diagonal[last] = variance;
            // A state that is known for certain depends on no other.
            let inverse = if variance > 0.0 { 1.0 / variance } else { 0.0 };
            for row in 0..last {
                let factor = product(&own[row], &added[row]) * inverse;
                self.unit[row][last] = factor;
                for k in 0..N {
                    own[row][k] -= factor * own[last][k];
                    added[row][k] -= factor * added[last][k];
                }
            }
        }
    }

    /// P := P + diag(0, .., 0, `variance`)
    #[inline]
    pub fn add_noise_to_last(&mut self, variance: f64) {
        if variance <= 0.0 {
            return;
        }
        let last = self.diagonal[N - 1];
        let kept = last / (last + variance);
        // What the last state's own share of P + variance e e^T leaves is again of rank one.
        let rest = from_fn(|row| self.unit[row][N - 1]);
        self.diagonal[N - 1] = last + variance;
        for row in 0..N - 1 {
            self.unit[row][N - 1] *= kept;
        }
        self.add_noise_to_first(N - 1, rest, variance * kept);
    }

    /// P := P + `variance` g g^T with g = `direction` in the first M states, 0 in the others.
    #[inline]
    pub fn add_noise<const M: usize>(&mut self, direction: [f64; M], variance: f64) {
        const { assert!(M <= N) };
        let direction = from_fn(|row| if row < M { direction[row] } else { 0.0 });
        self.add_noise_to_first(M, direction, variance);
    }

    /// As [`Self::add_noise`], the first `count` states being those of which `direction` is used.
    #[inline(always)]
    fn add_noise_to_first(&mut self, count: usize, mut direction: [f64; N], mut variance: f64) {
        for column in (0..count).rev() {
            let along = direction[column];
            let before = self.diagonal[column];
            let addition = variance * along * along;
            let after = before + addition;
            self.diagonal[column] = after;
            for row in 0..column {
                direction[row] -= along * self.unit[row][column];
            }
            if addition > 0.0 {
                for row in 0..column {
                    self.unit[row][column] += variance * along / after * direction[row];
                }
                variance *= before / after;
            }
        }
    }

    /// P := (I - K h^T) P for a measurement of the first state with `variance` R > 0; returns K.
    #[inline]
    pub fn measurement_update(&mut self, variance: f64) -> Gain<N> {
        // Innovation variance from the first columns of U, one more each time.
        let mut total = variance;
        let mut weights = [0.0; N];
        for column in 0..N {
            let element = self.factor(0, column);
            let weighted = self.diagonal[column] * element;
            let before = total;
            total += element * weighted;
            self.diagonal[column] *= before / total;
            if column > 0 {
                // Without cancellation also for R far below P11: 1 - P11 / (P11 + R) is R / (P11 + R).
                self.unit[0][column] = element * (variance / before);
            }
            for row in 1..column {
                let old = self.unit[row][column];
                self.unit[row][column] = old - weights[row] * element / before;
                weights[row] += old * weighted;
            }
            weights[column] = weighted;
        }
        weights[0] = total - variance;
        Gain { weights: weights.map(|weight| weight / total), innovation_variance: total }
    }
}

/// Sum of at least one term, without adding to 0.
#[inline(always)]
pub(super) fn sum(mut terms: impl Iterator<Item = f64>) -> f64 {
    let first = terms.next().unwrap_or(0.0);
    terms.fold(first, |sum, term| sum + term)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;

    /// Factors of very different sizes.
    fn covariance() -> impl Strategy<Value = FactoredCovariance<3>> {
        ([-12.0..0.0f64, -12.0..0.0f64, -12.0..0.0f64], [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]).prop_map(
            |(exponents, [p, q, r])| {
                let diagonal = exponents.map(|exponent| libm::pow(10.0, exponent));
                FactoredCovariance::from_factors(diagonal, [[0.0, p, q], [0.0, 0.0, r], [0.0; 3]])
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
            moved.advance([[0.0, 1e-3, position], [0.0, 0.0, velocity], [0.0; 3]]);
            let f = Matrix3::new(1.0, 1e-3, position, 0.0, 1.0, velocity, 0.0, 0.0, 1.0);
            prop_assert!(deviation(moved.matrix(), f * dense * f.transpose(), f * absolute * f.transpose()) < 1e-12);

            let mut noisy = covariance;
            noisy.add_noise_to_last(variance);
            let noise = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, variance));
            prop_assert!(deviation(noisy.matrix(), dense + noise, absolute + noise) < 1e-12);

            for third in [0.0, 0.5] {
                let mut shaken = covariance;
                shaken.add_noise([position, velocity, third], variance);
                let g = Vector3::new(position, velocity, third);
                let noise = g * g.transpose() * variance;
                prop_assert!(deviation(shaken.matrix(), dense + noise, absolute + noise) < 1e-12);
            }

            let mut measured = covariance;
            let gain = measured.measurement_update(variance);
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

        #[test]
        fn propagation_is_that_of_the_dense_covariance(
            covariance in covariance(), noise in covariance(),
            slope in proptest::array::uniform3(proptest::array::uniform3(-2.0..2.0f64)),
        ) {
            let f = Matrix3::from_fn(|row, column| slope[row][column]);
            let mut moved = covariance;
            moved.propagate(&slope, &noise);
            let expected = f * covariance.matrix() * f.transpose() + noise.matrix();
            let terms = f.abs() * covariance.matrix().abs() * f.abs().transpose() + noise.matrix().abs();
            let spread = terms.diagonal().map(libm::sqrt);
            let bound = spread * spread.transpose();
            prop_assert!(deviation(moved.matrix(), expected, bound) < 1e-12);
            prop_assert!(moved.is_valid());
        }

        #[test]
        fn propagation_without_noise_is_an_advance(covariance in covariance(), first in -1.0..1.0f64) {
            let (mut advanced, mut propagated) = (covariance, covariance);
            advanced.advance([[0.0, 1e-3, first], [0.0, 0.0, 0.3], [0.0; 3]]);
            let slope = [[1.0, 1e-3, first], [0.0, 1.0, 0.3], [0.0, 0.0, 1.0]];
            propagated.propagate(&slope, &FactoredCovariance::from_variances([0.0; 3]));
            let spread = Vector3::from(advanced.variances()).map(libm::sqrt);
            prop_assert!(deviation(propagated.matrix(), advanced.matrix(), spread * spread.transpose()) < 1e-12);
        }
    }

    #[test]
    fn a_state_that_is_known_stays_known() {
        // The third state has neither a variance nor noise: what is left is the covariance of two states.
        let mut covariance = FactoredCovariance::from_variances([1e-6, 1e-4, 0.0]);
        let mut smaller = FactoredCovariance::from_variances([1e-6, 1e-4]);
        for _ in 0..100 {
            let slope = [[1.001, 1e-3, 5e-7], [2.2, 1.001, 1e-3], [0.0, 0.0, 1.0]];
            covariance.propagate(&slope, &FactoredCovariance::from_variances([0.0; 3]));
            smaller.propagate(&[[1.001, 1e-3], [2.2, 1.001]], &FactoredCovariance::from_variances([0.0; 2]));
            let gain = covariance.measurement_update(1e-10);
            let expected = smaller.measurement_update(1e-10);
            assert_eq!((gain.weights[2], covariance.last_variance()), (0.0, 0.0));
            for (weight, expected) in gain.weights.iter().zip(expected.weights) {
                assert!((weight - expected).abs() <= 1e-12 * expected.abs());
            }
            assert!(covariance.is_valid());
        }
    }

    #[test]
    fn repeated_measurements_average() {
        // n measurements of the same position leave the variance 1 / (1 / P + n / R), here over 30 decades.
        let mut covariance = FactoredCovariance::from_variances([1e6, 1.0, 1.0]);
        for _ in 0..1000 {
            covariance.measurement_update(1e-24);
        }
        let expected = 1e-27;
        assert!((covariance.matrix()[(0, 0)] - expected).abs() < 1e-12 * expected);
    }
}
