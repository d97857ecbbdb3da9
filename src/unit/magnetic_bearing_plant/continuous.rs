//! The bearing for importers that integrate it: derivatives, the flux's sign as an event, partial derivatives.

use super::*;

/// Hysteresis of the flux's sign, in units of the nominal flux: an event indicator must not be zero after an event.
const HYSTERESIS: f64 = 1e-9;

impl MagneticBearingPlant {
    /// Takes note of the side of zero that the flux is on.
    pub(super) fn settle_flux_sign(&mut self) {
        let indicator = self.flux_sign_indicator();
        self.is_flux_positive = if self.is_flux_positive { indicator > 0.0 } else { indicator >= 0.0 };
        self.values[FLUX_SIGN] = self.flux_sign_indicator();
    }

    fn flux_sign_indicator(&self) -> f64 {
        let side = if self.is_flux_positive { HYSTERESIS } else { -HYSTERESIS };
        self.values[FLUX] / MAGNETIC_FLUX.nominal + side
    }

    /// Partial derivatives of epsilon = 2 bias_flux / saturation_flux with respect to both.
    fn epsilon_slope(&self, known: usize) -> f64 {
        let (bias, saturation) = (self.values[BIAS_FLUX], self.values[SATURATION_FLUX]);
        match known {
            BIAS_FLUX => 2.0 / saturation,
            SATURATION_FLUX => -2.0 * bias / (saturation * saturation),
            _ => 0.0,
        }
    }

    /// Partial derivatives of the first reading; the seed is no real number.
    fn first_reading_slope(&self, known: usize) -> f64 {
        let values = &self.values;
        let sample = Sensor::first_noise(values[SENSOR_SEED]);
        let resolution = values[SENSOR_RESOLUTION];
        match known {
            // The number of steps in the reading.
            SENSOR_RESOLUTION if resolution != 0.0 => values[POSITION_MEASURED] / resolution,
            INITIAL_POSITION if resolution == 0.0 => 1.0,
            SENSOR_NOISE if resolution == 0.0 => sample,
            _ => 0.0,
        }
    }
}

impl ContinuousUnit for MagneticBearingPlant {
    #[inline]
    fn evaluate(&mut self) {
        let (velocity, flux) = (self.values[VELOCITY_OUTPUT], self.values[FLUX]);
        self.values[POSITION_DERIVATIVE] = velocity;
        self.values[ACCELERATION_LOCAL] = self.bearing.acceleration(flux);
        self.values[FLUX_DERIVATIVE] = self.values[VOLTAGE_INPUT];
        self.values[FLUX_SIGN] = self.flux_sign_indicator();
        if self.solver == Solver::Importer {
            self.values[VOLTAGE_MEASURED] = self.values[VOLTAGE_INPUT];
            if !self.sensor.is_read(self.solver) {
                self.values[POSITION_MEASURED] = self.values[POSITION];
            }
        }
    }

    fn set_solver(&mut self, solver: Solver) -> bool {
        core::mem::replace(&mut self.solver, solver) != solver
    }

    fn update_discrete_states(&mut self) -> bool {
        self.settle_flux_sign();
        if self.sensor.reaches_reading(self.values[TIME]) {
            self.read_sensor(self.values[POSITION]);
        }
        false
    }

    fn next_event_time(&self) -> Option<f64> {
        self.sensor.next_reading(self.values[TIME])
    }

    fn partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        let flux = self.values[FLUX];
        match (unknown, known) {
            (POSITION, POSITION) | (VELOCITY_OUTPUT, VELOCITY_OUTPUT) | (FLUX, FLUX) => 1.0,
            (POSITION_DERIVATIVE, VELOCITY_OUTPUT) | (FLUX_DERIVATIVE, VOLTAGE_INPUT) => 1.0,
            (VOLTAGE_MEASURED, VOLTAGE_INPUT) if self.solver == Solver::Importer => 1.0,
            (POSITION_MEASURED, POSITION) if !self.sensor.is_read(self.solver) => 1.0,
            (ACCELERATION_LOCAL, FLUX) => self.bearing.acceleration_slope(flux),
            (ACCELERATION_LOCAL, BIAS_FLUX | SATURATION_FLUX) => flux * self.epsilon_slope(known),
            _ => 0.0,
        }
    }

    fn initial_partial_derivative(&self, unknown: usize, known: usize) -> f64 {
        match (unknown, known) {
            (EPSILON, _) => self.epsilon_slope(known),
            (POSITION_MEASURED, _) if self.sensor.is_read(self.solver) => self.first_reading_slope(known),
            // The states start from parameters.
            (_, INITIAL_POSITION) => self.partial_derivative(unknown, POSITION),
            (_, INITIAL_VELOCITY) => self.partial_derivative(unknown, VELOCITY_OUTPUT),
            (_, INITIAL_FLUX) => self.partial_derivative(unknown, FLUX),
            _ => self.partial_derivative(unknown, known),
        }
    }

    fn input_slope(&self, input: usize) -> f64 {
        if input == VOLTAGE_INPUT { self.voltage_slope } else { 0.0 }
    }

    fn set_input_slope(&mut self, input: usize, slope: f64) {
        if input == VOLTAGE_INPUT {
            self.voltage_slope = slope;
        }
    }
}
