//! Maglev rig Feedback 33-942S (33-210): a steel ball below a coil whose driver regulates the current.
//!
//! A. J. Humaidi et al., "Experimental Design and Verification of Extended State Observers for Magnetic Levitation System
//! Based on PSO", Open Electr. Electron. Eng. J. 12, 110-120, 2018. Its equations are pictures; these are filled in so
//! that the words around them and Table 1 fit:
//!
//! ```text
//! m x'' = m g - f + F       f = K i^2 / x^2       i = k1 u                                       (3) to (5)
//! x'' = g - a u^2 / x^2 + F / m,     a = K k1^2 / m                                              (6), (7)
//! ```
//!
//! x \[m\] is the distance from coil to ball, positive downwards; u >= 0 \[V\] the voltage; F \[N\] a disturbing force.
//! The sensor reads k2 x + eta in volts (from the rig's manual), so that its voltage grows as the ball falls.

use super::contact::{Contact, Guided};
use super::end_stops;
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// Longest step of the integrator \[s\]: with order 5 far below the double's resolution around the operating point,
/// where the time constant is 21 ms; close to the coil at full voltage it is 0.12 ms.
pub const LONGEST_SUBSTEP: f64 = 5e-5;

/// Position and velocity of the ball.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// x \[m\]
    pub position: f64,
    /// x' \[m/s\]
    pub velocity: f64,
}

/// Physical parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaglevRig<S = f64> {
    /// m \[kg\]
    pub mass: S,
    /// g \[m/s2\]
    pub gravity: S,
    /// K \[N m2/A2\]
    pub electromagnetic_constant: S,
    /// k1 \[A/V\] of the driver with its inner current loop.
    pub driver_gain: S,
}

impl<S: Scalar> MaglevRig<S> {
    /// f of (5), upwards \[N\], for a `position` \[m\] and a `voltage` \[V\].
    #[inline]
    pub fn magnetic_force(&self, position: S, voltage: S) -> S {
        let current_per_distance = self.driver_gain * voltage / position;
        self.electromagnetic_constant * current_per_distance * current_per_distance
    }

    /// x'' of (6) \[m/s2\], with a disturbing `force` \[N\].
    #[inline]
    pub fn acceleration(&self, position: S, voltage: S, force: S) -> S {
        self.gravity - (self.magnetic_force(position, voltage) - force) / self.mass
    }
}

impl MaglevRig {
    /// Table 1 of the paper.
    pub const PRINTED: Self =
        Self { mass: 0.02, gravity: 9.8, electromagnetic_constant: 2.5e-5, driver_gain: 1.05 };

    /// u0 \[V\] that holds the ball at `position` \[m\], 0.758947 V at 9 mm.
    pub fn operating_voltage(&self, position: f64) -> f64 {
        position * libm::sqrt(self.mass * self.gravity / self.electromagnetic_constant) / self.driver_gain
    }

    /// The linear model around the rest at `position` \[m\].
    pub fn linearised(&self, position: f64) -> LinearModel {
        LinearModel {
            stiffness: 2.0 * self.gravity / position,
            input_gain: -2.0 * self.gravity / self.operating_voltage(position),
        }
    }
}

/// The ball between its stops, with all inputs held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldBall<S = f64> {
    pub rig: MaglevRig<S>,
    /// At the driver \[V\], within its limits.
    pub voltage: S,
    /// Disturbance, positive downwards \[N\].
    pub force: S,
    /// Position at which the ball touches the coil, above 0 \[m\].
    pub upper_stop: S,
    /// Position at which it lies below, above [`Self::upper_stop`] \[m\].
    pub lower_stop: S,
}

impl HeldBall {
    /// State and contact after `duration` \[s\].
    #[inline]
    pub fn advance(&self, state: State, contact: Contact, duration: f64) -> (State, Contact) {
        let (mut numbers, mut contact) = ([state.position, state.velocity], contact);
        end_stops::advance(self, &mut numbers, &mut contact, duration, LONGEST_SUBSTEP);
        let [position, velocity] = numbers;
        (State { position, velocity }, contact)
    }
}

impl<S: Scalar> Guided<2, S> for HeldBall<S> {
    /// Beyond the upper stop, where only the search for an impact looks, the force is that at the stop: it has a pole
    /// at x = 0.
    #[inline]
    fn rate(&self, &[position, velocity]: &[S; 2]) -> [S; 2] {
        [velocity, self.rig.acceleration(position.max(self.upper_stop), self.voltage, self.force)]
    }

    #[inline]
    fn rate_at_rest(&self, _: &[S; 2]) -> [S; 2] {
        [S::from(0.0); 2]
    }

    fn stops(&self) -> (S, S) {
        (self.upper_stop, self.lower_stop)
    }
}

/// dx'' = stiffness dx + input_gain du; in sensor volts the input gain is k2 times as large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearModel {
    /// 2 g / x0 \[1/s2\], the square of the unstable pole.
    pub stiffness: f64,
    /// -2 g / u0 \[m/(s2 V)\]
    pub input_gain: f64,
}

/// Position sensor, linear within its range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionSensor<S = f64> {
    /// k2 \[V/m\]
    pub gain: S,
    /// eta \[V\]
    pub offset: S,
}

impl<S: Scalar> PositionSensor<S> {
    /// k2 x + eta \[V\]
    #[inline]
    pub fn voltage(&self, position: S) -> S {
        self.gain * position + self.offset
    }

    /// Inverse of [`Self::voltage`] \[m\].
    #[inline]
    pub fn position(&self, voltage: S) -> S {
        (voltage - self.offset) / self.gain
    }
}

impl PositionSensor {
    /// Of the rig's manual: -1.50868 V at 9 mm.
    pub const MANUAL: Self = Self { gain: 143.48, offset: -2.8 };
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RIG: MaglevRig = MaglevRig::PRINTED;

    #[test]
    fn operating_point_is_that_of_the_reconstruction() {
        assert!((RIG.operating_voltage(9e-3) - 0.758_947).abs() < 1e-6);
        let linear = RIG.linearised(9e-3);
        assert!((linear.stiffness / 2177.78 - 1.0).abs() < 1e-5);
        assert!((PositionSensor::MANUAL.gain * linear.input_gain / -3705.41 - 1.0).abs() < 1e-5);
        assert_eq!(PositionSensor::MANUAL.voltage(9e-3), -1.50868);
    }

    fn held(voltage: f64) -> HeldBall {
        HeldBall { rig: RIG, voltage, force: 0.0, upper_stop: 1e-3, lower_stop: 25e-3 }
    }

    #[test]
    fn free_fall_ends_on_the_lower_stop() {
        // From 9 mm with v0 = 0 to 25 mm in sqrt(2 * 16 mm / g).
        let start = State { position: 9e-3, velocity: 0.0 };
        let impact = (2.0 * 16e-3 / 9.8f64).sqrt();
        let (before, contact) = held(0.0).advance(start, Contact::None, impact * (1.0 - 1e-9));
        assert!((before.velocity - 9.8 * impact).abs() < 1e-8 && contact == Contact::None);
        let (after, contact) = held(0.0).advance(start, Contact::None, impact * (1.0 + 1e-9));
        assert_eq!((after.position, after.velocity, contact), (25e-3, 0.0, Contact::AtLargestPosition));
    }

    #[test]
    fn ball_sticks_to_the_coil_until_the_force_is_too_small() {
        let start = State { position: 9e-3, velocity: 0.0 };
        let (at_coil, contact) = held(5.0).advance(start, Contact::None, 0.1);
        assert_eq!((at_coil.position, at_coil.velocity, contact), (1e-3, 0.0, Contact::AtSmallestPosition));
        // What holds it there is a ninth of what holds it at 9 mm.
        let holding = RIG.operating_voltage(1e-3);
        assert_eq!(held(1.001 * holding).advance(at_coil, contact, 0.1).1, Contact::AtSmallestPosition);
        let (falling, contact) = held(0.0).advance(at_coil, contact, 0.01);
        assert_eq!(contact, Contact::None);
        assert!((falling.position - 1e-3 - 0.5 * 9.8 * 1e-4).abs() < 1e-15);
    }

    #[test]
    fn energy_is_conserved_under_a_held_voltage() {
        // v^2 / 2 - g x - a u^2 / x
        let energy = |state: State, u: f64| {
            0.5 * state.velocity * state.velocity
                - 9.8 * state.position
                - 1.378_125e-3 * u * u / state.position
        };
        for (voltage, duration) in [(0.0, 0.05), (0.7, 0.06), (1.0, 0.03), (3.0, 0.007)] {
            let start = State { position: 9e-3, velocity: 0.01 };
            let (end, contact) = held(voltage).advance(start, Contact::None, duration);
            assert_eq!(contact, Contact::None, "{voltage} V: {end:?}");
            let difference = energy(end, voltage) - energy(start, voltage);
            assert!(difference.abs() < 1e-11 * energy(start, voltage).abs(), "{voltage} V: {difference:e}");
        }
    }

    #[test]
    fn start_beyond_a_stop_is_at_the_stop() {
        let ball = held(0.0);
        for (given, expected, contact) in [
            ([1.0, 2.0], [25e-3, 0.0], Contact::AtLargestPosition),
            ([9e-3, 0.3], [9e-3, 0.3], Contact::None),
        ] {
            let mut start = crate::plant::contact::settled(given, ball.stops());
            assert_eq!(start, expected);
            assert_eq!(crate::plant::contact::transition(&ball, &mut start, Contact::None), contact);
            assert_eq!(start, expected);
        }
    }

    proptest! {
        #[test]
        fn ball_rests_at_its_operating_voltage(position in 1e-3..0.03f64, force in -0.1..0.1f64) {
            let voltage = RIG.operating_voltage(position);
            prop_assert!(RIG.acceleration(position, voltage, 0.0).abs() < 1e-13);
            prop_assert!((RIG.acceleration(position, voltage, force) - force / 0.02).abs() < 1e-12);
            let back = PositionSensor::MANUAL.position(PositionSensor::MANUAL.voltage(position));
            prop_assert!((back - position).abs() < 1e-16 + 1e-15);
        }

        #[test]
        fn linear_model_is_the_derivative(position in 4e-3..0.02f64) {
            let voltage = RIG.operating_voltage(position);
            let (dx, du) = (1e-6 * position, 1e-6 * voltage);
            let linear = RIG.linearised(position);
            let along_x = RIG.acceleration(position + dx, voltage, 0.0) - RIG.acceleration(position - dx, voltage, 0.0);
            let along_u = RIG.acceleration(position, voltage + du, 0.0) - RIG.acceleration(position, voltage - du, 0.0);
            prop_assert!((along_x / (2.0 * dx) / linear.stiffness - 1.0).abs() < 1e-8);
            prop_assert!((along_u / (2.0 * du) / linear.input_gain - 1.0).abs() < 1e-8);
        }
    }
}
