//! Three outputs for three unknowns: the square system (5) of the Newton observer (Mystkowski, Kotta, Kaparin 2018).
//!
//! With F(x) = (x1 + T x2 + p(x3, u), x2 + v(x3, u), x3 + u T), where p and v are the force effect on position and
//! velocity, the second difference h1 - 2 h2 + h3 = T v(x3, u0) + p(x3 + u0 T, u1) - p(x3, u0) contains neither
//! x1 nor x2. The 3x3 system of (6) therefore falls apart: its third component is the scalar Newton iteration on
//! the second difference, and the other two follow by substitution. This is algebra, not approximation; the
//! iterates are those of (6) for every d and alpha.

use super::newton_settings::NewtonSettings;
use super::step_length::{moved, step_length};
use super::{CONVERGED, largest_magnitude};
use crate::plant::magnetic_bearing::{ForceEffect, State};

/// Rounding error of a second difference, relative to the positions in it: each new position of a plant is the sum of
/// three terms, which makes two roundings per step, in two steps, and as much again for those of the model.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The equations (5) at one sample.
pub(super) struct Window {
    /// Y = y\[k-2\], y\[k-1\], y\[k\] \[m\]
    pub positions: [f64; 3],
    /// U = u\[k-2\], u\[k-1\] \[V\]
    pub voltages: [f64; 2],
}

pub(super) struct Solution {
    /// w_d, the state at the oldest sample of the window.
    pub state: State,
    /// Force effects of the two steps that start from `state`.
    pub effects: [ForceEffect; 2],
    pub iterations: u32,
    pub converged: bool,
}

impl Window {
    /// Iterates (6) from `guess`; stops early once a further iteration could not change the flux by more than
    /// its last digit. An iteration whose result is not finite is dropped and ends the search.
    ///
    /// The usual case of full steps (`FULL_STEPS`) is compiled on its own, without a step length.
    #[inline(always)]
    pub fn solve<const FULL_STEPS: bool>(&self, settings: &NewtonSettings, guess: State) -> Solution {
        let NewtonSettings { sample_time, max_iterations, .. } = *settings;
        let [oldest, middle, newest] = self.positions;
        let rise = middle - oldest;
        let curvature = (newest - middle) - rise;
        let rate = 1.0 / sample_time;
        let resolution = ROUNDING * largest_magnitude(self.positions);

        let mut state = guess;
        let mut converged = false;
        let mut iterations = 0;
        while iterations < max_iterations {
            iterations += 1;
            let model = Linearisation::at(settings, state.flux, self.voltages);
            // The newest voltage acts on the second step only and is known last: it enters last.
            let [first, second] = model.effects;
            let [first_slope, second_slope] = model.slopes;
            let slope = (sample_time * first_slope.velocity - first_slope.position) + second_slope.position;
            let unexplained = (curvature - (sample_time * first.velocity - first.position)) - second.position;
            if settings.step_size == 1.0 && unexplained.abs() <= resolution {
                // The positions tell no more. Solving for their rounding errors would only blur the flux, the more
                // the smaller it is, and a predicted branch makes the estimate wait for no division.
                let velocity = (rise - first.position) * rate;
                let converged = unexplained.abs() < CONVERGED * (slope * state.flux).abs();
                state = State { position: oldest, velocity, flux: state.flux };
                return Solution { state, effects: model.effects, iterations, converged };
            }
            let correction = unexplained * (1.0 / slope);
            let fall = first.position + first_slope.position * correction;
            let velocity = (rise - fall) * rate;
            let (candidate, length) = if FULL_STEPS {
                (State { position: oldest, velocity, flux: state.flux + correction }, 1.0)
            } else {
                let step = State {
                    position: oldest - state.position,
                    velocity: velocity - state.velocity,
                    flux: correction,
                };
                let length = step_length(settings, state, step, |w| self.squared_residual(settings, w));
                (moved(state, step, length), length)
            };
            if !candidate.is_finite() {
                converged = false;
                break;
            }
            let middle_flux = candidate.flux + self.voltages[0] * sample_time;
            let size = candidate.flux.abs().max(middle_flux.abs());
            let same_branch = state.flux * candidate.flux > 0.0 && model.middle_flux * middle_flux > 0.0;
            state = candidate;
            converged = (length * correction).abs() <= CONVERGED * size;
            // Newton's next correction is at most c^2 max|f''| / (2 |f'|), and |f''| <= 4 T^2 on a branch.
            let next_correction = 2.0 * (sample_time * correction) * (sample_time * correction);
            if length == 1.0 && same_branch && next_correction <= slope.abs() * f64::EPSILON * size {
                // By the same bound the effects at the new flux follow from the linearisation to the last digit.
                return Solution { state, effects: model.effects_after(correction), iterations, converged };
            }
        }
        let effects = Linearisation::at(settings, state.flux, self.voltages).effects;
        Solution { state, effects, iterations, converged }
    }

    /// As [`Self::solve`] with alpha below 1 or a line search.
    #[inline(never)]
    pub fn solve_by_shorter_steps(&self, settings: &NewtonSettings, guess: State) -> Solution {
        self.solve::<false>(settings, guess)
    }

    /// |Y - H(w)|^2 \[m2\]
    fn squared_residual(&self, settings: &NewtonSettings, w: State) -> f64 {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        let first = bearing.advance(map, w, self.voltages[0], sample_time);
        let second = bearing.advance(map, first, self.voltages[1], sample_time);
        let [oldest, middle, newest] = self.positions;
        let residuals = [oldest - w.position, middle - first.position, newest - second.position];
        residuals.iter().map(|residual| residual * residual).sum()
    }
}

/// Force effects of the window's two steps and their derivatives, at a flux at its start.
struct Linearisation {
    /// x3 + u0 T
    middle_flux: f64,
    effects: [ForceEffect; 2],
    slopes: [ForceEffect; 2],
}

impl Linearisation {
    #[inline(always)]
    fn at(settings: &NewtonSettings, flux: f64, voltages: [f64; 2]) -> Self {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        let middle_flux = flux + voltages[0] * sample_time;
        let (first, first_slope) = bearing.linearised_force_effect(map, flux, voltages[0], sample_time);
        let (second, second_slope) =
            bearing.linearised_force_effect(map, middle_flux, voltages[1], sample_time);
        Self { middle_flux, effects: [first, second], slopes: [first_slope, second_slope] }
    }

    /// Effects once the flux has moved by a small `correction`.
    #[inline]
    fn effects_after(&self, correction: f64) -> [ForceEffect; 2] {
        let [first, second] = self.effects;
        let [first_slope, second_slope] = self.slopes;
        let moved = |effect: ForceEffect, slope: ForceEffect| ForceEffect {
            velocity: effect.velocity + slope.velocity * correction,
            position: effect.position + slope.position * correction,
        };
        [moved(first, first_slope), moved(second, second_slope)]
    }
}
