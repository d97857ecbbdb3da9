//! Newton observer with a window of N >= 3 outputs: least squares by Gauss-Newton, (6) with the pseudo-inverse of the
//! footnote to (5) (Mystkowski, Kotta, Kaparin 2018, section 3).

use super::least_squares_window::Window;
use super::newton::NewtonSettings;
use super::saved_count::count_up_to;
use super::{Estimate, largest_magnitude};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// Longest window.
pub const MAX_WINDOW: usize = 64;

/// The Newton observer's settings and the length of the window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowedNewtonSettings {
    pub newton: NewtonSettings,
    /// N \[samples\], 3 to [`MAX_WINDOW`]; other values count as the nearest of these.
    pub window: usize,
}

/// Past samples and the starting point of the next inversion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowedNewtonObserver {
    /// w0: state at the oldest sample.
    retarded: State,
    /// Outputs \[m\], oldest first; `samples` of them.
    #[serde(with = "BigArray")]
    positions: [f64; MAX_WINDOW],
    /// Voltage \[V\] that acted from each of these to the next.
    #[serde(with = "BigArray")]
    voltages: [f64; MAX_WINDOW],
    #[serde(deserialize_with = "count_up_to::<_, MAX_WINDOW>")]
    samples: usize,
    /// Last estimate, kept when an inversion yields nothing finite.
    estimate: State,
}

impl WindowedNewtonObserver {
    /// An observer that starts from w0 = `initial`.
    pub fn new(initial: State) -> Self {
        Self {
            retarded: initial,
            positions: [0.0; MAX_WINDOW],
            voltages: [0.0; MAX_WINDOW],
            samples: 0,
            estimate: initial,
        }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    ///
    /// Until two past samples exist the estimate is the measured position with the initial velocity and flux; until
    /// N - 1 of them do, the window is as long as there are samples.
    #[inline(never)]
    pub fn update(
        &mut self,
        settings: &WindowedNewtonSettings,
        position: f64,
        applied_voltage: f64,
    ) -> Estimate {
        let length = settings.window.clamp(3, MAX_WINDOW);
        while self.samples >= length {
            self.drop_oldest(&settings.newton);
        }
        if self.samples > 0 {
            self.voltages[self.samples - 1] = applied_voltage;
        }
        self.positions[self.samples] = position;
        self.samples += 1;
        if self.samples < 3 {
            self.estimate.position = position;
            return Estimate { state: self.estimate, residual: 0.0, iterations: 0, converged: false };
        }

        let window = Window::new(&self.positions[..self.samples], &self.voltages[..self.samples - 1]);
        let solution = window.solve(&settings.newton, self.retarded);
        let (state, residual) = window.forward(&settings.newton, solution.state);
        if !(solution.state.is_finite() && state.is_finite()) {
            return Estimate {
                state: self.estimate,
                residual: largest_magnitude([position - self.estimate.position]),
                iterations: solution.iterations,
                converged: false,
            };
        }
        self.retarded = solution.state;
        self.estimate = state;
        Estimate { state, residual, iterations: solution.iterations, converged: solution.converged }
    }

    /// Moves the window's start by one sample; w0 moves along unless that overflows.
    fn drop_oldest(&mut self, settings: &NewtonSettings) {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        let next = bearing.advance(map, self.retarded, self.voltages[0], sample_time);
        if next.is_finite() {
            self.retarded = next;
        }
        self.positions.copy_within(1..self.samples, 0);
        self.voltages.copy_within(1..self.samples, 0);
        self.samples -= 1;
    }
}
