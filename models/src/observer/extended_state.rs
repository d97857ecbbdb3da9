//! Extended state observers of a second-order plant: what is unknown of its acceleration is a third state.
//!
//! For a plant x1' = x2, x2' = f + b u, of which only y = x1 is measured, the extended state x3 = f is estimated along
//! with x1 and x2; (9) to (12) of the maglev rig's paper, whose equations are reconstructed from its words ((11) is
//! Han's standard form):
//!
//! ```text
//! z1' = z2 + L1 phi1(e)      z2' = z3 + L2 phi2(e) + b u      z3' = L3 phi3(e)      e = y - z1        (11)
//! ```
//!
//! Linear (LESO, (12)): phi(e) = e. Nonlinear (NESO): phi_i(e) = fal(e, alpha_i, delta_i), see `fal`.
//! Nothing here knows the unit of y; z1 is in that unit, z2 per second, z3 and b u per second squared.
//!
//! Everything is a plain value without dispatch, so that a tuning loop runs at full speed:
//!
//! ```
//! use maglev_models::observer::extended_state::{ExtendedState, ExtendedStateModel, LinearInjection};
//! let model = ExtendedStateModel { injection: LinearInjection::from_bandwidth(100.0), input_gain: 1.0 };
//! let mut z = ExtendedState::default();
//! for k in 0..100 {
//!     let (start, end) = (0.009 + 1e-5 * f64::from(k), 0.009 + 1e-5 * f64::from(k + 1));
//!     z = model.runge_kutta_step(z, [start, 0.5 * (start + end), end], 0.76, 1e-3);
//! }
//! assert!((z.position - 0.01).abs() < 1e-4);
//! ```

use super::fal::{self, Fal};
use serde::{Deserialize, Serialize};

/// Estimate z of an extended state observer; y stands for the unit of the measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExtendedState {
    /// z1 \[y\]
    pub position: f64,
    /// z2 \[y/s\]
    pub velocity: f64,
    /// z3 \[y/s2\], what the observer knows of the acceleration beyond b u.
    pub extended: f64,
}

impl ExtendedState {
    /// z + duration * rate
    #[inline(always)]
    #[must_use]
    pub fn plus(self, duration: f64, rate: Self) -> Self {
        Self {
            position: self.position + duration * rate.position,
            velocity: self.velocity + duration * rate.velocity,
            extended: self.extended + duration * rate.extended,
        }
    }

    /// Largest magnitude of a component; not a number if one is not.
    #[inline]
    pub fn largest_magnitude(&self) -> f64 {
        let larger = |a: f64, b: f64| if a > b || a.is_nan() { a } else { b };
        larger(self.position.abs(), larger(self.velocity.abs(), self.extended.abs()))
    }
}

/// Gains L1 \[1/s\], L2 \[1/s2\], L3 \[1/s3\] of (11).
pub type Gains = [f64; 3];

/// Gains (3 w, 3 w^2, w^3) that put all poles of the linear observer to -w, (13) after Gao 2003; `bandwidth` w \[rad/s\].
/// The paper's 300, 3e4, 1e6 are those of 100 rad/s.
pub const fn gains_from_bandwidth(bandwidth: f64) -> Gains {
    [3.0 * bandwidth, 3.0 * bandwidth * bandwidth, bandwidth * bandwidth * bandwidth]
}

/// How the error of the measurement is fed into the model.
pub trait Injection: Copy {
    /// L_i phi_i(e).
    fn at(&self, error: f64) -> [f64; 3];

    /// Gains of the linear injection that does the same at this error, L_i phi_i(e) / e.
    fn frozen(&self, error: f64) -> Gains;
}

/// phi(e) = e
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinearInjection {
    pub gains: Gains,
}

impl LinearInjection {
    /// See [`gains_from_bandwidth`].
    pub const fn from_bandwidth(bandwidth: f64) -> Self {
        Self { gains: gains_from_bandwidth(bandwidth) }
    }
}

impl Injection for LinearInjection {
    #[inline(always)]
    fn at(&self, error: f64) -> [f64; 3] {
        self.gains.map(|gain| gain * error)
    }

    #[inline(always)]
    fn frozen(&self, _: f64) -> Gains {
        self.gains
    }
}

/// phi_i(e) = fal(e, alpha_i, delta_i)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NonlinearInjection {
    pub gains: Gains,
    pub functions: [Fal; 3],
}

impl NonlinearInjection {
    /// Exponents alpha \[1\] and linear zones delta \[y\]; Table 4 prints 1, 0.5, 0.25 and three times 0.01.
    pub fn new(gains: Gains, exponents: [f64; 3], linear_zones: [f64; 3]) -> Self {
        let functions = core::array::from_fn(|index| Fal::new(exponents[index], linear_zones[index]));
        Self { gains, functions }
    }
}

impl Injection for NonlinearInjection {
    #[inline(always)]
    fn at(&self, error: f64) -> [f64; 3] {
        let values = fal::values(&self.functions, error);
        core::array::from_fn(|index| self.gains[index] * values[index])
    }

    #[inline]
    fn frozen(&self, error: f64) -> Gains {
        if error == 0.0 {
            return core::array::from_fn(|index| self.gains[index] * self.functions[index].slope());
        }
        self.at(error).map(|injected| injected / error)
    }
}

/// The differential equation (11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedStateModel<I> {
    pub injection: I,
    /// b \[y/(s2 V)\]: what the observer takes for the effect of the voltage on the acceleration.
    pub input_gain: f64,
}

impl<I: Injection> ExtendedStateModel<I> {
    /// z' for a measurement y and an input u \[V\].
    #[inline(always)]
    pub fn rate(&self, z: ExtendedState, measurement: f64, input: f64) -> ExtendedState {
        let [first, second, third] = self.injection.at(measurement - z.position);
        ExtendedState {
            position: z.velocity + first,
            velocity: z.extended + second + self.input_gain * input,
            extended: third,
        }
    }

    /// Forward Euler: with Table 4 unstable from 0.67 ms on, with a triple pole -w from 2/w on.
    #[inline(always)]
    pub fn euler_step(&self, z: ExtendedState, measurement: f64, input: f64, duration: f64) -> ExtendedState {
        z.plus(duration, self.rate(z, measurement, input))
    }

    /// Classical Runge-Kutta with the measurements at the start, the middle and the end of the step, the input held.
    #[inline(always)]
    pub fn runge_kutta_step(
        &self,
        z: ExtendedState,
        [start, middle, end]: [f64; 3],
        input: f64,
        duration: f64,
    ) -> ExtendedState {
        let half = 0.5 * duration;
        let first = self.rate(z, start, input);
        let second = self.rate(z.plus(half, first), middle, input);
        let third = self.rate(z.plus(half, second), middle, input);
        let fourth = self.rate(z.plus(duration, third), end, input);
        let sum = first.plus(2.0, second).plus(2.0, third).plus(1.0, fourth);
        z.plus(duration / 6.0, sum)
    }

    /// Classical Runge-Kutta in equal sub-steps over `duration` \[s\]; the measurement runs straight from `start` to
    /// `end` (equal: held), the input is held.
    #[inline]
    pub fn runge_kutta(
        &self,
        mut z: ExtendedState,
        (start, end): (f64, f64),
        input: f64,
        duration: f64,
        substeps: u32,
    ) -> ExtendedState {
        if substeps == 1 {
            return self.runge_kutta_step(z, [start, 0.5 * (start + end), end], input, duration);
        }
        let count = f64::from(substeps);
        let (step, slope) = (duration / count, (end - start) / count);
        for index in 0..substeps {
            let at = start + slope * f64::from(index);
            z = self.runge_kutta_step(z, [at, at + 0.5 * slope, at + slope], input, step);
        }
        z
    }
}

#[cfg(test)]
mod tests {
    //! Closed forms, noise gains and the paper's table are in `tests/core/rig/observers.rs`.

    use super::*;

    /// Table 4.
    fn nonlinear() -> NonlinearInjection {
        NonlinearInjection::new(gains_from_bandwidth(100.0), [1.0, 0.5, 0.25], [0.01; 3])
    }

    #[test]
    fn gains_of_a_hundred_are_the_papers() {
        assert_eq!(gains_from_bandwidth(100.0), [300.0, 3e4, 1e6]);
    }

    #[test]
    fn nonlinear_with_exponents_of_one_is_linear() {
        let linear = LinearInjection::from_bandwidth(80.0);
        let same = NonlinearInjection::new(linear.gains, [1.0; 3], [0.01, 0.1, 1.0]);
        for error in [-2.0, -0.05, 0.0, 1e-3, 0.7] {
            assert_eq!(same.at(error), linear.at(error));
        }
    }

    #[test]
    fn frozen_gains_inject_the_same() {
        for error in [-0.3, -1e-3, 0.0, 2e-3, 0.3] {
            let injected = nonlinear().at(error);
            let frozen = LinearInjection { gains: nonlinear().frozen(error) }.at(error);
            for (injected, frozen) in injected.iter().zip(frozen) {
                assert!((injected - frozen).abs() <= 1e-15 * injected.abs());
            }
        }
    }

    #[test]
    fn linear_zone_multiplies_the_gains() {
        // Section 3 of the reconstruction: 300, 3e4 / sqrt(0.01), 1e6 / 0.01^0.75.
        let frozen = nonlinear().frozen(5e-3);
        for (gain, expected) in frozen.iter().zip([300.0, 3e5, 3.162_277_66e7]) {
            assert!((gain / expected - 1.0).abs() < 1e-9, "{gain} {expected}");
        }
    }

    #[test]
    fn substeps_follow_the_ramp_and_converge_with_order_four() {
        let model =
            ExtendedStateModel { injection: LinearInjection::from_bandwidth(100.0), input_gain: -3705.0 };
        let z = ExtendedState { position: 0.1, velocity: -1.0, extended: 300.0 };
        let after = |substeps| model.runge_kutta(z, (0.1, 0.3), 0.76, 2e-3, substeps);
        let exact = after(256).velocity;
        let errors = [2, 4, 8].map(|substeps| (after(substeps).velocity - exact).abs());
        assert!((errors[0] / errors[1]).log2() > 3.8 && (errors[1] / errors[2]).log2() > 3.8, "{errors:?}");
    }
}
