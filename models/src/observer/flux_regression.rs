//! Equation of degree five for the flux offset of the levitated ball, from current and voltage alone.
//!
//! Proposition 2 of "Sensorless control of the levitated ball" announces such a regression; its formulas are lost in the
//! available text. This is one of the announced kind, derived anew and not necessarily the authors' own.
//!
//! All quantities are normalised: flux by lam0 = sqrt(2 k m g), current to I = k i / (c lam0), gap z = (c - y) / c,
//! velocity v = y' / c, W2 = g / c \[1/s2\]. With s the integral of the induced voltage and theta its unknown offset,
//!
//! ```text
//! l = s + theta       I = z l       z' = -v       v' = W2 (l^2 - 1)                                  (N)
//! ```
//!
//! For each of two low-passes F_j = a_j / (p + a_j) integration by parts (swapping) of F_j\[z l\] gives
//!
//! ```text
//! z h_j + v g_j = F_j[I] + e_j,    h_j = F_j[l],  g_j = h_j / (p + a_j),  e_j = [W2 (l^2 - 1) g_j] / (p + a_j)
//! ```
//!
//! up to a term that decays as e^(-a_j t). These two and z l = I are three linear equations for z and v, which are
//! compatible if their determinant vanishes:
//!
//! ```text
//! f = l (g_1 (F_2[I] + e_2) - g_2 (F_1[I] + e_1)) + I (h_1 g_2 - h_2 g_1) = 0
//! ```
//!
//! With l = s + theta every factor is a polynomial in theta whose coefficients are filtered measurements; the coefficient
//! of theta^5 is constant and is divided out: theta^5 + c4 theta^4 + c3 theta^3 + c2 theta^2 + c1 theta + c0 = 0.

use crate::signal::FirstOrderHold;
use serde::{Deserialize, Serialize};

/// Rates of the low-passes and what the ball falls with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FluxRegressionSettings {
    /// a_1, a_2 \[1/s\], different from each other
    pub rates: [f64; 2],
    /// W2 = g / c \[1/s2\]
    pub gravity: f64,
}

/// One sample of what is measured, normalised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// s
    pub flux: f64,
    /// I
    pub current: f64,
}

/// The low-passes of one rate; all have gain one at rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Prefilter {
    /// F\[I\]
    current: f64,
    /// F\[s\]
    flux: f64,
    /// F\[F\[s\]\]
    twice: f64,
    /// F of the coefficients of theta^0, theta^1, theta^2 in (l^2 - 1) F\[F\[l\]\]
    force: [f64; 3],
}

impl Prefilter {
    /// After an infinitely long rest.
    fn at_rest(Sample { flux: s, current }: Sample) -> Self {
        Self { current, flux: s, twice: s, force: force(s, s) }
    }

    /// As if there had been nothing before.
    fn from_zero() -> Self {
        Self { current: 0.0, flux: 0.0, twice: 0.0, force: [0.0; 3] }
    }

    #[inline(always)]
    fn advance(&mut self, hold: &FirstOrderHold, past: Sample, present: Sample) {
        let force_before = force(past.flux, self.twice);
        let flux = hold.after(self.flux, past.flux, present.flux);
        self.twice = hold.after(self.twice, self.flux, flux);
        self.flux = flux;
        self.current = hold.after(self.current, past.current, present.current);
        let force_after = force(present.flux, self.twice);
        for (q, state) in self.force.iter_mut().enumerate() {
            *state = hold.after(*state, force_before[q], force_after[q]);
        }
    }

    /// a (F\[I\] + e) by powers of theta.
    #[inline(always)]
    fn balance(&self, rate: f64, gravity: f64) -> [f64; 4] {
        let weight = gravity / rate;
        let [e0, e1, e2] = self.force;
        [rate * self.current + weight * e0, weight * e1, weight * e2, weight]
    }
}

/// ((s + theta)^2 - 1) (G + theta) by powers of theta, without the constant last one.
#[inline(always)]
fn force(s: f64, g: f64) -> [f64; 3] {
    [(s * s - 1.0) * g, s * s - 1.0 + 2.0 * s * g, 2.0 * s + g]
}

/// The twelve low-passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FluxRegression {
    prefilters: [Prefilter; 2],
    sample: Sample,
}

impl FluxRegression {
    /// A regression for a ball that has been at rest until `sample`; otherwise it is wrong by what decays with the rates.
    pub fn new(sample: Sample) -> Self {
        Self { prefilters: [Prefilter::at_rest(sample); 2], sample }
    }

    /// A regression whose low-passes start from zero: wrong by what decays with the rates, whatever the ball did.
    pub fn from_zero(sample: Sample) -> Self {
        Self { prefilters: [Prefilter::from_zero(); 2], sample }
    }

    /// Goes on to `sample`, with the low-passes of the settings' rates over the time since the last one.
    #[inline]
    pub fn advance(&mut self, holds: &[FirstOrderHold; 2], sample: Sample) {
        for (prefilter, hold) in self.prefilters.iter_mut().zip(holds) {
            prefilter.advance(hold, self.sample, sample);
        }
        self.sample = sample;
    }

    /// The newest sample.
    pub fn sample(&self) -> Sample {
        self.sample
    }

    /// c0 to c4.
    #[inline]
    pub fn coefficients(&self, settings: &FluxRegressionSettings) -> [f64; 5] {
        let [first, second] = &self.prefilters;
        let [a1, a2] = settings.rates;
        let (b1, b2) = (first.balance(a1, settings.gravity), second.balance(a2, settings.gravity));
        let (g1, g2) = (first.twice, second.twice);
        // D = (G_1 + theta) A_2 - (G_2 + theta) A_1
        let d = [
            g1 * b2[0] - g2 * b1[0],
            g1 * b2[1] + b2[0] - g2 * b1[1] - b1[0],
            g1 * b2[2] + b2[1] - g2 * b1[2] - b1[1],
            g1 * b2[3] + b2[2] - g2 * b1[3] - b1[2],
        ];
        let scale = 1.0 / (b2[3] - b1[3]);
        // B = a_1 (h_1 + theta) (G_2 + theta) - a_2 (h_2 + theta) (G_1 + theta)
        let b = [
            a1 * first.flux * g2 - a2 * second.flux * g1,
            a1 * (first.flux + g2) - a2 * (second.flux + g1),
            a1 - a2,
        ];
        let Sample { flux: s, current } = self.sample;
        [
            scale * (s * d[0] + current * b[0]),
            scale * (s * d[1] + d[0] + current * b[1]),
            scale * (s * d[2] + d[1] + current * b[2]),
            scale * (s * d[3] + d[2]),
            s + scale * d[3],
        ]
    }
}

/// theta^5 + c4 theta^4 + ... + c0 and its derivative.
#[inline]
pub fn residual_and_slope(coefficients: &[f64; 5], offset: f64) -> (f64, f64) {
    let mut value = 1.0;
    let mut slope = 0.0;
    for coefficient in coefficients.iter().rev() {
        slope = slope * offset + value;
        value = value * offset + coefficient;
    }
    (value, slope)
}
