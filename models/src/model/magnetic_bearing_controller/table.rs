//! Variables and description of the controller of the magnetic bearing.

use crate::model::Description;
use crate::model::choice::choice;
use crate::model::controller_choices::{Feedback, VoltageSource};
use crate::model::longest_step::longest_step;
use crate::model::magnetic_bearing::{MAP, MapChoice, bias_flux, saturation_flux};
use crate::model::quantity::{
    DURATION, Enumeration, LENGTH, MAGNETIC_FLUX, POSITION_GAIN, RATE, RATIO, SQUARED_RATE,
    TIME as TIME_QUANTITY, VELOCITY, VELOCITY_GAIN, VOLTAGE,
};
use crate::model::start_delay::start_delay;
use crate::model::variable::{Kind, Variability, Variable, variable_table};
use crate::observer::windowed_newton::MAX_WINDOW;

choice! {
    pub(super) enum ObserverKind = "BearingObserver", "State estimator" {
        Newton = "newton", "Full-order Newton observer, section 3";
        ReducedNewton = "reduced_newton", "Reduced-order Newton observer, section 3.1, as printed";
        ReducedNewtonCompensated = "reduced_newton_compensated",
            "Reduced-order Newton observer with the lag of its filter compensated";
        Kalman = "kalman", "Extended Kalman filter on the exact map";
    }
}

choice! {
    pub(super) enum LawKind = "BearingLaw", "Control law" {
        A = "a", "Equation (8a)";
        B = "b", "Equation (8b)";
        C = "c", "Equation (8c)";
        FluxCascade = "flux_cascade", "Position loop with a flux loop inside";
    }
}

static OBSERVER_KIND: Enumeration = ObserverKind::ENUMERATION;
static LAW: Enumeration = LawKind::ENUMERATION;
static VOLTAGE_SOURCE: Enumeration = VoltageSource::ENUMERATION;
static FEEDBACK: Enumeration = Feedback::ENUMERATION;

/// Samples of the square system, the shortest window.
pub(super) const SQUARE_WINDOW: f64 = 3.0;

variable_table! {
    TIME = Variable::time();
    POSITION = Variable::input("position", &LENGTH)
        .describe("y = x1, measured rotor displacement");
    VOLTAGE_APPLIED = Variable::input("voltage_applied", &VOLTAGE)
        .describe("Voltage that acted on the plant over the last sample, used with observer.voltage_source = \
            applied");
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
        .describe("Largest difference between measured and modelled positions in the observer's window; for \
            kalman the magnitude of the innovation");
    OBSERVER_ITERATIONS = Variable::held_output("observer.iterations", Kind::Integer)
        .describe("Newton iterations of the last tick, at most observer.max_iterations; 1 of kalman");
    OBSERVER_CONVERGED = Variable::held_output("observer.converged", Kind::Boolean)
        .describe("Whether the last iteration moved the flux by less than a millionth of its size; of \
            kalman, whether the position lay within 6 standard deviations of the predicted one");
    TICK_TIME = Variable::local("tick_time", Kind::Real(&TIME_QUANTITY), Variability::Discrete)
        .describe("Time of the last tick, a multiple of sample_time; the start time before the first");
    POSITION_DEVIATION =
        Variable::local("estimate.position_deviation", Kind::Real(&LENGTH), Variability::Discrete)
        .initially_from(&["observer.kind"])
        .describe("Standard deviation of estimate.position from kalman's covariance, 0 for other observers");
    VELOCITY_DEVIATION =
        Variable::local("estimate.velocity_deviation", Kind::Real(&VELOCITY), Variability::Discrete)
        .initially_from(&["observer.kind"])
        .describe("Standard deviation of estimate.velocity from kalman's covariance, 0 for other observers");
    FLUX_DEVIATION =
        Variable::local("estimate.flux_deviation", Kind::Real(&MAGNETIC_FLUX), Variability::Discrete)
        .initially_from(&["observer.kind"])
        .describe("Standard deviation of estimate.flux from kalman's covariance, 0 for other observers");
    SAMPLE_TIME = Variable::parameter("sample_time", Kind::Real(&DURATION), 1e-3)
        .range(1e-6, 1.0)
        .describe("T, the controller ticks at all multiples of it, whatever the communication step size");
    START_DELAY = start_delay();
    LONGEST_STEP = longest_step();
    OBSERVER = Variable::parameter("observer.kind", Kind::Enumeration(&OBSERVER_KIND), ObserverKind::Newton.number())
        .describe("State estimator");
    OBSERVER_MAP = Variable::parameter("observer.map", Kind::Enumeration(&MAP), MapChoice::Printed.number())
        .describe("Model that the Newton observers invert; kalman always uses the exact one");
    MAX_ITERATIONS = Variable::tunable("observer.max_iterations", Kind::Integer, 10.0)
        .range(1.0, 1000.0)
        .describe("d, largest number of Newton iterations per tick; the paper prints 10 in Remark 1 and 100 \
            in Table 1");
    STEP_SIZE = Variable::tunable("observer.step_size", Kind::Real(&RATIO), 1.0)
        .range(1e-3, 1.0)
        .describe("alpha of Remark 2, share of the Newton step that is taken");
    LINE_SEARCH = Variable::tunable("observer.line_search", Kind::Boolean, 0.0)
        .describe("Varying step size of Remark 5: newton halves a step, from alpha on, until it decreases \
            the residual");
    WINDOW = Variable::parameter("observer.window", Kind::Integer, SQUARE_WINDOW)
        .range(SQUARE_WINDOW, MAX_WINDOW as f64)
        .describe("N, length of newton's window in samples: 3 gives the paper's square system, more a \
            least-squares fit");
    FILTER_TIME = Variable::parameter("observer.filter_time", Kind::Real(&DURATION), 1e-3)
        .range(0.0, 10.0)
        .describe("T_s, time constant of the velocity filter of the reduced-order observers");
    POSITION_NOISE = Variable::tunable("observer.position_noise", Kind::Real(&LENGTH), 1e-6)
        .range(1e-15, 1.0)
        .describe("Standard deviation of the measured position that kalman assumes");
    FLUX_NOISE = Variable::tunable("observer.flux_noise", Kind::Real(&MAGNETIC_FLUX), 1e-6)
        .range(0.0, 1e3)
        .describe("Standard deviation of the flux process noise per sample that kalman assumes; the larger, \
            the less it relies on its model");
    OBSERVER_INITIAL_POSITION = Variable::parameter("observer.initial.position", Kind::Real(&LENGTH), 0.0)
        .range(-1.0, 1.0)
        .describe("First component of w0, the observer's first guess");
    OBSERVER_INITIAL_VELOCITY = Variable::parameter("observer.initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("Second component of w0; of the Newton observers also the estimate until two past samples \
            exist");
    OBSERVER_INITIAL_FLUX = Variable::parameter("observer.initial.flux", Kind::Real(&MAGNETIC_FLUX), 1e-9)
        .range(-1e3, 1e3)
        .describe("Third component of w0; of the Newton observers also the estimate until two past samples exist");
    OBSERVER_VOLTAGE_SOURCE =
        Variable::parameter("observer.voltage_source", Kind::Enumeration(&VOLTAGE_SOURCE), VoltageSource::Command.number())
        .describe("Voltage that the observer takes as applied over the last sample");
    CONTROLLER_LAW = Variable::tunable("controller.law", Kind::Enumeration(&LAW), LawKind::A.number())
        .describe("Control law");
    CONTROLLER_FEEDBACK = Variable::tunable("controller.feedback", Kind::Enumeration(&FEEDBACK), Feedback::Estimate.number())
        .describe("Source of the law's state feedback besides the measured position");
    K1 = Variable::tunable("controller.k1", Kind::Real(&POSITION_GAIN), 0.92)
        .range(-1e6, 1e6)
        .describe("k1 of u0 = -k1 x1 - k2 x2 in the laws a, b, c");
    K2 = Variable::tunable("controller.k2", Kind::Real(&VELOCITY_GAIN), 9.94)
        .range(-1e6, 1e6)
        .describe("k2 of u0 = -k1 x1 - k2 x2 in the laws a, b, c");
    CASCADE_POSITION_GAIN = Variable::tunable("controller.cascade.position_gain", Kind::Real(&SQUARED_RATE), 25.0)
        .range(0.0, 1e6)
        .describe("kp of flux_cascade, square of the position loop's natural frequency");
    CASCADE_VELOCITY_GAIN = Variable::tunable("controller.cascade.velocity_gain", Kind::Real(&RATE), 10.0)
        .range(0.0, 1e6)
        .describe("kd of flux_cascade; 2 sqrt(kp) damps the position loop critically");
    CASCADE_FLUX_GAIN = Variable::tunable("controller.cascade.flux_gain", Kind::Real(&RATE), 200.0)
        .range(0.0, 1e6)
        .describe("k3 of flux_cascade, bandwidth of the flux loop, to be well below 1 / sample_time");
    CASCADE_REGULARISATION =
        Variable::tunable("controller.cascade.regularisation", Kind::Real(&MAGNETIC_FLUX), 1e-3)
        .range(0.0, 1.0)
        .describe("r of flux_cascade, flux below which it takes the force for linear; the smaller, the more \
            noise moves the voltage");
    INITIAL_VOLTAGE = Variable::parameter("controller.initial_voltage", Kind::Real(&VOLTAGE), -150.0)
        .range(-1e6, 1e6)
        .describe("u(0), output of the first tick");
    VOLTAGE_LIMIT = Variable::tunable("controller.voltage_limit", Kind::Real(&VOLTAGE), 150.0)
        .range(0.0, 1e6)
        .describe("u_sat, largest magnitude of the output");
    BIAS_FLUX = bias_flux();
    SATURATION_FLUX = saturation_flux();
}

pub static DESCRIPTION: Description = Description::new("MagneticBearingController", &VARIABLES)
    .summary("Observers and nonlinear control laws for a flux-controlled active magnetic bearing")
    .experiment(1e-3, 10.0);
