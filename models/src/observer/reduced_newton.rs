//! Reduced-order Newton observer of the magnetic bearing (Mystkowski, Kotta, Kaparin 2018, section 3.1), as printed
//! and with its lag compensated.
//!
//! Printed: a low-pass filter T_s x2' + x2 = y', both derivatives by backward difference, yields the velocity; the
//! flux one sample ago solves the scalar equation (7) by d Newton iterations and is forwarded once:
//!
//! ```text
//! v[k] = a v[k-1] + g (y[k] - y[k-1]) / T       a = T_s / (T_s + T),  g = 1 - a
//! y[k] - y[k-1] - T v[k-1] - p(z, u[k-1]) = 0   for z = x3[k-1]                                        (7)
//! ```
//!
//! with p and q the force effect on position and velocity over a step. This is biased: v lags behind x2, by T/2 from
//! the difference and T_s from the filter, and (7) takes the missing velocity for force.
//!
//! Compensated: the lag l = x2 - v is known once the flux is. A step of the true motion is `y[k] - y[k-1] = T x2[k-1] +
//! p` and `x2[k] = x2[k-1] + q`; put into the filter,
//!
//! ```text
//! l[k] = a l[k-1] + q(x3[k-1], u[k-1]) - g p(x3[k-1], u[k-1]) / T
//! ```
//!
//! This is what the same filter makes of the modelled motion. `l[k-1]` hence depends on the flux `x3[k-2] = z - u[k-2] T`,
//! and (7) with the velocity `v[k-1] + l[k-1](z)` in it is again one scalar equation for z. Solving for the flux in
//! both places is what makes it stable: with e the error of l, (7) leaves `T e[k-1] + p' dz = 0`, and for a flux that
//! changes little q' = 2 p' / T, so that e[k-1] = a e[k-2] + (1 + a) p' dz / T gives e[k-1] = a / (2 + a) e[k-2]: every
//! error falls to less than a third per sample for any T_s, and for T_s = 0 this is the full-order observer.
//! (With l taken from the last estimate of the flux instead the product of the poles would be 1 + a, unstable.)

use super::{CONVERGED, Estimate};
use crate::plant::magnetic_bearing::{MagneticBearing, Map, State};
use serde::{Deserialize, Serialize};

/// What the observer knows of its plant and how hard it tries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedNewtonSettings {
    pub bearing: MagneticBearing,
    /// Model inside (7); the paper inverts the printed one.
    pub map: Map,
    /// T \[s\]
    pub sample_time: f64,
    /// T_s of the velocity's low-pass filter \[s\], at least 0.
    pub filter_time: f64,
    /// Whether the filter's lag is added to the velocity; false is section 3.1 as printed.
    pub lag_compensated: bool,
    /// d, at least 1.
    pub max_iterations: u32,
    /// alpha of Remark 2, in (0, 1\].
    pub step_size: f64,
}

impl ReducedNewtonSettings {
    /// a = T_s / (T_s + T)
    fn memory(&self) -> f64 {
        self.filter_time / (self.filter_time + self.sample_time)
    }

    /// What a step that starts with `flux` adds to l \[m/s\], and its derivative with respect to the flux.
    fn lag_and_slope(&self, flux: f64, voltage: f64) -> (f64, f64) {
        if !self.lag_compensated {
            return (0.0, 0.0);
        }
        let (bearing, map, t) = (self.bearing, self.map, self.sample_time);
        let share = (1.0 - self.memory()) / t;
        let effect = bearing.force_effect(map, flux, voltage, t);
        let slope = bearing.force_effect_slope(map, flux, voltage, t);
        (effect.velocity - share * effect.position, slope.velocity - share * slope.position)
    }
}

/// Filter, two past voltages and the starting point of the next inversion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedNewtonObserver {
    /// x3\[k-1\] \[Wb\] when the sample k arrives: start of the iteration.
    flux: f64,
    /// v\[k-1\] \[m/s\] when the sample k arrives.
    filtered_velocity: f64,
    /// a l\[k-2\] \[m/s\] when the sample k arrives: the part of l\[k-1\] that follows from earlier samples.
    carried_lag: f64,
    /// y\[k-1\] \[m\] when the sample k arrives.
    position: f64,
    /// u\[k-2\] \[V\] when the sample k arrives.
    voltage: f64,
    /// Samples seen so far, counted up to 2.
    samples: u32,
    /// Last estimate, kept when an inversion yields nothing finite.
    estimate: State,
}

impl ReducedNewtonObserver {
    /// An observer whose filter and iteration start from `initial`.
    pub fn new(initial: State) -> Self {
        Self {
            flux: initial.flux,
            filtered_velocity: initial.velocity,
            carried_lag: 0.0,
            position: 0.0,
            voltage: 0.0,
            samples: 0,
            estimate: initial,
        }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    ///
    /// Until two past samples exist the estimate is the measured position with the initial velocity and flux.
    #[inline(never)]
    pub fn update(
        &mut self,
        settings: &ReducedNewtonSettings,
        position: f64,
        applied_voltage: f64,
    ) -> Estimate {
        let t = settings.sample_time;
        let memory = settings.memory();
        let rise = position - self.position;
        let filtered_velocity = memory * self.filtered_velocity + (1.0 - memory) * rise / t;
        let before = *self;
        self.position = position;
        self.voltage = applied_voltage;
        if self.samples < 2 {
            if self.samples == 1 && filtered_velocity.is_finite() {
                self.filtered_velocity = filtered_velocity;
            }
            self.samples += 1;
            self.estimate.position = position;
            return Estimate { state: self.estimate, residual: 0.0, iterations: 0, converged: false };
        }

        let equation = Equation {
            force_rise: rise - t * (before.filtered_velocity + before.carried_lag),
            voltages: [before.voltage, applied_voltage],
        };
        let solution = equation.solve(settings, before.flux);
        let past_flux = solution.flux - before.voltage * t;
        let past_lag = before.carried_lag + settings.lag_and_slope(past_flux, before.voltage).0;
        let carried_lag = memory * past_lag;
        let lag = carried_lag + settings.lag_and_slope(solution.flux, applied_voltage).0;
        let state =
            State { position, velocity: filtered_velocity + lag, flux: solution.flux + applied_voltage * t };
        let residual = (equation.force_rise - equation.modelled(settings, solution.flux).0).abs();
        if !(state.is_finite() && filtered_velocity.is_finite() && carried_lag.is_finite()) {
            return Estimate {
                state: self.estimate,
                residual: residual.min(f64::MAX),
                iterations: solution.iterations,
                converged: false,
            };
        }
        self.flux = state.flux;
        self.filtered_velocity = filtered_velocity;
        self.carried_lag = carried_lag;
        self.estimate = state;
        let (iterations, converged) = (solution.iterations, solution.converged);
        Estimate { state, residual: residual.min(f64::MAX), iterations, converged }
    }
}

/// (7) at one sample.
struct Equation {
    /// y\[k\] - y\[k-1\] less what is known of T x2\[k-1\], in m: the force explains the rest.
    force_rise: f64,
    /// u\[k-2\], u\[k-1\] \[V\]
    voltages: [f64; 2],
}

struct Solution {
    /// x3\[k-1\] \[Wb\]
    flux: f64,
    iterations: u32,
    converged: bool,
}

impl Equation {
    /// The model of `force_rise` for the flux z = x3\[k-1\], and its derivative.
    fn modelled(&self, settings: &ReducedNewtonSettings, flux: f64) -> (f64, f64) {
        let (map, t) = (settings.map, settings.sample_time);
        let effect = settings.bearing.force_effect(map, flux, self.voltages[1], t);
        let slope = settings.bearing.force_effect_slope(map, flux, self.voltages[1], t);
        let (lag, lag_slope) = settings.lag_and_slope(flux - self.voltages[0] * t, self.voltages[0]);
        (t * lag + effect.position, t * lag_slope + slope.position)
    }

    /// d Newton iterations; stops early once a further one could not change the flux by more than its last digit.
    /// An iteration whose result is not finite is dropped and ends the search.
    fn solve(&self, settings: &ReducedNewtonSettings, guess: f64) -> Solution {
        let t = settings.sample_time;
        let end = |flux: f64| flux + self.voltages[1] * t;
        let mut flux = guess;
        let mut converged = false;
        for iteration in 1..=settings.max_iterations {
            let (modelled, slope) = self.modelled(settings, flux);
            let correction = (self.force_rise - modelled) / slope;
            let candidate = flux + settings.step_size * correction;
            if !candidate.is_finite() {
                return Solution { flux, iterations: iteration, converged: false };
            }
            let size = candidate.abs().max(end(candidate).abs());
            let same_branch = flux * candidate > 0.0 && end(flux) * end(candidate) > 0.0;
            flux = candidate;
            converged = (settings.step_size * correction).abs() <= CONVERGED * size;
            // As in the full-order observer: the second derivative of the model is at most 4 T^2 on a branch.
            let next_correction = 2.0 * (t * correction) * (t * correction);
            if settings.step_size == 1.0
                && same_branch
                && next_correction <= slope.abs() * f64::EPSILON * size
            {
                return Solution { flux, iterations: iteration, converged };
            }
        }
        Solution { flux, iterations: settings.max_iterations, converged }
    }
}
