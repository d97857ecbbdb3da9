//! The rig for importers that integrate it: derivatives, end stops as events, partial derivatives.

use super::*;
use crate::unit::end_stop_events::{Start, indicators};

impl MaglevRigPlant {
    /// The ball under the present inputs.
    fn held(&self) -> HeldBall {
        self.ball(self.driver_voltage(), self.values[FORCE])
    }

    fn is_free(&self) -> bool {
        self.contact == Contact::None
    }

    /// Partial derivatives of the voltage within the driver's limits.
    fn driver_voltage_slope(&self, known: usize) -> f64 {
        let (asked, limits) =
            (self.values[VOLTAGE_INPUT], [self.values[VOLTAGE_MIN], self.values[VOLTAGE_MAX]]);
        let acts = match known {
            VOLTAGE_INPUT => asked >= limits[0] && asked <= limits[1],
            VOLTAGE_MIN => asked < limits[0],
            VOLTAGE_MAX => asked > limits[1],
            _ => false,
        };
        f64::from(u8::from(acts))
    }

    /// Partial derivatives of x'' = g - K k1^2 u^2 / (m x^2) + F / m.
    fn acceleration_slope(&self, known: usize) -> f64 {
        let HeldBall { rig, voltage, force, upper_stop, .. } = self.held();
        let MaglevRig { mass, electromagnetic_constant, driver_gain, .. } = rig;
        let position = self.values[POSITION].max(upper_stop);
        // K k1^2 / (m x^2), so that the magnet's share is minus this times u^2.
        let gain = driver_gain / position;
        let pull = electromagnetic_constant * gain * gain / mass;
        let square = voltage * voltage;
        match known {
            POSITION if self.values[POSITION] >= upper_stop => 2.0 * pull * square / position,
            UPPER_STOP if self.values[POSITION] < upper_stop => 2.0 * pull * square / position,
            VOLTAGE_INPUT | VOLTAGE_MIN | VOLTAGE_MAX => {
                -2.0 * pull * voltage * self.driver_voltage_slope(known)
            }
            FORCE => 1.0 / mass,
            GRAVITY => 1.0,
            MASS => (pull * square - force / mass) / mass,
            FORCE_CONSTANT => -gain * gain * square / mass,
            DRIVER_GAIN_PARAMETER => -2.0 * electromagnetic_constant * gain * square / (position * mass),
            _ => 0.0,
        }
    }

    /// Partial derivatives of k2 x + eta.
    fn sensor_voltage_slope(&self, known: usize) -> f64 {
        match known {
            POSITION => self.values[SENSOR_GAIN],
            SENSOR_GAIN => self.values[POSITION],
            SENSOR_OFFSET => 1.0,
            _ => 0.0,
        }
    }

    /// Partial derivatives of the sensor voltage within its range.
    fn ranged_slope(&self, known: usize) -> f64 {
        let (voltage, acts) = (self.values[SENSOR_VOLTAGE], |acts: bool| f64::from(u8::from(acts)));
        let (minimum, maximum) = (self.values[SENSOR_MINIMUM], self.values[SENSOR_MAXIMUM]);
        match known {
            SENSOR_MINIMUM => acts(voltage < minimum),
            SENSOR_MAXIMUM => acts(voltage > maximum),
            _ if voltage < minimum || voltage > maximum => 0.0,
            _ => self.sensor_voltage_slope(known),
        }
    }

    /// Partial derivatives of the voltage within the driver's limits, or of the current that it drives.
    fn drive_slope(&self, unknown: usize, known: usize) -> f64 {
        match (unknown, known) {
            (VOLTAGE_MEASURED, _) => self.driver_voltage_slope(known),
            (_, DRIVER_GAIN_PARAMETER) => self.driver_voltage(),
            _ => self.values[DRIVER_GAIN_PARAMETER] * self.driver_voltage_slope(known),
        }
    }

    /// Partial derivatives of the first reading; the seed is no real number.
    fn first_reading_slope(&self, known: usize) -> f64 {
        let values = &self.values;
        let (reading, resolution) = (values[SENSOR_VOLTAGE_MEASURED], values[SENSOR_RESOLUTION]);
        let (minimum, maximum) = (values[SENSOR_MINIMUM], values[SENSOR_MAXIMUM]);
        let sample = Sensor::first_noise(values[SENSOR_SEED]);
        let unlimited = quantise(values[SENSOR_VOLTAGE] + values[SENSOR_NOISE] * sample, resolution);
        match known {
            SENSOR_MINIMUM => f64::from(u8::from(unlimited < minimum)),
            SENSOR_MAXIMUM => f64::from(u8::from(unlimited > maximum)),
            _ if unlimited < minimum || unlimited > maximum => 0.0,
            // The number of steps in the reading.
            SENSOR_RESOLUTION if resolution != 0.0 => reading / resolution,
            _ if resolution != 0.0 => 0.0,
            SENSOR_NOISE => sample,
            _ => self.initial_partial_derivative(SENSOR_VOLTAGE, known),
        }
    }

    /// Partial derivatives of the states at the start with respect to parameters.
    fn start_slope(&self, state: usize, known: usize) -> f64 {
        let values = &self.values;
        let (given, smallest, largest) = (values[INITIAL_POSITION], values[UPPER_STOP], values[LOWER_STOP]);
        let start = Start { given, smallest, largest };
        let [by_given, by_smallest, by_largest] = start.position_slopes();
        match (state, known) {
            (POSITION, INITIAL_POSITION) => by_given,
            (POSITION, UPPER_STOP) => by_smallest,
            (POSITION, LOWER_STOP) => by_largest,
            (VELOCITY, INITIAL_VELOCITY) => start.velocity_slope(values[INITIAL_VELOCITY]),
            _ => 0.0,
        }
    }
}

impl ContinuousUnit for MaglevRigPlant {
    #[inline]
    fn evaluate(&mut self) {
        let (held, state) = (self.held(), self.state());
        let [position_rate, acceleration] = rate_in_contact(&held, &state, self.contact);
        let [at_upper_stop, at_lower_stop] = indicators(&held, &state, self.contact);
        let sensor_voltage = self.sensor_voltage(state[0]);
        let values = &mut self.values;
        values[POSITION_DERIVATIVE] = position_rate;
        values[ACCELERATION] = acceleration;
        values[UPPER_STOP_INDICATOR] = at_upper_stop;
        values[LOWER_STOP_INDICATOR] = at_lower_stop;
        values[SENSOR_VOLTAGE] = sensor_voltage;
        values[MAGNETIC_FORCE] = held.rig.magnetic_force(state[0].max(held.upper_stop), held.voltage);
        if self.solver == Solver::Importer {
            self.echo(held.voltage);
            if !self.sensor.is_read(self.solver) {
                self.values[SENSOR_VOLTAGE_MEASURED] = self.within_range(sensor_voltage, sensor_voltage);
            }
        }
    }

    fn set_solver(&mut self, solver: Solver) -> bool {
        core::mem::replace(&mut self.solver, solver) != solver
    }

    fn update_discrete_states(&mut self) -> bool {
        let before = self.state();
        let mut state = before;
        let contact = transition(&self.held(), &mut state, self.contact);
        self.set_state(state, contact);
        if self.sensor.reaches_reading(self.values[TIME]) {
            self.read_sensor(self.sensor_voltage(state[0]));
        }
        state != before
    }

    fn next_event_time(&self) -> Option<f64> {
        self.sensor.next_reading(self.values[TIME])
    }

    fn partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        match unknown {
            POSITION | VELOCITY => f64::from(u8::from(unknown == known)),
            POSITION_DERIVATIVE => f64::from(u8::from(known == VELOCITY && self.is_free())),
            ACCELERATION if self.is_free() => self.acceleration_slope(known),
            SENSOR_VOLTAGE => self.sensor_voltage_slope(known),
            SENSOR_VOLTAGE_MEASURED if !self.sensor.is_read(self.solver) => self.ranged_slope(known),
            VOLTAGE_MEASURED | CURRENT if self.solver == Solver::Importer => self.drive_slope(unknown, known),
            _ => 0.0,
        }
    }

    fn initial_partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        if unknown == SENSOR_VOLTAGE_MEASURED && self.sensor.is_read(self.solver) {
            return self.first_reading_slope(known);
        }
        let through_states = [POSITION, VELOCITY]
            .map(|state| self.partial_derivative(unknown, state) * self.start_slope(state, known));
        self.partial_derivative(unknown, known) + through_states.iter().sum::<f64>()
    }

    fn input_slope(&self, input: usize) -> f64 {
        match input {
            VOLTAGE_INPUT => self.voltage_slope,
            FORCE => self.force_slope,
            _ => 0.0,
        }
    }

    fn set_input_slope(&mut self, input: usize, slope: f64) {
        match input {
            VOLTAGE_INPUT => self.voltage_slope = slope,
            FORCE => self.force_slope = slope,
            _ => {}
        }
    }
}
