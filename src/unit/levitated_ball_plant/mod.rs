//! Exported unit `LevitatedBallPlant`: ball and coil between two stops, and a current sensor.

mod continuous;

use super::levitated_ball::{
    ACCELERATION, CURRENT, FLUX, FORCE, LABORATORY_FLUX, POSITION, VELOCITY, VOLTAGE, gap, gravity,
    inductance_constant, mass, resistance,
};
use super::variable::{Dependency, Kind, Variability, Variable, variable_table};
use super::{ContinuousUnit, Description, Journal, Topic, Unit, UnitError, start_values};
use crate::plant::end_stops::{Contact, rate_in_contact, transition};
use crate::plant::levitated_ball::{Drive, DrivenBall, LevitatedBall, State};
use crate::signal::{GaussianNoise, quantise};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step unless its derivative is set");
    FORCE_INPUT = Variable::input("force", &FORCE)
        .range(-1e6, 1e6)
        .describe("Disturbing force on the ball, positive upwards, held over a step unless its derivative is set");
    CURRENT_OUTPUT = Variable::output("current", &CURRENT)
        .initially_from(&["initial.position", "initial.flux", "inductance_constant", "gap", "lower_stop"])
        .depends_on(&[
            Dependency::dependent("position"),
            Dependency::dependent("flux"),
            Dependency::dependent("inductance_constant"),
            Dependency::dependent("gap"),
        ])
        .describe("i = (c - y) lam / k, coil current");
    POSITION_OUTPUT = Variable::output("position", &POSITION)
        .initially_from(&["initial.position", "gap", "lower_stop"])
        .depends_on(&[Dependency::constant("position")])
        .reinitialised()
        .describe("y, position of the ball, positive upwards, the magnet's face at gap");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .initially_from(&["initial.velocity", "initial.position", "gap", "lower_stop"])
        .depends_on(&[Dependency::constant("velocity")])
        .reinitialised()
        .describe("p / m, velocity of the ball, positive upwards");
    FLUX_OUTPUT = Variable::output("flux", &FLUX)
        .initially_from(&["initial.flux"])
        .depends_on(&[Dependency::constant("flux")])
        .describe("lam, flux linkage of the coil");
    VOLTAGE_MEASURED = Variable::held_output("voltage_measured", Kind::Real(&VOLTAGE))
        .describe("Mean voltage that acted over the last step, in model exchange the one before the last event; wire it to the controller's voltage_applied");
    CURRENT_MEASURED = Variable::held_output("current_measured", Kind::Real(&CURRENT))
        .initially_from(&[
            "initial.position", "initial.flux", "inductance_constant", "gap", "lower_stop", "sensor.noise",
            "sensor.resolution", "sensor.seed",
        ])
        .describe("Current with sensor noise and resolution, one reading per step, in model exchange per event");
    CONTACT = Variable::held_output("contact", Kind::Boolean)
        .initially_from(&[
            "initial.position", "initial.velocity", "initial.flux", "mass", "inductance_constant", "gravity", "gap",
            "lower_stop",
        ])
        .describe("Whether the ball rests on the magnet or on the lower stop");
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&VELOCITY), Variability::Continuous)
        .initially_from(&["initial.velocity", "initial.position", "gap", "lower_stop"])
        .derivative_of("position")
        .depends_on(&[Dependency::discrete("velocity")])
        .describe("y', 0 in contact");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .initially_from(&[
            "force", "initial.position", "initial.velocity", "initial.flux", "mass", "inductance_constant", "gravity", "gap", "lower_stop",
        ])
        .derivative_of("velocity")
        .depends_on(&[
            Dependency::dependent("flux"),
            Dependency::discrete("force"),
            Dependency::dependent("mass"),
            Dependency::dependent("inductance_constant"),
            Dependency::discrete("gravity"),
        ])
        .describe("p' / m under the present force; 0 in contact");
    FLUX_DERIVATIVE = Variable::local("der(flux)", Kind::Real(&VOLTAGE), Variability::Continuous)
        .initially_from(&[
            "voltage", "initial.position", "initial.flux", "resistance", "inductance_constant", "gap", "lower_stop",
        ])
        .derivative_of("flux")
        .depends_on(&[
            Dependency::constant("voltage"),
            Dependency::dependent("position"),
            Dependency::dependent("flux"),
            Dependency::dependent("resistance"),
            Dependency::dependent("inductance_constant"),
            Dependency::dependent("gap"),
        ])
        .describe("lam' = u - R i");
    LOWER_STOP_INDICATOR = Variable::event_indicator("event_indicator.lower_stop")
        .depends_on(&[
            Dependency::dependent("position"),
            Dependency::dependent("flux"),
            Dependency::dependent("force"),
            Dependency::dependent("mass"),
            Dependency::dependent("inductance_constant"),
            Dependency::dependent("gravity"),
            Dependency::dependent("gap"),
            Dependency::dependent("lower_stop"),
        ])
        .describe("Distance to the lower stop as a share of the free way; resting there, what presses the ball on, in g");
    MAGNET_INDICATOR = Variable::event_indicator("event_indicator.magnet")
        .depends_on(&[
            Dependency::dependent("position"),
            Dependency::dependent("flux"),
            Dependency::dependent("force"),
            Dependency::dependent("mass"),
            Dependency::dependent("inductance_constant"),
            Dependency::dependent("gravity"),
            Dependency::dependent("gap"),
            Dependency::dependent("lower_stop"),
        ])
        .describe("Distance to the magnet as a share of the free way; resting there, what presses the ball on, in g");
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
        "For model exchange the states are position, velocity and flux; impacts and releases are state events, at which \
         position and velocity may jump. voltage_measured, current_measured and contact are discrete: they change at \
         events only, when they take the voltage before the event and a new reading. In co-simulation voltage and force \
         may have a slope (input derivative of order 1, FMI 2.0).",
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
    contact: Contact,
    /// Slopes of the inputs during steps \[V/s, N/s\].
    slope: Drive,
    sensor_noise: GaussianNoise,
}

impl LevitatedBallPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            ball: ball(&values),
            values,
            contact: Contact::None,
            slope: Drive::default(),
            sensor_noise: GaussianNoise::new(0, SENSOR_STREAM),
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

    fn read_sensor(&mut self) {
        let current = self.values[CURRENT_OUTPUT];
        let reading = match self.values[SENSOR_NOISE] {
            0.0 => current,
            deviation => current + deviation * self.sensor_noise.sample(),
        };
        self.values[CURRENT_MEASURED] = quantise(reading, self.values[SENSOR_RESOLUTION]);
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
        let contact = transition(&driven, &mut state, Contact::None);
        self.sensor_noise = GaussianNoise::new(values[SENSOR_SEED] as u64, SENSOR_STREAM);
        self.set_state(state, contact);
        self.evaluate();
        self.read_sensor();
        Ok(())
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        let lower_stop = self.values[LOWER_STOP];
        let limit = LARGEST_NUMBER_OF_SUBSTEPS * self.ball.longest_substep(lower_stop);
        if duration > limit {
            return Err(UnitError::StepTooLong { duration, limit });
        }
        let drive = Drive { voltage: self.values[VOLTAGE_INPUT], force: self.values[FORCE_INPUT] };
        let [position, velocity, flux] = self.state();
        let (mut state, mut contact) = (State { position, velocity, flux }, self.contact);
        let slope = self.slope;
        if slope == Drive::default() {
            self.ball.advance(lower_stop, &mut state, &mut contact, drive, duration);
        } else {
            self.ball.advance_under_ramp(lower_stop, &mut state, &mut contact, drive, slope, duration);
        }
        check_finite(&self.ball, &state)?;
        if contact != self.contact && journal.wants(Topic::Events) {
            note_contact(contact, journal);
        }
        self.set_state([state.position, state.velocity, state.flux], contact);
        self.values[VOLTAGE_INPUT] = drive.voltage + slope.voltage * duration;
        self.values[FORCE_INPUT] = drive.force + slope.force * duration;
        self.values[VOLTAGE_MEASURED] = drive.voltage + 0.5 * slope.voltage * duration;
        self.evaluate();
        self.read_sensor();
        Ok(())
    }

    fn continuous(&mut self) -> Option<&mut dyn ContinuousUnit> {
        Some(self)
    }

    fn is_consistent(&self) -> bool {
        let [position, velocity, flux] = self.state();
        self.ball == ball(&self.values)
            && check_finite(&self.ball, &State { position, velocity, flux }).is_ok()
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
