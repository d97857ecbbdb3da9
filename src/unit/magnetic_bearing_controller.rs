//! Exported unit `MagneticBearingController`: Newton observer and control laws as a sampled-data system.

use super::magnetic_bearing::{MAP, PRINTED, bias_flux, map, saturation_flux};
use super::quantity::{
    DURATION, Enumeration, LENGTH, MAGNETIC_FLUX, POSITION_GAIN, RATIO, TIME as TIME_QUANTITY, VELOCITY,
    VELOCITY_GAIN, VOLTAGE,
};
use super::sample_clock::SampleClock;
use super::variable::{Kind, Variability, Variable, variable_table};
use super::{Description, Journal, Topic, Unit, UnitError, start_values};
use crate::controller::bearing_feedback::{self, Gains, Law};
use crate::controller::saturate;
use crate::observer::newton::{NewtonObserver, NewtonSettings};
use crate::plant::magnetic_bearing::{MagneticBearing, State};

static OBSERVER_KIND: Enumeration = Enumeration {
    name: "BearingObserver",
    description: "State estimator",
    items: &[("newton", "Full-order Newton observer, section 3")],
};
static VOLTAGE_SOURCE: Enumeration = Enumeration {
    name: "VoltageSource",
    description: "Which voltage the observer believes acted over the last sample",
    items: &[
        ("command", "The voltage this unit put out"),
        ("applied", "The input voltage_applied, right in every exchange order"),
    ],
};
/// Number of the item `applied`.
const APPLIED: f64 = 2.0;
static LAW: Enumeration = Enumeration {
    name: "BearingLaw",
    description: "Control law",
    items: &[("a", "Equation (8a)"), ("b", "Equation (8b)"), ("c", "Equation (8c)")],
};
static FEEDBACK: Enumeration = Enumeration {
    name: "Feedback",
    description: "What the law is fed with besides the measured position",
    items: &[("estimate", "The observer's estimate"), ("state", "The inputs state.*, for comparison")],
};
/// Number of the item `state`.
const STATE: f64 = 2.0;

variable_table! {
    TIME = Variable::time();
    POSITION = Variable::input("position", &LENGTH)
        .describe("y = x1, measured rotor displacement");
    VOLTAGE_APPLIED = Variable::input("voltage_applied", &VOLTAGE)
        .describe("Voltage that acted on the plant over the last sample, used with observer.voltage_source = applied");
    STATE_VELOCITY = Variable::input("state.velocity", &VELOCITY)
        .describe("True x2, used with controller.feedback = state");
    STATE_FLUX = Variable::input("state.flux", &MAGNETIC_FLUX)
        .describe("True x3, used with controller.feedback = state");
    VOLTAGE_OUTPUT = Variable::held_output("voltage", Kind::Real(&VOLTAGE))
        .describe("u, coil voltage, held between ticks, 0 before the first");
    ESTIMATE_POSITION = Variable::held_output("estimate.position", Kind::Real(&LENGTH))
        .initially_from(&["observer.initial.position"])
        .describe("Estimate of x1 at the last tick");
    ESTIMATE_VELOCITY = Variable::held_output("estimate.velocity", Kind::Real(&VELOCITY))
        .initially_from(&["observer.initial.velocity"])
        .describe("Estimate of x2 at the last tick");
    ESTIMATE_FLUX = Variable::held_output("estimate.flux", Kind::Real(&MAGNETIC_FLUX))
        .initially_from(&["observer.initial.flux"])
        .describe("Estimate of x3 at the last tick");
    OBSERVER_RESIDUAL = Variable::held_output("observer.residual", Kind::Real(&LENGTH))
        .describe("Largest difference between measured and modelled positions in the observer's window");
    OBSERVER_ITERATIONS = Variable::held_output("observer.iterations", Kind::Integer)
        .describe("Newton iterations of the last tick, at most observer.max_iterations");
    OBSERVER_CONVERGED = Variable::held_output("observer.converged", Kind::Boolean)
        .describe("Whether the last iteration moved the flux by less than a millionth of its size");
    TICK_TIME = Variable::local("tick_time", Kind::Real(&TIME_QUANTITY), Variability::Discrete)
        .describe("Time of the last tick, a multiple of sample_time; the start time before the first");
    SAMPLE_TIME = Variable::parameter("sample_time", Kind::Real(&DURATION), 1e-3)
        .range(1e-6, 1.0)
        .describe("T, the unit ticks at all multiples of it, whatever the communication step size");
    OBSERVER = Variable::parameter("observer.kind", Kind::Enumeration(&OBSERVER_KIND), 1.0)
        .describe("State estimator");
    OBSERVER_MAP = Variable::parameter("observer.map", Kind::Enumeration(&MAP), PRINTED)
        .describe("Model that the observer inverts");
    MAX_ITERATIONS = Variable::tunable("observer.max_iterations", Kind::Integer, 10.0)
        .range(1.0, 1000.0)
        .describe("d, largest number of Newton iterations per tick; the paper prints 10 in Remark 1 and 100 in Table 1");
    STEP_SIZE = Variable::tunable("observer.step_size", Kind::Real(&RATIO), 1.0)
        .range(1e-3, 1.0)
        .describe("alpha of Remark 2, share of the Newton step that is taken");
    OBSERVER_INITIAL_POSITION = Variable::parameter("observer.initial.position", Kind::Real(&LENGTH), 0.0)
        .range(-1.0, 1.0)
        .describe("First component of w0, the observer's first guess");
    OBSERVER_INITIAL_VELOCITY = Variable::parameter("observer.initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("Second component of w0, also the estimate until two past samples exist");
    OBSERVER_INITIAL_FLUX = Variable::parameter("observer.initial.flux", Kind::Real(&MAGNETIC_FLUX), 1e-9)
        .range(-1e3, 1e3)
        .describe("Third component of w0, also the estimate until two past samples exist");
    OBSERVER_VOLTAGE_SOURCE =
        Variable::parameter("observer.voltage_source", Kind::Enumeration(&VOLTAGE_SOURCE), 1.0)
        .describe("Which voltage the observer believes acted over the last sample");
    CONTROLLER_LAW = Variable::tunable("controller.law", Kind::Enumeration(&LAW), 1.0)
        .describe("Control law");
    CONTROLLER_FEEDBACK = Variable::tunable("controller.feedback", Kind::Enumeration(&FEEDBACK), 1.0)
        .describe("What the law is fed with besides the measured position");
    K1 = Variable::tunable("controller.k1", Kind::Real(&POSITION_GAIN), 0.92)
        .range(-1e6, 1e6)
        .describe("k1 of u0 = -k1 x1 - k2 x2");
    K2 = Variable::tunable("controller.k2", Kind::Real(&VELOCITY_GAIN), 9.94)
        .range(-1e6, 1e6)
        .describe("k2 of u0 = -k1 x1 - k2 x2");
    INITIAL_VOLTAGE = Variable::parameter("controller.initial_voltage", Kind::Real(&VOLTAGE), -150.0)
        .range(-1e6, 1e6)
        .describe("u(0), output of the first tick");
    VOLTAGE_LIMIT = Variable::tunable("controller.voltage_limit", Kind::Real(&VOLTAGE), 150.0)
        .range(0.0, 1e6)
        .describe("u_sat, largest magnitude of the output");
    BIAS_FLUX = bias_flux();
    SATURATION_FLUX = saturation_flux();
}

pub static DESCRIPTION: Description = Description {
    name: "MagneticBearingController",
    summary: "Newton observer and nonlinear control laws for a flux-controlled active magnetic bearing",
    documentation: &[
        "Estimates velocity and flux of the bearing from its position and feeds one of three control laws: \
         A. Mystkowski, Ü. Kotta, V. Kaparin, Newton observer for a nonlinear flux-controlled AMB system, \
         Proc. Estonian Acad. Sci. 67(1), 61-72, 2018, sections 3 and 4.",
        "A tick at each multiple of sample_time reads the inputs, runs the observer, then the law, and holds the \
         outputs until the next tick. A step over [t, t + h) runs the ticks in it with the inputs set before. With \
         h = sample_time and a master that steps the controller first and the plant second the loop is the paper's. \
         A master that steps both at once delays the voltage by one step: choose observer.voltage_source = applied \
         and wire voltage_applied to the plant's voltage_measured.",
        "Printed: the observer, its parameters d and alpha, the laws and their gains, u(0) and the limit. The three \
         by three system of each Newton iteration is solved by elimination, which changes nothing but the speed. \
         Choosing observer.map = exact is beyond the paper: the printed map is wrong where the flux crosses zero.",
        "An iteration that yields nothing finite is dropped: the last finite estimate stays and observer.converged \
         is false.",
    ],
    variables: &VARIABLES,
    step_size: 1e-3,
    stop_time: 10.0,
};

/// Ticks in one step, minutes of computing; more can only be a mistake, as an end time that stands for "never".
const LARGEST_NUMBER_OF_TICKS: i64 = 1_000_000_000;

/// The controller as a unit.
#[derive(Clone)]
pub struct MagneticBearingController {
    values: [f64; COUNT],
    clock: SampleClock,
    settings: NewtonSettings,
    law: Law,
    gains: Gains,
    feeds_back_state: bool,
    hears_applied_voltage: bool,
    observer: NewtonObserver,
    /// Whether the first tick, which puts out u(0), is still to come.
    awaits_first_tick: bool,
}

impl MagneticBearingController {
    /// The controller with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            clock: SampleClock::new(values[SAMPLE_TIME], 0.0),
            settings: settings(&values),
            law: law(values[CONTROLLER_LAW]),
            gains: gains(&values),
            feeds_back_state: values[CONTROLLER_FEEDBACK] == STATE,
            hears_applied_voltage: values[OBSERVER_VOLTAGE_SOURCE] == APPLIED,
            observer: NewtonObserver::new(initial_estimate(&values)),
            awaits_first_tick: true,
            values,
        }
    }

    /// Reads the inputs, runs the observer, then the law, and sets the outputs.
    #[inline]
    fn tick(&mut self, journal: &mut dyn Journal) {
        let values = &mut self.values;
        let acted = if self.hears_applied_voltage { values[VOLTAGE_APPLIED] } else { values[VOLTAGE_OUTPUT] };
        let estimate = self.observer.update(&self.settings, values[POSITION], acted);

        let fed_back = if self.feeds_back_state {
            State { position: values[POSITION], velocity: values[STATE_VELOCITY], flux: values[STATE_FLUX] }
        } else {
            // The laws use the measured position, not its estimate.
            State { position: values[POSITION], ..estimate.state }
        };
        let wanted = if self.awaits_first_tick {
            values[INITIAL_VOLTAGE]
        } else {
            bearing_feedback::voltage(self.law, self.gains, fed_back)
        };
        self.awaits_first_tick = false;
        values[VOLTAGE_OUTPUT] = saturate(wanted, values[VOLTAGE_LIMIT], values[VOLTAGE_OUTPUT]);
        values[ESTIMATE_POSITION] = estimate.state.position;
        values[ESTIMATE_VELOCITY] = estimate.state.velocity;
        values[ESTIMATE_FLUX] = estimate.state.flux;
        values[OBSERVER_RESIDUAL] = estimate.residual;
        values[OBSERVER_ITERATIONS] = f64::from(estimate.iterations);
        let converged = f64::from(u8::from(estimate.converged));
        if converged != values[OBSERVER_CONVERGED] && journal.wants(Topic::Observer) {
            let verb = if estimate.converged { "converged" } else { "did not converge" };
            journal.note(
                Topic::Observer,
                format_args!(
                    "t = {} s: the observer {verb} after {} iterations, residual {:e} m",
                    values[TICK_TIME], estimate.iterations, estimate.residual
                ),
            );
        }
        values[OBSERVER_CONVERGED] = converged;
    }
}

impl Default for MagneticBearingController {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for MagneticBearingController {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn adopt_parameters(&mut self) {
        self.settings = settings(&self.values);
        self.law = law(self.values[CONTROLLER_LAW]);
        self.gains = gains(&self.values);
        self.feeds_back_state = self.values[CONTROLLER_FEEDBACK] == STATE;
        self.hears_applied_voltage = self.values[OBSERVER_VOLTAGE_SOURCE] == APPLIED;
    }

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        self.adopt_parameters();
        let values = &mut self.values;
        let initial = initial_estimate(values);
        self.clock = SampleClock::new(values[SAMPLE_TIME], start_time);
        self.observer = NewtonObserver::new(initial);
        self.awaits_first_tick = true;
        values[TIME] = start_time;
        values[TICK_TIME] = start_time;
        values[ESTIMATE_POSITION] = initial.position;
        values[ESTIMATE_VELOCITY] = initial.velocity;
        values[ESTIMATE_FLUX] = initial.flux;
        for output in [VOLTAGE_OUTPUT, OBSERVER_RESIDUAL, OBSERVER_ITERATIONS, OBSERVER_CONVERGED] {
            values[output] = 0.0;
        }
        Ok(())
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        for k in self.clock.advance_at_most(duration, LARGEST_NUMBER_OF_TICKS)? {
            self.values[TICK_TIME] = self.clock.time_of(k);
            self.tick(journal);
        }
        Ok(())
    }

    fn boxed_clone(&self) -> Box<dyn Unit> {
        Box::new(self.clone())
    }
}

fn settings(values: &[f64; COUNT]) -> NewtonSettings {
    NewtonSettings {
        bearing: MagneticBearing::with_bias(values[BIAS_FLUX], values[SATURATION_FLUX]),
        map: map(values[OBSERVER_MAP]),
        sample_time: values[SAMPLE_TIME],
        max_iterations: values[MAX_ITERATIONS] as u32,
        step_size: values[STEP_SIZE],
    }
}

fn gains(values: &[f64; COUNT]) -> Gains {
    Gains { position: values[K1], velocity: values[K2] }
}

fn initial_estimate(values: &[f64; COUNT]) -> State {
    State {
        position: values[OBSERVER_INITIAL_POSITION],
        velocity: values[OBSERVER_INITIAL_VELOCITY],
        flux: values[OBSERVER_INITIAL_FLUX],
    }
}

fn law(value: f64) -> Law {
    match value {
        2.0 => Law::B,
        3.0 => Law::C,
        _ => Law::A,
    }
}
