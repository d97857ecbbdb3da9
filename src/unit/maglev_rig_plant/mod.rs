//! Exported unit `MaglevRigPlant`: ball, coil with its driver, position sensor and end stops.

mod continuous;
mod table;

pub use table::DESCRIPTION;
use table::*;

use super::input_ramp::end_of_ramp;
use super::sensor::{Sensor, check_sample_time};
use super::work::{Load, require_affordable};
use super::{ContinuousUnit, Description, Journal, Solver, Topic, Unit, UnitError, start_values};
use crate::controller::saturate_between;
use crate::plant::end_stops::{Contact, rate_in_contact, transition};
use crate::plant::maglev_rig::{HeldBall, LONGEST_SUBSTEP, MaglevRig, PositionSensor, State};
use crate::plant::maglev_rig_ramp::RampedBall;
use crate::signal::quantise;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// Integrating, see [`super::work`].
const LOAD: Load = Load { cost: 200e-9, interval: LONGEST_SUBSTEP };

/// The plant as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct MaglevRigPlant {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    contact: Contact,
    /// Slopes of the inputs during steps \[V/s\] and \[N/s\].
    voltage_slope: f64,
    force_slope: f64,
    solver: Solver,
    sensor: Sensor,
}

/// State and contact of the ball.
type Motion = (State, Contact);

impl MaglevRigPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        Self {
            values: start_values(&VARIABLES),
            contact: Contact::None,
            voltage_slope: 0.0,
            force_slope: 0.0,
            solver: Solver::default(),
            sensor: Sensor::new(),
        }
    }

    fn rig(&self) -> MaglevRig {
        MaglevRig {
            mass: self.values[MASS],
            gravity: self.values[GRAVITY],
            electromagnetic_constant: self.values[FORCE_CONSTANT],
            driver_gain: self.values[DRIVER_GAIN_PARAMETER],
        }
    }

    /// The ball under a voltage \[V\] and a force \[N\].
    fn ball(&self, voltage: f64, force: f64) -> HeldBall {
        HeldBall {
            rig: self.rig(),
            voltage,
            force,
            upper_stop: self.values[UPPER_STOP],
            lower_stop: self.values[LOWER_STOP],
        }
    }

    /// The input voltage within the driver's limits \[V\].
    fn driver_voltage(&self) -> f64 {
        self.limited(self.values[VOLTAGE_INPUT])
    }

    /// `voltage` \[V\] within the driver's limits.
    fn limited(&self, voltage: f64) -> f64 {
        saturate_between(voltage, self.voltage_limits(), 0.0)
    }

    fn voltage_limits(&self) -> (f64, f64) {
        (self.values[VOLTAGE_MIN], self.values[VOLTAGE_MAX])
    }

    /// The ball under inputs that begin with a voltage asked for \[V\] and a force \[N\] and move.
    fn ramped(&self, voltage: f64, force: f64) -> RampedBall {
        RampedBall {
            begin: self.ball(voltage, force),
            voltage_slope: self.voltage_slope,
            force_slope: self.force_slope,
            voltage_limits: self.voltage_limits(),
        }
    }

    fn state(&self) -> [f64; 2] {
        [POSITION, VELOCITY].map(|row| self.values[row])
    }

    fn set_state(&mut self, [position, velocity]: [f64; 2], contact: Contact) {
        self.values[POSITION] = position;
        self.values[VELOCITY] = velocity;
        self.values[CONTACT] = f64::from(u8::from(contact != Contact::None));
        self.contact = contact;
    }

    /// Tells which `voltage` \[V\] acted.
    fn echo(&mut self, voltage: f64) {
        self.values[VOLTAGE_MEASURED] = voltage;
        self.values[CURRENT] = self.values[DRIVER_GAIN_PARAMETER] * voltage;
    }

    fn sensor_voltage(&self, position: f64) -> f64 {
        let sensor = PositionSensor { gain: self.values[SENSOR_GAIN], offset: self.values[SENSOR_OFFSET] };
        sensor.voltage(position)
    }

    /// What the sensor makes of a `reading` \[V\]; of none, the limit next to the true `voltage` \[V\].
    fn within_range(&self, reading: f64, voltage: f64) -> f64 {
        let range = (self.values[SENSOR_MINIMUM], self.values[SENSOR_MAXIMUM]);
        saturate_between(reading, range, voltage)
    }

    /// Reads the sensor at a moment with this true `voltage` \[V\] of it.
    fn read_sensor(&mut self, voltage: f64) {
        let reading = self.sensor.read(voltage, self.values[SENSOR_NOISE]);
        let reading = quantise(reading, self.values[SENSOR_RESOLUTION]);
        self.values[SENSOR_VOLTAGE_MEASURED] = self.within_range(reading, voltage);
    }

    /// What becomes of a motion in `duration` \[s\], the inputs beginning with a voltage asked for \[V\] and a force \[N\].
    #[inline]
    fn moved(
        &self,
        (state, contact): Motion,
        (voltage, force): (f64, f64),
        duration: f64,
    ) -> Result<Motion, UnitError> {
        let motion = if self.voltage_slope == 0.0 && self.force_slope == 0.0 {
            self.ball(self.limited(voltage), force).advance(state, contact, duration)
        } else {
            self.ramped(voltage, force).advance(state, contact, duration)
        };
        check_finite(&motion.0)?;
        Ok(motion)
    }
}

impl Default for MaglevRigPlant {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for MaglevRigPlant {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// All parameters are read from the values at each step.
    fn adopt_parameters(&mut self) {}

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        let values = &mut self.values;
        let sensor = Sensor::start(values[SENSOR_SEED], values[SENSOR_SAMPLE_TIME], start_time)?;
        values[TIME] = start_time;
        let start = State { position: values[INITIAL_POSITION], velocity: values[INITIAL_VELOCITY] };
        self.sensor = sensor;
        // Before the first step no voltage has acted.
        let (state, contact) = self.ball(0.0, 0.0).settle(start);
        self.echo(0.0);
        self.set_state([state.position, state.velocity], contact);
        self.evaluate();
        if self.sensor.is_read(self.solver) {
            self.read_sensor(self.values[SENSOR_VOLTAGE]);
        }
        Ok(())
    }

    fn check_parameters(&self) -> Result<(), UnitError> {
        check_sample_time(self.values[SENSOR_SAMPLE_TIME])
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        require_affordable(duration, [LOAD, self.sensor.load()])?;
        let (voltage, force) = (self.values[VOLTAGE_INPUT], self.values[FORCE]);
        let (voltage_slope, force_slope) = (self.voltage_slope, self.force_slope);
        let voltage_end = end_of_ramp(&VARIABLES[VOLTAGE_INPUT], voltage, voltage_slope, duration)?;
        let force_end = end_of_ramp(&VARIABLES[FORCE], force, force_slope, duration)?;
        let [position, velocity] = self.state();
        let motion = (State { position, velocity }, self.contact);
        let ((state, contact), seen) = self.sensor.move_through(
            motion,
            duration,
            |motion, begin, duration| {
                let inputs = (voltage + voltage_slope * begin, force + force_slope * begin);
                self.moved(motion, inputs, duration)
            },
            |(state, _)| self.sensor_voltage(state.position),
        )?;
        if contact != self.contact && journal.wants(Topic::Events) {
            note_contact(self.values[TIME] + duration, contact, journal);
        }
        self.echo(if voltage_slope == 0.0 && force_slope == 0.0 {
            self.driver_voltage()
        } else {
            self.ramped(voltage, force).mean_voltage(duration)
        });
        self.values[VOLTAGE_INPUT] = voltage_end;
        self.values[FORCE] = force_end;
        self.set_state([state.position, state.velocity], contact);
        self.evaluate();
        self.sensor.skip_to_last(duration, self.values[SENSOR_NOISE]);
        if let Some(voltage) = seen {
            self.read_sensor(voltage);
        }
        Ok(())
    }

    fn continuous(&mut self) -> Option<&mut dyn ContinuousUnit> {
        Some(self)
    }

    fn is_consistent(&self) -> bool {
        let [position, velocity] = self.state();
        check_finite(&State { position, velocity }).is_ok()
            && self.sensor.belongs_to(self.values[SENSOR_SAMPLE_TIME])
    }
}

#[cold]
fn note_contact(time: f64, contact: Contact, journal: &mut dyn Journal) {
    let what = match contact {
        Contact::None => "has left its stop",
        Contact::AtSmallestPosition => "rests at the coil, on upper_stop",
        Contact::AtLargestPosition => "lies on lower_stop",
    };
    journal.note(Topic::Events, format_args!("by t = {time} s the ball {what}"));
}

fn check_finite(state: &State) -> Result<(), UnitError> {
    let components = [(POSITION, state.position), (VELOCITY, state.velocity)];
    match components.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(row, value)) => {
            Err(UnitError::Diverged { name: VARIABLES[row].name, value, unit: VARIABLES[row].unit() })
        }
        None => Ok(()),
    }
}
