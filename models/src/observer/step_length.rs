//! How much of a Newton step is taken: alpha of Remark 2, and the varying step size of Remark 5
//! (Mystkowski, Kotta, Kaparin 2018).

use super::CONVERGED;
use super::newton_settings::NewtonSettings;
use crate::plant::magnetic_bearing::State;

/// How often the line search halves a step before it gives up.
const MAX_HALVINGS: u32 = 40;

/// w + lambda * step
#[inline]
pub(super) fn moved(w: State, step: State, length: f64) -> State {
    State {
        position: w.position + length * step.position,
        velocity: w.velocity + length * step.velocity,
        flux: w.flux + length * step.flux,
    }
}

/// alpha, with a line search halved until the step decreases |Y - H(w)|^2; alpha also where no length of it does,
/// or the step is too small for the residual to tell.
pub(super) fn step_length(
    settings: &NewtonSettings,
    start: State,
    step: State,
    squared_residual: impl Fn(State) -> f64,
) -> f64 {
    let full = settings.step_size;
    if !settings.line_search || step.flux.abs() <= CONVERGED * start.flux.abs() {
        return full;
    }
    let before = squared_residual(start);
    let mut length = full;
    for _ in 0..MAX_HALVINGS {
        if squared_residual(moved(start, step, length)) < before {
            return length;
        }
        length /= 2.0;
    }
    full
}
