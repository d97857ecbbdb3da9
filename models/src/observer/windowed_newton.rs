//! Newton observer with a window of N >= 3 outputs: least squares by Gauss-Newton, (6) with the pseudo-inverse of the
//! footnote to (5) (Mystkowski, Kotta, Kaparin 2018, section 3).

use super::least_squares_window::Window;
use super::newton::NewtonSettings;
use super::sample_window::SampleWindow;
use super::{Estimate, largest_magnitude};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};

pub use super::sample_window::MAX_WINDOW;

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
    delayed_state: State,
    /// Outputs \[m\] and voltages \[V\].
    window: SampleWindow,
    /// Last estimate, kept when an inversion yields nothing finite.
    estimate: State,
}

impl WindowedNewtonObserver {
    /// An observer that starts from w0 = `initial`.
    pub fn new(initial: State) -> Self {
        Self { delayed_state: initial, window: SampleWindow::EMPTY, estimate: initial }
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
        while self.window.len() >= length {
            self.drop_oldest(&settings.newton);
        }
        self.window.push(position, applied_voltage);
        if self.window.len() < 3 {
            self.estimate.position = position;
            return Estimate { state: self.estimate, residual: 0.0, iterations: 0, converged: false };
        }

        let window = Window::new(self.window.measurements(), self.window.inputs());
        let solution = window.solve(&settings.newton, self.delayed_state);
        let (state, residual) = window.forward(&settings.newton, solution.state);
        if !(solution.state.is_finite() && state.is_finite()) {
            return Estimate {
                state: self.estimate,
                residual: largest_magnitude([position - self.estimate.position]),
                iterations: solution.iterations,
                converged: false,
            };
        }
        self.delayed_state = solution.state;
        self.estimate = state;
        Estimate { state, residual, iterations: solution.iterations, converged: solution.converged }
    }

    /// Moves the window's start by one sample; w0 moves along unless that overflows.
    fn drop_oldest(&mut self, settings: &NewtonSettings) {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        if let Some(voltage) = self.window.inputs().first() {
            let next = bearing.advance(map, self.delayed_state, *voltage, sample_time);
            if next.is_finite() {
                self.delayed_state = next;
            }
        }
        self.window.drop_oldest();
    }
}
