//! Feedback-linearising law of the levitated ball, (22) and (23) of "Sensorless control of the levitated ball".

use crate::plant::levitated_ball::{LevitatedBall, State};
use crate::signal::SmoothReference;
use serde::{Deserialize, Serialize};

/// Share of the equilibrium flux below which the law does not divide by the flux; assumed, the paper has no guard.
const SMALLEST_FLUX: f64 = 0.2;

/// What the law knows of ball and coil.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallFeedbackLinearisation {
    pub ball: LevitatedBall,
    /// rho \[1/s\]: the error of the position has a triple pole at -rho.
    pub pole: f64,
}

impl BallFeedbackLinearisation {
    /// Voltage \[V\] before saturation, with the measured `current` \[A\].
    ///
    /// ```text
    /// y''' = lam (u - R i) / (k m)
    /// u = R i + (k m / lam) (y*''' - a2 (lam^2 / (2 k m) - g - y*'') - a1 (y' - y*') - a0 (y - y*))      (22)
    /// e''' + a2 e'' + a1 e' + a0 e = 0,   e = y - y*,   a0 = rho^3,  a1 = 3 rho^2,  a2 = 3 rho           (23)
    /// ```
    #[inline]
    pub fn voltage(&self, state: State, current: f64, reference: SmoothReference) -> f64 {
        let Self { ball, pole } = self;
        let inertia = ball.inductance_constant * ball.mass;
        let acceleration = state.flux * state.flux / (2.0 * inertia) - ball.gravity;
        let jerk = reference.jerk
            - 3.0 * pole * (acceleration - reference.acceleration)
            - 3.0 * pole * pole * (state.velocity - reference.velocity)
            - pole * pole * pole * (state.position - reference.position);
        let flux = state.flux.max(SMALLEST_FLUX * ball.equilibrium_flux());
        ball.resistance * current + inertia / flux * jerk
    }
}
