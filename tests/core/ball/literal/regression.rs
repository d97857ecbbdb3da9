//! The nonlinear regression (8) for the flux offset theta: prefilters and the quintic's coefficients.
//!
//! In the normalised variables (N) l = s + theta, I = z l, z' = -v, v' = W2 (l^2 - 1). For each pole alpha_j the
//! filter F_j = alpha_j/(p + alpha_j) applied to I = z l and swapped twice gives z h_j + v g_j = F_j\[I\] + e_j;
//! with I = z l these are three linear equations in the two unmeasured z and v, compatible only if (8') = 0.

use nalgebra::SVector;

/// How many prefilter poles.
pub const POLES: usize = 2;
/// Filter states per pole: Fi, h0, G0, E0, E1, E2, all of unity gain at rest.
pub const STATES_PER_POLE: usize = 6;

pub type Prefilters = SVector<f64, { POLES * STATES_PER_POLE }>;
/// c0..c4 of theta^5 + c4 theta^4 + ... + c0 = 0, (8'').
pub type Coefficients = SVector<f64, 5>;

/// Two poles \[1/s\] and W2 = g/c \[1/s^2\].
#[derive(Clone, Copy, Debug)]
pub struct Regression {
    pub poles: [f64; POLES],
    pub squared_frequency: f64,
}

/// The states of one pole.
#[derive(Clone, Copy, Debug)]
struct Bank {
    /// F\[I\]
    current: f64,
    /// h0 = F\[s\]
    flux: f64,
    /// G0 = F\[h0\]
    flux_twice: f64,
    /// E0, E1, E2: the parts of F\[(l^2 - 1)(G0 + theta)\] by powers of theta; that of theta^3 is 1.
    force: [f64; 3],
}

fn bank(states: &Prefilters, pole: usize) -> Bank {
    let s = |k: usize| states[pole * STATES_PER_POLE + k];
    Bank { current: s(0), flux: s(1), flux_twice: s(2), force: [s(3), s(4), s(5)] }
}

impl Regression {
    /// Inputs of the six filters of one pole.
    fn inputs(s: f64, current: f64, flux: f64, flux_twice: f64) -> [f64; STATES_PER_POLE] {
        [
            current,
            s,
            flux,
            (s * s - 1.0) * flux_twice,
            s * s - 1.0 + 2.0 * s * flux_twice,
            2.0 * s + flux_twice,
        ]
    }

    /// What the filters hold when s and I have never changed.
    pub fn constant_history(&self, s: f64, current: f64) -> Prefilters {
        let inputs = Self::inputs(s, current, s, s);
        Prefilters::from_fn(|k, _| inputs[k % STATES_PER_POLE])
    }

    /// Derivative of the prefilters.
    pub fn derivative(&self, states: &Prefilters, s: f64, current: f64) -> Prefilters {
        Prefilters::from_fn(|k, _| {
            let pole = k / STATES_PER_POLE;
            let Bank { flux, flux_twice, .. } = bank(states, pole);
            let input = Self::inputs(s, current, flux, flux_twice)[k % STATES_PER_POLE];
            self.poles[pole] * (input - states[k])
        })
    }

    /// A_j = alpha_j (F_j\[I\] + e_j) by powers of theta.
    fn filtered_current(&self, bank: &Bank, pole: f64) -> [f64; 4] {
        let weight = self.squared_frequency / pole;
        let [e0, e1, e2] = bank.force;
        [pole * bank.current + weight * e0, weight * e1, weight * e2, weight]
    }

    /// c0..c4 of (8'') from products of polynomials in theta.
    pub fn coefficients(&self, states: &Prefilters, s: f64, current: f64) -> Coefficients {
        let [one, two] = [bank(states, 0), bank(states, 1)];
        let [alpha_1, alpha_2] = self.poles;
        // D = (G0_1 + theta) A_2 - (G0_2 + theta) A_1
        let d = difference(
            product(&[one.flux_twice, 1.0], &self.filtered_current(&two, alpha_2)),
            product(&[two.flux_twice, 1.0], &self.filtered_current(&one, alpha_1)),
        );
        // B = alpha_1 (h0_1 + theta)(G0_2 + theta) - alpha_2 (h0_2 + theta)(G0_1 + theta)
        let b = difference(
            product(&[alpha_1 * one.flux, alpha_1], &[two.flux_twice, 1.0]),
            product(&[alpha_2 * two.flux, alpha_2], &[one.flux_twice, 1.0]),
        );
        // f = (s + theta) D + I B
        let mut f = product(&[s, 1.0], &d);
        for (power, b) in b.iter().enumerate() {
            f[power] += current * b;
        }
        Coefficients::from_fn(|power, _| f[power] / f[5])
    }

    /// S_j = z h_j + v g_j - F_j\[I\] - e_j of step 3 for the true offset `theta`: zero but for the start.
    pub fn swapped(&self, states: &Prefilters, theta: f64, z: f64, v: f64) -> [f64; POLES] {
        std::array::from_fn(|j| {
            let (bank, pole) = (bank(states, j), self.poles[j]);
            let h = bank.flux + theta;
            let g = (bank.flux_twice + theta) / pole;
            z * h + v * g - evaluate(&self.filtered_current(&bank, pole), theta) / pole
        })
    }
}

/// The quintic theta^5 + c4 theta^4 + ... + c0.
pub fn quintic(coefficients: &Coefficients, theta: f64) -> f64 {
    theta.powi(5) + evaluate(coefficients.as_slice(), theta)
}

/// Value of a polynomial given from the constant term on.
fn evaluate(polynomial: &[f64], x: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |value, coefficient| value * x + coefficient)
}

/// Product of two polynomials of at most degree five together.
fn product(left: &[f64], right: &[f64]) -> [f64; 6] {
    let mut result = [0.0; 6];
    for (m, left) in left.iter().enumerate() {
        for (n, right) in right.iter().enumerate().filter(|(_, right)| **right != 0.0) {
            result[m + n] += left * right;
        }
    }
    result
}

fn difference(left: [f64; 6], right: [f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| left[k] - right[k])
}
