//! Dynamic regressor extension and mixing (10)-(13): four filters make four equations of one, the adjugate
//! leaves the scalar one of theta. With H_j = p/(p + beta_j) the constant coefficient of theta^5 drops out.

use nalgebra::{Matrix4, Matrix5, SMatrix, Vector4};

use super::regression::Coefficients;

/// Outputs of the low-passes beta_j/(p + beta_j): column j holds those of c0..c4.
pub type LowPasses = SMatrix<f64, 5, 4>;

/// Four filter poles beta_j \[1/s\] and the unit scale kappa of Delta and Q1.
#[derive(Clone, Copy, Debug)]
pub struct Mixing {
    pub poles: [f64; 4],
    pub scale: f64,
}

/// The scalar regression Q1 = Delta theta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scalar {
    /// Delta = kappa det Phi
    pub excitation: f64,
    /// Q1 = kappa (adj(Phi) Q)_1
    pub response: f64,
}

impl Mixing {
    pub fn derivative(&self, low_passes: &LowPasses, coefficients: &Coefficients) -> LowPasses {
        LowPasses::from_fn(|q, j| self.poles[j] * (coefficients[q] - low_passes[(q, j)]))
    }

    /// Low-passes that have followed `coefficients`.
    pub fn settled(coefficients: &Coefficients) -> LowPasses {
        LowPasses::from_fn(|q, _| coefficients[q])
    }

    /// The four by four form: Phi = H_j\[c_q\] for q = 1..4 and Q = -H_j\[c_0\].
    pub fn scalar(&self, low_passes: &LowPasses, coefficients: &Coefficients) -> Scalar {
        let high_pass = |q: usize, j: usize| coefficients[q] - low_passes[(q, j)];
        let phi = Matrix4::from_fn(|j, q| high_pass(q + 1, j));
        let response = Vector4::from_fn(|j, _| -high_pass(0, j));
        Scalar {
            excitation: self.scale * phi.determinant(),
            response: self.scale * (adjugate(&phi) * response)[0],
        }
    }

    /// The same by five equations in theta..theta^5: the regression itself and its four low-passed copies.
    pub fn scalar_of_five(&self, low_passes: &LowPasses, coefficients: &Coefficients) -> Scalar {
        let entry = |q: usize, row: usize| if row == 0 { coefficients[q] } else { low_passes[(q, row - 1)] };
        let regressor = Matrix5::from_fn(|row, q| if q == 4 { 1.0 } else { entry(q + 1, row) });
        let mut replaced = regressor;
        for row in 0..5 {
            replaced[(row, 0)] = -entry(0, row);
        }
        Scalar {
            excitation: self.scale * regressor.determinant(),
            response: self.scale * replaced.determinant(),
        }
    }

    /// Estimate after `step` \[s\] of theta_hat' = gamma Delta (Q1 - Delta theta_hat) with Delta and Q1 frozen.
    pub fn adapted(estimate: f64, gain: f64, scalar: Scalar, step: f64) -> f64 {
        let Scalar { excitation, response } = scalar;
        let exponent = gain * excitation.powi(2) * step;
        let share = if exponent == 0.0 { 1.0 } else { -(-exponent).exp_m1() / exponent };
        estimate + gain * step * share * excitation * (response - excitation * estimate)
    }
}

/// The adjugate by its definition: transposed signed minors.
fn adjugate(matrix: &Matrix4<f64>) -> Matrix4<f64> {
    Matrix4::from_fn(|row, column| {
        let minor = matrix.remove_row(column).remove_column(row).determinant();
        if (row + column) % 2 == 0 { minor } else { -minor }
    })
}
