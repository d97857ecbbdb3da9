//! Exported unit `LevitatedBallPlant`: ball and coil between two stops, and a current sensor.

use super::levitated_ball::{
    ACCELERATION, CURRENT, FLUX, FORCE, LABORATORY_FLUX, POSITION, VELOCITY, VOLTAGE, gap, gravity,
    inductance_constant, mass, resistance,
};
use super::variable::{Kind, Variability, Variable, variable_table};
use super::{Description, Journal, Topic, Unit, UnitError, start_values};
use crate::plant::end_stops::{Contact, transition};
use crate::plant::levitated_ball::{Drive, DrivenBall, LevitatedBall, State};
use crate::signal::{GaussianNoise, quantise};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step");
    FORCE_INPUT = Variable::input("force", &FORCE)
        .describe("Disturbing force on the ball, positive upwards, held over a step");
    CURRENT_OUTPUT = Variable::output("current", &CURRENT)
        .initially_from(&["initial.position", "initial.flux", "inductance_constant", "gap", "lower_stop"])
        .describe("i = (c - y) lam / k, coil current");
    POSITION_OUTPUT = Variable::output("position", &POSITION)
        .initially_from(&["initial.position", "gap", "lower_stop"])
        .describe("y, position of the ball, positive upwards, the magnet's face at gap");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .initially_from(&["initial.velocity", "initial.position", "gap", "lower_stop"])
        .describe("p / m, velocity of the ball, positive upwards");
    FLUX_OUTPUT = Variable::output("flux", &FLUX)
        .initially_from(&["initial.flux"])
        .describe("lam, flux linkage of the coil");
    VOLTAGE_MEASURED = Variable::held_output("voltage_measured", Kind::Real(&VOLTAGE))
        .describe("Voltage that acted over the last step; wire it to the controller's voltage_applied");
    CURRENT_MEASURED = Variable::held_output("current_measured", Kind::Real(&CURRENT))
        .initially_from(&[
            "initial.position", "initial.flux", "inductance_constant", "gap", "lower_stop", "sensor.noise",
            "sensor.resolution", "sensor.seed",
        ])
        .describe("Current with sensor noise and resolution, one reading per step");
    CONTACT = Variable::held_output("contact", Kind::Boolean)
        .initially_from(&["initial.position", "gap", "lower_stop"])
        .describe("Whether the ball rests on the magnet or on the lower stop");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .describe("p' / m under the force of the last step; 0 in contact");
    MAGNETIC_FORCE = Variable::local("magnetic_force", Kind::Real(&FORCE), Variability::Continuous)
        .initially_from(&["initial.flux", "inductance_constant"])
        .describe("lam^2 / (2 k), force of the magnet on the ball");
    MASS = mass();
    RESISTANCE = resistance();
    INDUCTANCE_CONSTANT = inductance_constant();
    GAP = gap();
    GRAVITY = gravity();
    LOWER_STOP = Variable::parameter("lower_stop", Kind::Real(&POSITION), -0.02)
        .range(-10.0, 0.0)
        .describe("Position below which the ball cannot fall; assumed");
    INITIAL_POSITION = Variable::parameter("initial.position", Kind::Real(&POSITION), 0.0)
        .range(-10.0, 1.0)
        .describe("y at the start; beyond a stop it becomes the stop's");
    INITIAL_VELOCITY = Variable::parameter("initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("p / m at the start");
    INITIAL_FLUX = Variable::parameter("initial.flux", Kind::Real(&FLUX), LABORATORY_FLUX)
        .range(-10.0, 10.0)
        .describe("lam at the start; the start value sqrt(2 k m g) carries the ball of the other start values");
    SENSOR_NOISE = Variable::tunable("sensor.noise", Kind::Real(&CURRENT), 0.0)
        .range(0.0, 1e3)
        .describe("Standard deviation of the current sensor's white noise, per reading");
    SENSOR_RESOLUTION = Variable::tunable("sensor.resolution", Kind::Real(&CURRENT), 0.0)
        .range(0.0, 1e3)
        .describe("Step of the current sensor's output, 0 for none");
    SENSOR_SEED = Variable::parameter("sensor.seed", Kind::Integer, 1.0)
        .range(0.0, i32::MAX as f64)
        .describe("Seed of the sensor's noise; the same seed gives the same run on every platform");
}

pub static DESCRIPTION: Description = Description {
    name: "LevitatedBallPlant",
    summary: "Steel ball levitated by an electromagnet, one degree of freedom, voltage driven",
    documentation: &[
        "Steel ball below an electromagnet, equation (1) of Sensorless Control of the Levitated Ball, arXiv 1811.07732: \
         lam' = u - R i, y' = p / m, p' = lam^2 / (2 k) - m g + force, i = (c - y) lam / k. The available text of the \
         paper has lost its formulas and numbers: the equations are those of the book it refers to (Ortega, Loria, \
         Nicklasson, Sira-Ramirez 2013, chapter 8), all parameters are assumed.",
        "Voltage and force are held over a communication step, which is solved by a Runge-Kutta method of order 5 in \
         steps of at most 0.1 ms, less where the coil is faster; the result hardly depends on the communication step. \
         The ball moves between the magnet's face at gap and lower_stop. An impact is inelastic; times of impact and \
         release are found to the last digit.",
        "Not in the paper: the disturbing force, the stops and the sensor model.",
    ],
    variables: &VARIABLES,
    step_size: 1e-4,
    stop_time: 5.0,
};

const SENSOR_STREAM: u64 = 1;

/// Integration steps in one communication step, some ten seconds of computing.
const LARGEST_NUMBER_OF_SUBSTEPS: f64 = 1e8;

/// The plant as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct LevitatedBallPlant {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    ball: LevitatedBall,
    state: State,
    contact: Contact,
    sensor_noise: GaussianNoise,
}

impl LevitatedBallPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            ball: ball(&values),
            values,
            state: State::default(),
            contact: Contact::None,
            sensor_noise: GaussianNoise::new(0, SENSOR_STREAM),
        }
    }

    /// Writes the state and what follows from it to the outputs; takes one sensor reading.
    fn publish(&mut self) {
        let Self { values, ball, state, contact, sensor_noise } = self;
        let current = ball.current(state.position, state.flux);
        let reading = match values[SENSOR_NOISE] {
            0.0 => current,
            deviation => current + deviation * sensor_noise.sample(),
        };
        let force = ball.magnetic_force(state.flux);
        let touches = *contact != Contact::None;
        values[POSITION_OUTPUT] = state.position;
        values[VELOCITY_OUTPUT] = state.velocity;
        values[FLUX_OUTPUT] = state.flux;
        values[CURRENT_OUTPUT] = current;
        values[CURRENT_MEASURED] = quantise(reading, values[SENSOR_RESOLUTION]);
        values[CONTACT] = f64::from(u8::from(touches));
        values[MAGNETIC_FORCE] = force;
        values[ACCELERATION_LOCAL] =
            if touches { 0.0 } else { (force + values[FORCE_INPUT]) / ball.mass - ball.gravity };
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
        self.ball = ball(values);
        values[TIME] = start_time;
        values[VOLTAGE_MEASURED] = 0.0;
        let mut state = [values[INITIAL_POSITION], values[INITIAL_VELOCITY], values[INITIAL_FLUX]];
        let driven = DrivenBall::new(&self.ball, values[LOWER_STOP], Drive::default());
        self.contact = transition(&driven, &mut state, Contact::None);
        let [position, velocity, flux] = state;
        self.state = State { position, velocity, flux };
        self.sensor_noise = GaussianNoise::new(values[SENSOR_SEED] as u64, SENSOR_STREAM);
        self.publish();
        Ok(())
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        let lower_stop = self.values[LOWER_STOP];
        let limit = LARGEST_NUMBER_OF_SUBSTEPS * self.ball.longest_substep(lower_stop);
        if duration > limit {
            return Err(UnitError::StepTooLong { duration, limit });
        }
        let drive = Drive { voltage: self.values[VOLTAGE_INPUT], force: self.values[FORCE_INPUT] };
        let (mut state, mut contact) = (self.state, self.contact);
        self.ball.advance(lower_stop, &mut state, &mut contact, drive, duration);
        check_finite(&self.ball, &state)?;
        if contact != self.contact && journal.wants(Topic::Events) {
            note_contact(contact, journal);
        }
        self.state = state;
        self.contact = contact;
        self.values[VOLTAGE_MEASURED] = drive.voltage;
        self.publish();
        Ok(())
    }

    fn is_consistent(&self) -> bool {
        let stops = self.values[LOWER_STOP]..=self.values[GAP];
        self.ball == ball(&self.values)
            && check_finite(&self.ball, &self.state).is_ok()
            && stops.contains(&self.state.position)
    }

    fn boxed_clone(&self) -> Box<dyn Unit> {
        Box::new(self.clone())
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
        (MAGNETIC_FORCE, ball.magnetic_force(state.flux)),
    ];
    match components.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(row, value)) => {
            Err(UnitError::Diverged { name: VARIABLES[row].name, value, unit: VARIABLES[row].unit() })
        }
        None => Ok(()),
    }
}
