//! Full-order Newton observer of the magnetic bearing (Mystkowski, Kotta, Kaparin 2018, section 3).
//!
//! Three outputs and two inputs determine the state two samples ago: solve (5), Y - H(w) = 0 with
//! H = (h(w), h(F(w, u0)), h(F(F(w, u0), u1))), by d Newton iterations (6), then forward w to now.
//!
//! With F(x) = (x1 + T x2 + p(x3, u), x2 + v(x3, u), x3 + u T), where p and v are the force effect on position and
//! velocity, the second difference h1 - 2 h2 + h3 = T v(x3, u0) + p(x3 + u0 T, u1) - p(x3, u0) contains neither
//! x1 nor x2. The 3x3 system of (6) therefore falls apart: its third component is the scalar Newton iteration on
//! the second difference, and the other two follow by substitution. This is algebra, not approximation; the
//! iterates are those of (6) for every d and alpha.

use super::{CONVERGED, largest_magnitude};
use crate::plant::magnetic_bearing::{ForceEffect, MagneticBearing, Map, State};

pub use super::Estimate;

/// How often the line search halves a step before it gives up.
pub(super) const MAX_HALVINGS: u32 = 40;

/// What the observer knows of its plant and how hard it tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    pub bearing: MagneticBearing,
    /// Model inside H and F; the paper inverts the printed one.
    pub map: Map,
    /// T \[s\]
    pub sample_time: f64,
    /// d of (6), at least 1.
    pub max_iterations: u32,
    /// alpha of Remark 2, in (0, 1\].
    pub step_size: f64,
    /// Varying step size of Remark 5: halves a step, from alpha on, until it decreases |Y - H(w)|. It helps a poor
    /// start: from nearly zero flux a full step overshoots the more the smaller the slope.
    pub line_search: bool,
}

/// Two past samples and the starting point of the next inversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonObserver {
    /// w0: state two samples before the next one.
    retarded: State,
    /// y\[k-2\], y\[k-1\] \[m\] when the sample k arrives.
    positions: [f64; 2],
    /// u\[k-2\] \[V\] when the sample k arrives.
    voltage: f64,
    /// Samples seen so far, counted up to 2.
    samples: u32,
    /// Last estimate, kept when an inversion yields nothing finite.
    estimate: State,
}

impl NewtonObserver {
    /// An observer that starts from w0 = `initial`.
    pub fn new(initial: State) -> Self {
        Self { retarded: initial, positions: [0.0; 2], voltage: 0.0, samples: 0, estimate: initial }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    ///
    /// Until two past samples exist the estimate is the measured position with the initial velocity and flux.
    pub fn update(&mut self, settings: &NewtonSettings, position: f64, applied_voltage: f64) -> Estimate {
        if self.samples < 2 {
            self.positions = [self.positions[1], position];
            self.voltage = applied_voltage;
            self.samples += 1;
            self.estimate.position = position;
            return Estimate { state: self.estimate, residual: 0.0, iterations: 0, converged: false };
        }
        let window = Window {
            positions: [self.positions[0], self.positions[1], position],
            voltages: [self.voltage, applied_voltage],
        };
        self.positions = [window.positions[1], position];
        self.voltage = applied_voltage;

        let Solution { state: oldest, effects, iterations, converged } =
            if settings.step_size == 1.0 && !settings.line_search {
                window.solve::<true>(settings, self.retarded)
            } else {
                window.solve::<false>(settings, self.retarded)
            };
        // Steps 7 and 8 of the paper's algorithm: forward once for the next start, twice for the estimate.
        let next = forward(oldest, effects[0], window.voltages[0], settings.sample_time);
        let state = forward(next, effects[1], window.voltages[1], settings.sample_time);
        // What is not finite in `next` is not finite in `state` either.
        if !state.is_finite() {
            return Estimate {
                state: self.estimate,
                residual: largest_magnitude([position - self.estimate.position]),
                iterations,
                converged: false,
            };
        }
        self.retarded = next;
        self.estimate = state;
        let residual = largest_magnitude([
            window.positions[0] - oldest.position,
            window.positions[1] - next.position,
            window.positions[2] - state.position,
        ]);
        Estimate { state, residual, iterations, converged }
    }
}

/// The equations (5) at one sample.
struct Window {
    /// Y = y\[k-2\], y\[k-1\], y\[k\] \[m\]
    positions: [f64; 3],
    /// U = u\[k-2\], u\[k-1\] \[V\]
    voltages: [f64; 2],
}

struct Solution {
    /// w_d, the state at the oldest sample of the window.
    state: State,
    /// Force effects of the two steps that start from `state`.
    effects: [ForceEffect; 2],
    iterations: u32,
    converged: bool,
}

impl Window {
    /// Iterates (6) from `guess`; stops early once a further iteration could not change the flux by more than
    /// its last digit. An iteration whose result is not finite is dropped and ends the search.
    ///
    /// The usual case of full steps (`FULL_STEPS`) is compiled on its own, without a step length.
    #[inline]
    fn solve<const FULL_STEPS: bool>(&self, settings: &NewtonSettings, guess: State) -> Solution {
        let NewtonSettings { sample_time, max_iterations, .. } = *settings;
        let [oldest, middle, newest] = self.positions;
        let rise = middle - oldest;
        let curvature = (newest - middle) - rise;
        let rate = 1.0 / sample_time;

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
                let length = self.step_length(settings, state, step);
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

    /// alpha, with a line search halved until the step decreases |Y - H(w)|; alpha also where no length of it does,
    /// or the step is too small for the residual to tell.
    fn step_length(&self, settings: &NewtonSettings, start: State, step: State) -> f64 {
        let full = settings.step_size;
        if !settings.line_search || step.flux.abs() <= CONVERGED * start.flux.abs() {
            return full;
        }
        let before = self.squared_residual(settings, start);
        let mut length = full;
        for _ in 0..MAX_HALVINGS {
            if self.squared_residual(settings, moved(start, step, length)) < before {
                return length;
            }
            length /= 2.0;
        }
        full
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
    #[inline]
    fn at(settings: &NewtonSettings, flux: f64, voltages: [f64; 2]) -> Self {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        let middle_flux = flux + voltages[0] * sample_time;
        Self {
            middle_flux,
            effects: [
                bearing.force_effect(map, flux, voltages[0], sample_time),
                bearing.force_effect(map, middle_flux, voltages[1], sample_time),
            ],
            slopes: [
                bearing.force_effect_slope(map, flux, voltages[0], sample_time),
                bearing.force_effect_slope(map, middle_flux, voltages[1], sample_time),
            ],
        }
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

/// w + lambda * step
#[inline]
pub(super) fn moved(w: State, step: State, length: f64) -> State {
    State {
        position: w.position + length * step.position,
        velocity: w.velocity + length * step.velocity,
        flux: w.flux + length * step.flux,
    }
}

/// F(x, u) with a known force effect.
#[inline]
fn forward(state: State, effect: ForceEffect, voltage: f64, sample_time: f64) -> State {
    State {
        position: state.position + sample_time * state.velocity + effect.position,
        velocity: state.velocity + effect.velocity,
        flux: state.flux + voltage * sample_time,
    }
}

#[cfg(test)]
mod tests {
    //! Agreement with the literal algorithm is tested from outside, in `tests/newton_observer.rs`.

    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    const T: f64 = 1e-3;

    fn settings(map: Map, max_iterations: u32, step_size: f64, epsilon: f64) -> NewtonSettings {
        NewtonSettings {
            bearing: MagneticBearing { epsilon },
            map,
            sample_time: T,
            max_iterations,
            step_size,
            line_search: false,
        }
    }

    fn vector(state: State) -> Vector3<f64> {
        Vector3::new(state.position, state.velocity, state.flux)
    }

    /// H(w) of the paper by composition of the map.
    fn outputs(settings: &NewtonSettings, w: State, voltages: [f64; 2]) -> Vector3<f64> {
        let first = settings.bearing.advance(settings.map, w, voltages[0], T);
        let second = settings.bearing.advance(settings.map, first, voltages[1], T);
        Vector3::new(w.position, first.position, second.position)
    }

    /// True state, voltages and a guess nearby, all away from zero flux.
    fn problem() -> impl Strategy<Value = (State, [f64; 2], State)> {
        (
            0.05..0.2f64,
            any::<bool>(),
            -0.02..0.02f64,
            -0.02..0.02f64,
            [-30.0..30.0f64, -30.0..30.0f64],
            -0.01..0.01f64,
        )
            .prop_map(|(size, mirrored, position, velocity, voltages, offset)| {
                let sign = if mirrored { -1.0 } else { 1.0 };
                // Voltages that drive the flux away from zero keep both steps on one branch.
                let voltages = voltages.map(|voltage: f64| sign * voltage.abs());
                let truth = State { position, velocity, flux: sign * size };
                let guess = State { position: 0.0, velocity: 0.0, flux: sign * (size + offset) };
                (truth, voltages, guess)
            })
    }

    proptest! {
        #[test]
        fn residual_at_the_truth_is_zero((truth, voltages, _) in problem(), epsilon in 0.0..1.0f64) {
            let settings = settings(Map::Exact, 10, 1.0, epsilon);
            let positions = outputs(&settings, truth, voltages).into();
            let solution = Window { positions, voltages }.solve::<true>(&settings, truth);
            prop_assert!((vector(solution.state) - vector(truth)).amax() < 1e-10);
            prop_assert!(solution.converged && solution.iterations <= 2);
        }

        #[test]
        fn nothing_non_finite_leaves_the_observer(
            samples in prop::collection::vec((any::<f64>(), any::<f64>()), 3..12), exact: bool, epsilon in 0.0..1.0f64,
        ) {
            let map = if exact { Map::Exact } else { Map::Printed };
            let settings = settings(map, 10, 1.0, epsilon);
            let mut observer = NewtonObserver::new(State { position: 0.0, velocity: 0.0, flux: 1e-9 });
            for (position, voltage) in samples {
                prop_assume!(position.is_finite() && voltage.is_finite());
                let estimate = observer.update(&settings, position, voltage);
                prop_assert!(estimate.state.is_finite() && estimate.residual.is_finite());
            }
        }
    }

    #[test]
    fn singular_window_keeps_the_estimate() {
        // Zero flux, zero voltage, zero bias: the second difference does not depend on the flux at all.
        for map in [Map::Exact, Map::Printed] {
            let settings = settings(map, 10, 1.0, 0.0);
            let mut observer = NewtonObserver::new(State::default());
            for sample in 0..5 {
                let estimate = observer.update(&settings, 0.0, 0.0);
                assert_eq!(estimate.state, State::default(), "{map:?} sample {sample}");
                assert!(!estimate.converged);
            }
            // It works again once there is something to see.
            let mut truth = State { position: 0.0, velocity: 0.0, flux: 0.1 };
            let mut estimate = observer.update(&settings, truth.position, 0.0);
            for _ in 0..10 {
                truth = settings.bearing.advance(map, truth, 5.0, T);
                estimate = observer.update(&settings, truth.position, 5.0);
            }
            assert!(estimate.converged && (estimate.state.flux - truth.flux).abs() < 1e-9, "{estimate:?}");
        }
    }
}
