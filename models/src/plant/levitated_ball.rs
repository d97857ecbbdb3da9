//! Steel ball under an electromagnet.
//!
//! Paper: "Sensorless control of the levitated ball" (arXiv 1811.07732), equation (1); the available text has lost its
//! formulas, the signs are those of the book it refers to (Ortega, Loria, Nicklasson, Sira-Ramirez, "Passivity-based
//! control of Euler-Lagrange systems", chapter 8). With y the position upwards \[m\], p the momentum \[kg m/s\], lam the
//! flux linkage \[Wb\], u the coil voltage \[V\] and F a disturbing force upwards \[N\], which is not in the paper:
//!
//! ```text
//! lam' = u - R i      y' = p/m      p' = lam^2/(2k) - m g + F      i = (c - y) lam / k                 (1)
//! ```
//!
//! The magnet's face is at y = c.

use super::contact::{Contact, Guided};
use super::end_stops::advance;
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// What the ball, the coil and gravity are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevitatedBall<S = f64> {
    /// m \[kg\]
    pub mass: S,
    /// R \[Ohm\]
    pub resistance: S,
    /// k \[N m2/A2\], the inductance is k / (c - y)
    pub inductance_constant: S,
    /// c \[m\], gap at y = 0
    pub gap: S,
    /// g \[m/s2\]
    pub gravity: S,
}

/// State of ball and coil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// y \[m\]
    pub position: f64,
    /// p / m \[m/s\]
    pub velocity: f64,
    /// lam \[Wb\]
    pub flux: f64,
}

impl State {
    /// Whether no component is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.velocity.is_finite() && self.flux.is_finite()
    }
}

/// What acts on the ball from outside and is held, or how fast it moves, each per second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive<S = f64> {
    /// u \[V\]
    pub voltage: S,
    /// F \[N\], upwards
    pub force: S,
}

impl<S: Scalar> LevitatedBall<S> {
    /// i of (1) \[A\]
    #[inline]
    pub fn current(&self, position: S, flux: S) -> S {
        (self.gap - position) * flux / self.inductance_constant
    }

    /// lam^2 / (2 k) \[N\]
    #[inline]
    pub fn magnetic_force(&self, flux: S) -> S {
        flux * flux / (S::from(2.0) * self.inductance_constant)
    }
}

impl LevitatedBall {
    /// Laboratory rig that all studies assume; the paper's own numbers are not in its text.
    pub const LABORATORY: Self =
        Self { mass: 0.0844, resistance: 2.52, inductance_constant: 6.4042e-5, gap: 0.005, gravity: 9.81 };

    /// lam0 = sqrt(2 k m g) \[Wb\]: the flux that carries the ball, wherever it is.
    pub fn equilibrium_flux(&self) -> f64 {
        libm::sqrt(2.0 * self.inductance_constant * self.mass * self.gravity)
    }

    /// The state at rest at `position` \[m\].
    pub fn equilibrium(&self, position: f64) -> State {
        State { position, velocity: 0.0, flux: self.equilibrium_flux() }
    }

    /// Lets `duration` \[s\] pass under a held `drive`, between the magnet's face and `lower_stop` \[m\].
    #[inline]
    pub fn advance(
        &self,
        lower_stop: f64,
        state: &mut State,
        contact: &mut Contact,
        drive: Drive,
        duration: f64,
    ) {
        let driven = DrivenBall::new(self, lower_stop, drive);
        driven.advance(state, contact, duration, self.longest_substep(lower_stop));
    }

    /// As [`Self::advance`] with a drive that starts from `drive` and moves with `slope` \[V/s, N/s\].
    pub fn advance_under_ramp(
        &self,
        lower_stop: f64,
        state: &mut State,
        contact: &mut Contact,
        drive: Drive,
        slope: Drive,
        duration: f64,
    ) {
        let ramped = RampedBall {
            begin: DrivenBall::new(self, lower_stop, drive),
            voltage_slope: slope.voltage,
            acceleration_slope: slope.force / self.mass,
        };
        let mut components = [state.position, state.velocity, state.flux, 0.0];
        advance(&ramped, &mut components, contact, duration, self.longest_substep(lower_stop));
        let [position, velocity, flux, _] = components;
        *state = State { position, velocity, flux };
    }

    /// 0.1 ms, or a twentieth of the coil's shortest time constant k / (R (c - y)) if that is less \[s\]. The error of a step is
    /// then below 5e-12 of the distance of the flux from its steady value.
    #[inline]
    pub fn longest_substep(&self, lower_stop: f64) -> f64 {
        (0.05 * self.inductance_constant / (self.resistance * (self.gap - lower_stop))).min(1e-4)
    }
}

impl Drive {
    /// After `duration` \[s\] of moving with `slope`.
    #[inline]
    pub fn after(self, slope: Self, duration: f64) -> Self {
        Self { voltage: self.voltage + slope.voltage * duration, force: self.force + slope.force * duration }
    }
}

/// The ball under a held drive, position y, velocity y', flux lam: what [`advance`] moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenBall<S = f64> {
    gap: S,
    lower_stop: S,
    voltage: S,
    constants: BallConstants<S>,
    /// -g + F / m
    constant_acceleration: S,
}

impl<S: Scalar> DrivenBall<S> {
    #[inline]
    pub fn new(ball: &LevitatedBall<S>, lower_stop: S, drive: Drive<S>) -> Self {
        Self::with(BallConstants::of(ball), ball, lower_stop, drive)
    }

    /// As [`Self::new`] with the constants of the same ball.
    #[inline]
    pub fn with(
        constants: BallConstants<S>,
        ball: &LevitatedBall<S>,
        lower_stop: S,
        drive: Drive<S>,
    ) -> Self {
        Self {
            gap: ball.gap,
            lower_stop,
            voltage: drive.voltage,
            constants,
            constant_acceleration: drive.force / ball.mass - ball.gravity,
        }
    }
}

impl DrivenBall {
    /// Lets `duration` \[s\] pass in steps of at most `longest_substep` \[s\].
    #[inline]
    pub fn advance(&self, state: &mut State, contact: &mut Contact, duration: f64, longest_substep: f64) {
        let mut components = [state.position, state.velocity, state.flux];
        advance(self, &mut components, contact, duration, longest_substep);
        let [position, velocity, flux] = components;
        *state = State { position, velocity, flux };
    }
}

/// What the equations of a ball divide by, once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallConstants<S = f64> {
    /// R / k
    damping: S,
    /// 1 / (2 k m)
    lift: S,
}

impl<S: Scalar> BallConstants<S> {
    #[inline]
    pub fn of(ball: &LevitatedBall<S>) -> Self {
        Self {
            damping: ball.resistance / ball.inductance_constant,
            lift: S::from(0.5) / (ball.inductance_constant * ball.mass),
        }
    }
}

impl<S: Scalar> Guided<3, S> for DrivenBall<S> {
    #[inline(always)]
    fn rate(&self, &[position, velocity, flux]: &[S; 3]) -> [S; 3] {
        [
            velocity,
            self.constants.lift * flux * flux + self.constant_acceleration,
            self.voltage - self.constants.damping * (self.gap - position) * flux,
        ]
    }

    fn stops(&self) -> (S, S) {
        (self.lower_stop, self.gap)
    }
}

/// The ball under a drive that moves along a straight line: the fourth state is the time since it began \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct RampedBall {
    begin: DrivenBall,
    /// \[V/s\]
    voltage_slope: f64,
    /// Of the disturbing force per mass \[m/s3\].
    acceleration_slope: f64,
}

impl Guided<4> for RampedBall {
    #[inline(always)]
    fn rate(&self, &[position, velocity, flux, time]: &[f64; 4]) -> [f64; 4] {
        let [position_rate, velocity_rate, flux_rate] = self.begin.rate(&[position, velocity, flux]);
        [
            position_rate,
            velocity_rate + self.acceleration_slope * time,
            flux_rate + self.voltage_slope * time,
            1.0,
        ]
    }

    fn stops(&self) -> (f64, f64) {
        self.begin.stops()
    }
}
