//! The maglev rig as its model-based observers see it: the ball under a disturbing acceleration.
//!
//! ```text
//! x' = v      v' = g - a u^2 / x^2 + d      d' = 0            (6) of the rig's paper with F = m d
//! ```
//!
//! over a sample, by one classical Runge-Kutta step. d stands for whatever the model does not know: a force, another mass.

use super::factored_covariance::FactoredCovariance;
use super::process_model::ProcessModel;
use super::sampled_extended_state::DIVERGED;
use crate::plant::maglev_rig::MaglevRig;
use serde::{Deserialize, Serialize};

/// Position \[m\] up to which the force grows: it has a pole at x = 0, and no ball is closer to the coil.
const CLOSEST: f64 = 1e-4;

/// The rig with states x \[m\], x' \[m/s\], d \[m/s2\]; the input is the voltage \[V\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisturbedRig {
    pub rig: MaglevRig,
    /// T \[s\]
    pub sample_time: f64,
}

impl DisturbedRig {
    /// a u^2 \[m3/s2\]: the force is that at 1 m over x^2, which costs a division instead of two.
    #[inline(always)]
    fn attraction(&self, voltage: f64) -> f64 {
        self.rig.magnetic_force(1.0, voltage) / self.rig.mass
    }

    /// x'' without the disturbance \[m/s2\].
    #[inline(always)]
    fn undisturbed_acceleration(&self, position: f64, attraction: f64) -> f64 {
        let position = position.max(CLOSEST);
        self.rig.gravity - attraction / (position * position)
    }

    /// x'' \[m/s2\]
    #[inline]
    pub fn acceleration(&self, &[position, _, disturbance]: &[f64; 3], voltage: f64) -> f64 {
        self.undisturbed_acceleration(position, self.attraction(voltage)) + disturbance
    }

    /// The state at rest at `position` \[m\] under a `voltage` \[V\] that holds the ball there.
    pub fn at_rest(&self, position: f64, voltage: f64) -> [f64; 3] {
        [position, 0.0, -self.acceleration(&[position, 0.0, 0.0], voltage)]
    }

    /// Covariance of what a sample adds where d performs a random walk, with what that does to velocity and position:
    /// the integral of exp(A t) e3 e3^T exp(A t)^T over a sample, in factors. `intensity` is the standard deviation of d
    /// after a second \[m/s2\].
    #[inline]
    pub fn random_walk(&self, intensity: f64) -> FactoredCovariance<3> {
        let t = self.sample_time;
        let (density, square) = (intensity * intensity, t * t);
        let diagonal = [t * square * square / 720.0, t * square / 12.0, t].map(|variance| density * variance);
        FactoredCovariance::from_factors(
            diagonal,
            [[0.0, 0.5 * t, square / 6.0], [0.0, 0.0, 0.5 * t], [0.0; 3]],
        )
    }

    /// One Runge-Kutta step from a state with the given acceleration.
    #[inline(always)]
    fn step(&self, &[position, velocity, disturbance]: &[f64; 3], first: f64, attraction: f64) -> [f64; 3] {
        let (t, half) = (self.sample_time, 0.5 * self.sample_time);
        let acceleration = |position: f64| self.undisturbed_acceleration(position, attraction) + disturbance;
        let second_velocity = velocity + first * half;
        let second = acceleration(position + velocity * half);
        let third_velocity = velocity + second * half;
        let third = acceleration(position + second_velocity * half);
        let fourth_velocity = velocity + third * t;
        let fourth = acceleration(position + third_velocity * t);
        let sum = |a: f64, b: f64, c: f64, d: f64| (a + (b + c) * 2.0 + d) * (t / 6.0);
        [
            position + sum(velocity, second_velocity, third_velocity, fourth_velocity),
            velocity + sum(first, second, third, fourth),
            disturbance,
        ]
    }
}

/// Result of one sample of a model-based observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigEstimate {
    /// x \[m\], x' \[m/s\], d \[m/s2\]
    pub state: [f64; 3],
    /// Measured position less what was expected from the samples before \[m\].
    pub innovation: f64,
    /// Whether the estimate left every plausible range, so that the observer started anew from the measurement.
    pub restarted: bool,
}

/// Whether an estimate is that of a ball below its coil, and no component is beyond [`DIVERGED`] or not a number.
#[inline]
pub(super) fn is_plausible(state: &[f64; 3]) -> bool {
    state[0] > 0.0 && state.iter().all(|component| component.abs() <= DIVERGED)
}

impl ProcessModel<3> for DisturbedRig {
    #[inline]
    fn predict(&self, state: &[f64; 3], voltage: f64) -> [f64; 3] {
        self.step(state, self.acceleration(state, voltage), self.attraction(voltage))
    }

    /// The slope is I + A T + A^2 T^2 / 2 with the stiffness 2 a u^2 / x^3 at the start of the sample.
    #[inline]
    fn linearised(&self, state: &[f64; 3], voltage: f64) -> ([f64; 3], [[f64; 3]; 3]) {
        let [position, _, disturbance] = *state;
        let attraction = self.attraction(voltage);
        let undisturbed = self.undisturbed_acceleration(position, attraction);
        let stiffness =
            if position > CLOSEST { 2.0 * (self.rig.gravity - undisturbed) / position } else { 0.0 };
        let t = self.sample_time;
        let half_square = 0.5 * t * t;
        let growth = 1.0 + stiffness * half_square;
        let slope = [[growth, t, half_square], [stiffness * t, growth, t], [0.0, 0.0, 1.0]];
        (self.step(state, undisturbed + disturbance, attraction), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::contact::Contact;
    use crate::plant::maglev_rig::{HeldBall, State};
    use nalgebra::{Matrix3, Vector3};

    const MODEL: DisturbedRig = DisturbedRig { rig: MaglevRig::PRINTED, sample_time: 1e-3 };

    #[test]
    fn slope_is_the_derivative_of_the_prediction() {
        let state = [9.3e-3, 0.05, 2.0];
        let (predicted, slope) = MODEL.linearised(&state, 0.8);
        assert_eq!(predicted, MODEL.predict(&state, 0.8));
        for column in 0..3 {
            let shift = [1e-8, 1e-5, 1e-3][column];
            let at = |shift: f64| {
                let mut moved = state;
                moved[column] += shift;
                Vector3::from(MODEL.predict(&moved, 0.8))
            };
            let difference = (at(shift) - at(-shift)) / (2.0 * shift);
            let analytic = Vector3::from_fn(|row, _| slope[row][column]);
            // The slope is that at the start of the step, 1 % off over a millisecond.
            assert!((difference - analytic).norm() < 0.01 * analytic.norm(), "{difference} {analytic}");
        }
    }

    #[test]
    fn acceleration_is_that_of_the_plant_with_a_force() {
        for (position, voltage, disturbance) in [(9e-3, 0.76, 0.0), (2e-3, 4.0, -3.0), (25e-3, 0.0, 1.0)] {
            let expected = MODEL.rig.acceleration(position, voltage, disturbance * MODEL.rig.mass);
            let actual = MODEL.acceleration(&[position, 0.3, disturbance], voltage);
            assert!((actual - expected).abs() <= 1e-14 * (9.8 + expected.abs()), "{actual} {expected}");
        }
    }

    #[test]
    fn a_sample_is_that_of_the_plant() {
        // The plant's own integrator makes 20 steps of order 5 in a sample.
        let held = HeldBall {
            rig: MODEL.rig,
            voltage: 0.8,
            force: 2.0 * MODEL.rig.mass,
            upper_stop: 1e-3,
            lower_stop: 25e-3,
        };
        let (after, _) = held.advance(State { position: 9.3e-3, velocity: 0.05 }, Contact::None, 1e-3);
        let [position, velocity, _] = MODEL.predict(&[9.3e-3, 0.05, 2.0], 0.8);
        let errors = [position - after.position, velocity - after.velocity].map(f64::abs);
        assert!(errors[0] < 1e-11 && errors[1] < 1e-8, "{errors:?}");
    }

    #[test]
    fn rest_stays() {
        let rest = MODEL.at_rest(11e-3, 0.7);
        let after = MODEL.predict(&rest, 0.7);
        assert!((after[0] - 11e-3).abs() < 1e-17 && after[1].abs() < 1e-17 && after[2] == rest[2]);
    }

    #[test]
    fn random_walk_has_its_textbook_covariance() {
        let (t, q) = (MODEL.sample_time, 20.0f64);
        let covariance = MODEL.random_walk(q).matrix();
        let [p1, p2, p3, v3, v4, v5] =
            [t, t * t / 2.0, t * t * t / 6.0, t * t * t / 3.0, t.powi(4) / 8.0, t.powi(5) / 20.0];
        let expected = Matrix3::new(v5, v4, p3, v4, v3, p2, p3, p2, p1) * (q * q);
        assert!((covariance - expected).component_div(&expected).amax() < 1e-14, "{covariance} {expected}");
    }

    #[test]
    fn force_stays_finite_up_to_the_coil_and_beyond() {
        for position in [1e-4, 0.0, -1.0] {
            let (state, slope) = MODEL.linearised(&[position, -1.0, 0.0], 5.0);
            assert!(state.iter().chain(slope.as_flattened()).all(|value| value.is_finite()));
        }
    }
}
