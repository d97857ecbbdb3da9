//! The paper's objective (15), in the form that its text suggests:
//!
//! ```text
//! J = rms e1 + rms e2 + Mp1 + Mp2                                                                   (15)
//! ```
//!
//! of the errors of position \[m\] and velocity \[m/s\]; weights are not printed. Mp, "max overshoot", is taken here as
//! what the peak of an estimate exceeds the peak of the truth by. Also assumed: position in metres, an observer that
//! starts from zero, one Runge-Kutta step per millisecond with the measurement interpolated.

use crate::observer::extended_state::{ExtendedState, ExtendedStateModel, Injection};
use crate::study::rig::recording::{Recording, SAMPLE_TIME};

/// J of an observer that is not finite.
pub const DIVERGED: f64 = 1e6;
/// Estimates beyond this \[m, m/s\] are on their way to infinity.
const LOST: f64 = 1e12;

/// Parts of J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// rms e1 \[m\]
    pub position: f64,
    /// rms e2 \[m/s\]
    pub velocity: f64,
    /// Mp1 \[m\]
    pub position_overshoot: f64,
    /// Mp2 \[m/s\]
    pub velocity_overshoot: f64,
}

impl Errors {
    /// J
    pub fn total(&self) -> f64 {
        self.position + self.velocity + self.position_overshoot + self.velocity_overshoot
    }
}

/// Runs an observer from zero over a recording, in metres; `None` if it diverges. `each` sees every estimate.
pub fn watch(
    model: &ExtendedStateModel<impl Injection>,
    recording: &Recording,
    mut each: impl FnMut(usize, ExtendedState),
) -> Option<()> {
    let mut z = ExtendedState::default();
    each(0, z);
    let moves = recording.position.windows(2).zip(&recording.voltage);
    for (sample, (positions, voltage)) in moves.enumerate() {
        let (start, end) = (positions[0], positions[1]);
        z = model.runge_kutta_step(z, [start, 0.5 * (start + end), end], *voltage, SAMPLE_TIME);
        // False, too, for what is not a number.
        let is_finite = z.position.abs() < LOST && z.velocity.abs() < LOST;
        if !is_finite {
            return None;
        }
        each(sample + 1, z);
    }
    Some(())
}

/// J and its parts; `None` if the observer diverges.
pub fn errors(model: &ExtendedStateModel<impl Injection>, recording: &Recording) -> Option<Errors> {
    let (mut squares, mut peaks) = ((0.0, 0.0), (f64::NEG_INFINITY, 0.0f64));
    watch(model, recording, |sample, z| {
        let position_error = recording.position[sample] - z.position;
        let velocity_error = recording.velocity[sample] - z.velocity;
        squares.0 += position_error * position_error;
        squares.1 += velocity_error * velocity_error;
        peaks.0 = peaks.0.max(z.position);
        peaks.1 = peaks.1.max(z.velocity.abs());
    })?;
    let count = recording.len() as f64;
    let highest = recording.position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let fastest = recording.velocity.iter().fold(0.0f64, |peak, velocity| peak.max(velocity.abs()));
    Some(Errors {
        position: (squares.0 / count).sqrt(),
        velocity: (squares.1 / count).sqrt(),
        position_overshoot: (peaks.0 - highest).max(0.0),
        velocity_overshoot: (peaks.1 - fastest).max(0.0),
    })
}

/// J, [`DIVERGED`] if there is none.
pub fn cost(model: &ExtendedStateModel<impl Injection>, recording: &Recording) -> f64 {
    errors(model, recording).map_or(DIVERGED, |errors| errors.total())
}
