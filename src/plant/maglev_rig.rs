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

/// Position and velocity of the ball.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// x \[m\]
    pub position: f64,
    /// x' \[m/s\]
    pub velocity: f64,
}

/// Physical parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaglevRig {
    /// m \[kg\]
    pub mass: f64,
    /// g \[m/s2\]
    pub gravity: f64,
    /// K \[N m2/A2\]
    pub electromagnetic_constant: f64,
    /// k1 \[A/V\] of the driver with its inner current loop.
    pub driver_gain: f64,
}

impl MaglevRig {
    /// Table 1 of the paper.
    pub const PRINTED: Self =
        Self { mass: 0.02, gravity: 9.8, electromagnetic_constant: 2.5e-5, driver_gain: 1.05 };

    /// x'' of (6) \[m/s2\] at a `position` \[m\], for a `voltage` \[V\] and a disturbing `force` \[N\].
    #[inline]
    pub fn acceleration(&self, position: f64, voltage: f64, force: f64) -> f64 {
        let current_per_distance = self.driver_gain * voltage / position;
        self.gravity
            - (self.electromagnetic_constant * current_per_distance * current_per_distance - force)
                / self.mass
    }

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

/// dx'' = stiffness dx + input_gain du; in sensor volts the input gain is k2 times as large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearModel {
    /// 2 g / x0 \[1/s2\], the square of the unstable pole.
    pub stiffness: f64,
    /// -2 g / u0 \[m/(s2 V)\]
    pub input_gain: f64,
}

/// Position sensor, linear within its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionSensor {
    /// k2 \[V/m\]
    pub gain: f64,
    /// eta \[V\]
    pub offset: f64,
}

impl PositionSensor {
    /// Of the rig's manual: -1.50868 V at 9 mm.
    pub const MANUAL: Self = Self { gain: 143.48, offset: -2.8 };

    /// k2 x + eta \[V\]
    #[inline]
    pub fn voltage(&self, position: f64) -> f64 {
        self.gain * position + self.offset
    }

    /// Inverse of [`Self::voltage`] \[m\].
    #[inline]
    pub fn position(&self, voltage: f64) -> f64 {
        (voltage - self.offset) / self.gain
    }
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
