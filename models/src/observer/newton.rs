//! Full-order Newton observer of the magnetic bearing (Mystkowski, Kotta, Kaparin 2018, section 3).
//!
//! Three outputs and two inputs determine the state two samples ago: solve (5), Y - H(w) = 0 with
//! H = (h(w), h(F(w, u0)), h(F(F(w, u0), u1))), by d Newton iterations (6), then forward w to now.

use super::largest_magnitude;
use super::square_window::{Solution, Window};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};

pub use super::Estimate;
pub use super::newton_settings::NewtonSettings;

/// Two past samples and the starting point of the next inversion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonObserver {
    /// w0: state two samples before the next one.
    delayed_state: State,
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
        Self { delayed_state: initial, positions: [0.0; 2], voltage: 0.0, samples: 0, estimate: initial }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    ///
    /// Until two past samples exist the estimate is the measured position with the initial velocity and flux.
    #[inline(always)]
    pub fn update(&mut self, settings: &NewtonSettings, position: f64, applied_voltage: f64) -> Estimate {
        if self.samples < 2 {
            return self.fill_window(position, applied_voltage);
        }
        let window = Window {
            positions: [self.positions[0], self.positions[1], position],
            voltages: [self.voltage, applied_voltage],
        };
        self.positions = [window.positions[1], position];
        self.voltage = applied_voltage;

        let Solution { state: oldest, effects, iterations, converged } =
            if settings.step_size == 1.0 && !settings.line_search {
                window.solve::<true>(settings, self.delayed_state)
            } else {
                window.solve_by_shorter_steps(settings, self.delayed_state)
            };
        // Steps 7 and 8 of the paper's algorithm: forward once for the next start, twice for the estimate.
        let next = oldest.after(effects[0], window.voltages[0], settings.sample_time);
        let state = next.after(effects[1], window.voltages[1], settings.sample_time);
        // What is not finite in `next` is not finite in `state` either.
        if !state.is_finite() {
            return Estimate {
                state: self.estimate,
                residual: largest_magnitude([position - self.estimate.position]),
                iterations,
                converged: false,
            };
        }
        self.delayed_state = next;
        self.estimate = state;
        let residual = largest_magnitude([
            window.positions[0] - oldest.position,
            window.positions[1] - next.position,
            window.positions[2] - state.position,
        ]);
        Estimate { state, residual, iterations, converged }
    }

    /// One of the first two samples.
    #[cold]
    fn fill_window(&mut self, position: f64, applied_voltage: f64) -> Estimate {
        self.positions = [self.positions[1], position];
        self.voltage = applied_voltage;
        self.samples += 1;
        self.estimate.position = position;
        Estimate { state: self.estimate, residual: 0.0, iterations: 0, converged: false }
    }
}
