//! Exported unit `LevitatedBallPlant`: ball and coil between two stops, and a current sensor.

mod continuous;
mod table;

pub use table::DESCRIPTION;
use table::*;

use super::input_ramp::end_of_ramp;
use super::sensor::{Sensor, check_sample_time};
use super::work::{Load, require_affordable};
use super::{ContinuousUnit, Description, Journal, Solver, Topic, Unit, UnitError, start_values};
use crate::plant::end_stops::{Contact, rate_in_contact, transition};
use crate::plant::levitated_ball::{Drive, DrivenBall, LevitatedBall, State};
use crate::signal::quantise;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// What a step of the integrator costs \[s\], see [`super::work`].
const COST_OF_SUBSTEP: f64 = 250e-9;

/// The plant as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct LevitatedBallPlant {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    ball: LevitatedBall,
    contact: Contact,
    /// Slopes of the inputs during steps \[V/s, N/s\].
    slope: Drive,
    solver: Solver,
    sensor: Sensor,
}

/// State and contact of the ball.
type Motion = (State, Contact);

impl LevitatedBallPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            ball: ball(&values),
            values,
            contact: Contact::None,
            slope: Drive::default(),
            solver: Solver::default(),
            sensor: Sensor::new(),
        }
    }

    fn state(&self) -> [f64; 3] {
        [POSITION_OUTPUT, VELOCITY_OUTPUT, FLUX_OUTPUT].map(|row| self.values[row])
    }

    fn set_state(&mut self, [position, velocity, flux]: [f64; 3], contact: Contact) {
        self.values[POSITION_OUTPUT] = position;
        self.values[VELOCITY_OUTPUT] = velocity;
        self.values[FLUX_OUTPUT] = flux;
        self.values[CONTACT] = f64::from(u8::from(contact != Contact::None));
        self.contact = contact;
    }

    /// Reads the sensor at a moment with this `current` \[A\].
    fn read_sensor(&mut self, current: f64) {
        let reading = self.sensor.read(current, self.values[SENSOR_NOISE]);
        self.values[CURRENT_MEASURED] = quantise(reading, self.values[SENSOR_RESOLUTION]);
    }

    /// What becomes of a motion in `duration` \[s\], the drive beginning with `drive`.
    #[inline]
    fn moved(
        &self,
        (mut state, mut contact): Motion,
        drive: Drive,
        duration: f64,
    ) -> Result<Motion, UnitError> {
        let lower_stop = self.values[LOWER_STOP];
        if self.slope == Drive::default() {
            self.ball.advance(lower_stop, &mut state, &mut contact, drive, duration);
        } else {
            let slope = self.slope;
            self.ball.advance_under_ramp(lower_stop, &mut state, &mut contact, drive, slope, duration);
        }
        check_finite(&self.ball, &state)?;
        Ok((state, contact))
    }
}

impl Default for LevitatedBallPlant {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for LevitatedBallPlant {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The sensor's parameters are read from the values at each step.
    fn adopt_parameters(&mut self) {}

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        let values = &mut self.values;
        let sensor = Sensor::start(values[SENSOR_SEED], values[SENSOR_SAMPLE_TIME], start_time)?;
        self.ball = ball(values);
        values[TIME] = start_time;
        values[VOLTAGE_MEASURED] = 0.0;
        let mut state = [values[INITIAL_POSITION], values[INITIAL_VELOCITY], values[INITIAL_FLUX]];
        let driven = DrivenBall::new(&self.ball, values[LOWER_STOP], Drive::default());
        let contact = transition(&driven, &mut state, Contact::None);
        self.sensor = sensor;
        self.set_state(state, contact);
        self.evaluate();
        if self.sensor.is_read(self.solver) {
            self.read_sensor(self.values[CURRENT_OUTPUT]);
        }
        Ok(())
    }

    fn check_parameters(&self) -> Result<(), UnitError> {
        check_sample_time(self.values[SENSOR_SAMPLE_TIME])
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        let (values, slope) = (&self.values, self.slope);
        let substep = self.ball.longest_substep(values[LOWER_STOP]);
        require_affordable(
            duration,
            [Load { cost: COST_OF_SUBSTEP, interval: substep }, self.sensor.load()],
        )?;
        let begin = Drive { voltage: values[VOLTAGE_INPUT], force: values[FORCE_INPUT] };
        let end = Drive {
            voltage: end_of_ramp(&VARIABLES[VOLTAGE_INPUT], begin.voltage, slope.voltage, duration)?,
            force: end_of_ramp(&VARIABLES[FORCE_INPUT], begin.force, slope.force, duration)?,
        };
        let [position, velocity, flux] = self.state();
        let motion = (State { position, velocity, flux }, self.contact);
        let ((state, contact), seen) = self.sensor.move_through(
            motion,
            duration,
            |motion, time, duration| self.moved(motion, begin.after(slope, time), duration),
            |(state, _)| self.ball.current(state.position, state.flux),
        )?;
        if contact != self.contact && journal.wants(Topic::Events) {
            note_contact(contact, journal);
        }
        self.set_state([state.position, state.velocity, state.flux], contact);
        self.values[VOLTAGE_INPUT] = end.voltage;
        self.values[FORCE_INPUT] = end.force;
        self.values[VOLTAGE_MEASURED] = begin.voltage + 0.5 * slope.voltage * duration;
        self.evaluate();
        self.sensor.skip_to_last(duration, self.values[SENSOR_NOISE]);
        if let Some(current) = seen {
            self.read_sensor(current);
        }
        Ok(())
    }

    fn continuous(&mut self) -> Option<&mut dyn ContinuousUnit> {
        Some(self)
    }

    fn is_consistent(&self) -> bool {
        // An importer may set states from which nothing can be computed.
        self.ball == ball(&self.values)
            && self.state().iter().all(|state| state.is_finite())
            && self.sensor.belongs_to(self.values[SENSOR_SAMPLE_TIME])
    }
}

fn ball(values: &[f64; COUNT]) -> LevitatedBall {
    LevitatedBall {
        mass: values[MASS],
        resistance: values[RESISTANCE],
        inductance_constant: values[INDUCTANCE_CONSTANT],
        gap: values[GAP],
        gravity: values[GRAVITY],
    }
}

#[cold]
fn note_contact(contact: Contact, journal: &mut dyn Journal) {
    let what = match contact {
        Contact::None => "is free",
        Contact::AtSmallestPosition => "rests on the lower stop",
        Contact::AtLargestPosition => "sticks to the magnet",
    };
    journal.note(Topic::Events, format_args!("the ball {what}"));
}

fn check_finite(ball: &LevitatedBall, state: &State) -> Result<(), UnitError> {
    let components = [
        (POSITION_OUTPUT, state.position),
        (VELOCITY_OUTPUT, state.velocity),
        (FLUX_OUTPUT, state.flux),
        (ACCELERATION_LOCAL, ball.magnetic_force(state.flux) / ball.mass),
    ];
    match components.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(row, value)) => {
            Err(UnitError::Diverged { name: VARIABLES[row].name, value, unit: VARIABLES[row].unit() })
        }
        None => Ok(()),
    }
}
