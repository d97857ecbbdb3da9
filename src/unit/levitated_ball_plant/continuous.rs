//! The ball for importers that integrate it: derivatives, end stops as events, partial derivatives.

use super::*;
use crate::unit::end_stop_events::{Start, indicators};

impl LevitatedBallPlant {
    /// The ball under the present inputs.
    fn driven(&self) -> DrivenBall {
        let drive = Drive { voltage: self.values[VOLTAGE_INPUT], force: self.values[FORCE_INPUT] };
        DrivenBall::new(&self.ball, self.values[LOWER_STOP], drive)
    }

    fn is_free(&self) -> bool {
        self.contact == Contact::None
    }

    /// Partial derivatives of i = (c - y) lam / k.
    fn current_slope(&self, known: usize) -> f64 {
        let (k, gap) = (self.ball.inductance_constant, self.ball.gap - self.values[POSITION_OUTPUT]);
        let flux = self.values[FLUX_OUTPUT];
        match known {
            POSITION_OUTPUT => -flux / k,
            FLUX_OUTPUT => gap / k,
            GAP => flux / k,
            INDUCTANCE_CONSTANT => -gap * flux / (k * k),
            _ => 0.0,
        }
    }

    /// Partial derivatives of (lam^2 / (2 k) + F) / m - g.
    fn acceleration_slope(&self, known: usize) -> f64 {
        let LevitatedBall { mass, inductance_constant, .. } = self.ball;
        let flux = self.values[FLUX_OUTPUT];
        let force = self.ball.magnetic_force(flux);
        match known {
            FLUX_OUTPUT => flux / (inductance_constant * mass),
            FORCE_INPUT => 1.0 / mass,
            GRAVITY => -1.0,
            MASS => -(force + self.values[FORCE_INPUT]) / (mass * mass),
            INDUCTANCE_CONSTANT => -force / (inductance_constant * mass),
            _ => 0.0,
        }
    }

    /// Partial derivatives of u - R i.
    fn flux_derivative_slope(&self, known: usize) -> f64 {
        match known {
            VOLTAGE_INPUT => 1.0,
            RESISTANCE => -self.ball.current(self.values[POSITION_OUTPUT], self.values[FLUX_OUTPUT]),
            _ => -self.ball.resistance * self.current_slope(known),
        }
    }

    /// Partial derivatives of the states at the start with respect to parameters.
    fn start_slope(&self, state: usize, known: usize) -> f64 {
        let values = &self.values;
        let (given, smallest, largest) = (values[INITIAL_POSITION], values[LOWER_STOP], values[GAP]);
        let start = Start { given, smallest, largest };
        let [by_given, by_smallest, by_largest] = start.position_slopes();
        match (state, known) {
            (POSITION_OUTPUT, INITIAL_POSITION) => by_given,
            (POSITION_OUTPUT, LOWER_STOP) => by_smallest,
            (POSITION_OUTPUT, GAP) => by_largest,
            (VELOCITY_OUTPUT, INITIAL_VELOCITY) => start.velocity_slope(values[INITIAL_VELOCITY]),
            (FLUX_OUTPUT, INITIAL_FLUX) => 1.0,
            _ => 0.0,
        }
    }
}

impl ContinuousUnit for LevitatedBallPlant {
    #[inline]
    fn evaluate(&mut self) {
        let (driven, state) = (self.driven(), self.state());
        let [position_rate, acceleration, flux_rate] = rate_in_contact(&driven, &state, self.contact);
        let [at_lower_stop, at_magnet] = indicators(&driven, &state, self.contact);
        let [position, _, flux] = state;
        let values = &mut self.values;
        values[POSITION_DERIVATIVE] = position_rate;
        values[ACCELERATION_LOCAL] = acceleration;
        values[FLUX_DERIVATIVE] = flux_rate;
        values[LOWER_STOP_INDICATOR] = at_lower_stop;
        values[MAGNET_INDICATOR] = at_magnet;
        values[CURRENT_OUTPUT] = self.ball.current(position, flux);
        values[MAGNETIC_FORCE] = self.ball.magnetic_force(flux);
        if self.solver == Solver::Importer {
            values[VOLTAGE_MEASURED] = values[VOLTAGE_INPUT];
            if !self.sensor.is_read(self.solver) {
                values[CURRENT_MEASURED] = values[CURRENT_OUTPUT];
            }
        }
    }

    fn set_solver(&mut self, solver: Solver) -> bool {
        core::mem::replace(&mut self.solver, solver) != solver
    }

    fn update_discrete_states(&mut self) -> bool {
        let before = self.state();
        let mut state = before;
        let contact = transition(&self.driven(), &mut state, self.contact);
        self.set_state(state, contact);
        if self.sensor.reaches_reading(self.values[TIME]) {
            let [position, _, flux] = state;
            self.read_sensor(self.ball.current(position, flux));
        }
        state != before
    }

    fn next_event_time(&self) -> Option<f64> {
        self.sensor.next_reading(self.values[TIME])
    }

    fn partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        match unknown {
            POSITION_OUTPUT | VELOCITY_OUTPUT | FLUX_OUTPUT => f64::from(u8::from(unknown == known)),
            POSITION_DERIVATIVE => f64::from(u8::from(known == VELOCITY_OUTPUT && self.is_free())),
            ACCELERATION_LOCAL if self.is_free() => self.acceleration_slope(known),
            FLUX_DERIVATIVE => self.flux_derivative_slope(known),
            CURRENT_OUTPUT => self.current_slope(known),
            CURRENT_MEASURED if !self.sensor.is_read(self.solver) => self.current_slope(known),
            VOLTAGE_MEASURED => {
                f64::from(u8::from(known == VOLTAGE_INPUT && self.solver == Solver::Importer))
            }
            _ => 0.0,
        }
    }

    fn initial_partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        let resolution = self.values[SENSOR_RESOLUTION];
        if unknown == CURRENT_MEASURED && self.sensor.is_read(self.solver) {
            return match known {
                // The number of steps in the reading.
                SENSOR_RESOLUTION if resolution != 0.0 => self.values[CURRENT_MEASURED] / resolution,
                _ if resolution != 0.0 => 0.0,
                SENSOR_NOISE => Sensor::first_noise(self.values[SENSOR_SEED]),
                _ => self.initial_partial_derivative(CURRENT_OUTPUT, known),
            };
        }
        let through_states = [POSITION_OUTPUT, VELOCITY_OUTPUT, FLUX_OUTPUT]
            .map(|state| self.partial_derivative(unknown, state) * self.start_slope(state, known));
        self.partial_derivative(unknown, known) + through_states.iter().sum::<f64>()
    }

    fn input_slope(&self, input: usize) -> f64 {
        match input {
            VOLTAGE_INPUT => self.slope.voltage,
            FORCE_INPUT => self.slope.force,
            _ => 0.0,
        }
    }

    fn set_input_slope(&mut self, input: usize, slope: f64) {
        match input {
            VOLTAGE_INPUT => self.slope.voltage = slope,
            FORCE_INPUT => self.slope.force = slope,
            _ => {}
        }
    }
}
