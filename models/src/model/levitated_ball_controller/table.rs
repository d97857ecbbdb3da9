//! Variables and description of the controller of the levitated ball.

use crate::model::Description;
use crate::model::choice::choice;
use crate::model::controller_choices::{Feedback, VoltageSource};
use crate::model::levitated_ball::{
    ADAPTATION_GAIN as ADAPTATION_GAIN_QUANTITY, CURRENT, FLUX, LABORATORY_FLUX, POSITION, RATE,
    RESISTANCE as RESISTANCE_QUANTITY, VELOCITY, VOLTAGE, gap, gravity, inductance_constant, mass,
    resistance,
};
use crate::model::longest_step::longest_step;
use crate::model::quantity::{DURATION, Enumeration, RATIO, TIME as TIME_QUANTITY};
use crate::model::start_delay::start_delay;
use crate::model::variable::{Kind, Variability, Variable, variable_table};

choice! {
    pub(super) enum ObserverKind = "BallObserver", "Estimator of the flux offset" {
        Drem = "drem", "Dynamic regressor extension and mixing, Proposition 6";
        PolynomialNewton = "polynomial_newton", "Newton iteration in time on the same regression";
        PolynomialNewtonAdaptive = "polynomial_newton_adaptive",
            "The same, which also learns the resistance or a voltage offset";
    }
}

choice! {
    pub(super) enum AdaptationKind = "BallAdaptation", "What polynomial_newton_adaptive learns" {
        Resistance = "resistance", "The resistance of the coil";
        VoltageOffset = "voltage_offset", "A constant that adds to the voltage";
    }
}

static OBSERVER_KIND: Enumeration = ObserverKind::ENUMERATION;
static ADAPTATION_KIND: Enumeration = AdaptationKind::ENUMERATION;
static VOLTAGE_SOURCE: Enumeration = Enumeration { name: "BallVoltageSource", ..VoltageSource::ENUMERATION };
static FEEDBACK: Enumeration = Enumeration {
    name: "BallFeedback",
    description: "Source of the law's state feedback",
    ..Feedback::ENUMERATION
};

const fn prefilter(name: &'static str, start: f64) -> Variable {
    Variable::parameter(name, Kind::Real(&RATE), start)
        .range(1e-2, 1e6)
        .describe("alpha, rate of a low-pass that makes the regression; the two have to differ")
}

const fn filter(name: &'static str, start: f64) -> Variable {
    Variable::parameter(name, Kind::Real(&RATE), start)
        .range(1e-3, 1e6)
        .describe("beta, rate of a filter p / (p + beta) of drem; two equal ones leave it without excitation")
}

variable_table! {
    TIME = Variable::time();
    CURRENT_INPUT = Variable::input("current", &CURRENT)
        .describe("i, measured coil current");
    REFERENCE = Variable::input("reference", &POSITION)
        .range(-10.0, 10.0)
        .describe("r, reference position before the filter, interpolated linearly between ticks");
    VOLTAGE_APPLIED = Variable::input("voltage_applied", &VOLTAGE)
        .describe("Voltage that acted on the plant over the last sample, used with observer.voltage_source = \
            applied");
    STATE_POSITION = Variable::input("state.position", &POSITION)
        .describe("True y, used with controller.feedback = state");
    STATE_VELOCITY = Variable::input("state.velocity", &VELOCITY)
        .describe("True p / m, used with controller.feedback = state");
    STATE_FLUX = Variable::input("state.flux", &FLUX)
        .describe("True lam, used with controller.feedback = state");
    VOLTAGE_OUTPUT = Variable::held_output("voltage", Kind::Real(&VOLTAGE))
        .describe("u, coil voltage, held between ticks, 0 before the first");
    ESTIMATE_FLUX = Variable::held_output("estimate.flux", Kind::Real(&FLUX))
        .initially_from(&["observer.initial.flux", "observer.initial.flux_offset"])
        .describe("Estimate of lam at the last tick");
    ESTIMATE_VELOCITY = Variable::held_output("estimate.velocity", Kind::Real(&VELOCITY))
        .initially_from(&["observer.initial.velocity"])
        .describe("Estimate of p / m at the last tick");
    ESTIMATE_POSITION = Variable::held_output("estimate.position", Kind::Real(&POSITION))
        .initially_from(&[
            "observer.initial.position_from_current", "observer.initial.position", "current", "gap",
            "mass", "gravity", "inductance_constant", "observer.initial.flux", "observer.initial.flux_offset",
        ])
        .describe("Estimate of y at the last tick");
    REFERENCE_POSITION = Variable::held_output("reference.position", Kind::Real(&POSITION))
        .initially_from(&["controller.initial_reference"])
        .describe("y*, filtered reference at the last tick");
    FLUX_OFFSET = Variable::held_output("observer.flux_offset", Kind::Real(&FLUX))
        .initially_from(&["observer.initial.flux_offset"])
        .describe("theta^, what is added to the integral of the induced voltage to get the flux");
    EXCITATION = Variable::held_output("observer.excitation", Kind::Real(&RATIO))
        .describe("Delta of drem at the last tick, scaled by observer.excitation_scale; 0 of the others");
    RESIDUAL = Variable::held_output("observer.residual", Kind::Real(&RATIO))
        .initially_from(&[
            "mass", "gravity", "inductance_constant", "observer.initial.flux", "observer.initial.flux_offset",
        ])
        .describe("Residual of the normalised regression of degree 5 at the estimated offset; 0 at the true offset");
    ESTIMATED_RESISTANCE = Variable::held_output("observer.estimated_resistance", Kind::Real(&RESISTANCE_QUANTITY))
        .initially_from(&["resistance"])
        .describe("R as learnt by polynomial_newton_adaptive, else as given");
    ESTIMATED_OFFSET = Variable::held_output("observer.voltage_offset", Kind::Real(&VOLTAGE))
        .describe("Voltage offset as learnt by polynomial_newton_adaptive, else 0");
    ACTIVE = Variable::held_output("observer.active", Kind::Boolean)
        .describe("Whether the offset is being estimated; false while the start-up hold lasts");
    TICK_TIME = Variable::local("tick_time", Kind::Real(&TIME_QUANTITY), Variability::Discrete)
        .describe("Time of the last tick, a multiple of sample_time; the start time before the first");
    REFERENCE_VELOCITY = Variable::local("reference.velocity", Kind::Real(&VELOCITY), Variability::Discrete)
        .describe("Rate of reference.position");
    SAMPLE_TIME = Variable::parameter("sample_time", Kind::Real(&DURATION), 1e-4)
        .range(1e-6, 1.0)
        .describe("T, the controller ticks at all multiples of it, whatever the communication step size");
    START_DELAY = start_delay();
    LONGEST_STEP = longest_step();
    OBSERVER = Variable::parameter("observer.kind", Kind::Enumeration(&OBSERVER_KIND), ObserverKind::Drem.number())
        .describe("Estimator of the flux offset");
    GAIN = Variable::tunable("observer.gain", Kind::Real(&RATE), 10.0)
        .range(0.0, 1e9)
        .describe("gamma of drem; 0 freezes the offset");
    EXCITATION_SCALE = Variable::tunable("observer.excitation_scale", Kind::Real(&RATIO), 1e9)
        .range(0.0, 1e15)
        .describe("kappa of drem, scale factor of its determinant; 1e9 suits the sinusoids, 1e10 the steps");
    NORMALISATION = Variable::tunable("observer.normalisation", Kind::Real(&RATIO), 0.0)
        .range(0.0, 1e15)
        .describe("mu: if not 0, the gain of drem is divided by mu^2 + Delta^2; not in the paper");
    PREFILTER_1 = prefilter("observer.prefilter[1]", 100.0);
    PREFILTER_2 = prefilter("observer.prefilter[2]", 300.0);
    FILTER_1 = filter("observer.filter[1]", 10.0);
    FILTER_2 = filter("observer.filter[2]", 25.0);
    FILTER_3 = filter("observer.filter[3]", 60.0);
    FILTER_4 = filter("observer.filter[4]", 150.0);
    NEWTON_GAIN = Variable::tunable("observer.newton_gain", Kind::Real(&RATE), 160.0)
        .range(0.0, 1e6)
        .describe("Rate at which polynomial_newton and its adaptive variant correct the offset");
    ADAPTATION = Variable::parameter("observer.adaptation", Kind::Enumeration(&ADAPTATION_KIND), AdaptationKind::Resistance.number())
        .describe("What polynomial_newton_adaptive learns");
    ADAPTATION_GAIN = Variable::tunable("observer.adaptation_gain", Kind::Real(&ADAPTATION_GAIN_QUANTITY), 3000.0)
        .range(0.0, 1e9)
        .describe("Integral gain of polynomial_newton_adaptive; a quarter of the square of observer.newton_gain damps \
            critically");
    SPEED_RATE = Variable::tunable("observer.speed_rate", Kind::Real(&RATE), 200.0)
        .range(0.0, 1e6)
        .describe("Rate at which the error of the velocity decays, g_p lam0^2 of Proposition 7");
    POSITION_RATE = Variable::tunable("observer.position_rate", Kind::Real(&RATE), 200.0)
        .range(0.0, 1e6)
        .describe("Rate at which the error of the position decays, g_y lam0^2 of Proposition 8");
    STARTUP_HOLD = Variable::parameter("observer.startup_hold", Kind::Real(&DURATION), 0.1)
        .range(0.0, 1e3)
        .describe("Time during which the offset is frozen, so that the initial transient of the prefilters can decay");
    FILTERS_FROM_ZERO = Variable::parameter("observer.filters_from_zero", Kind::Boolean, 0.0)
        .describe("For studies: all filters start from zero instead of from a ball at rest, which makes the start wrong");
    INITIAL_FLUX = Variable::parameter("observer.initial.flux", Kind::Real(&FLUX), LABORATORY_FLUX)
        .range(-10.0, 10.0)
        .describe("chi(0), where the integral of the induced voltage starts; the start value is the flux that \
            balances the weight with the other start values");
    INITIAL_OFFSET = Variable::parameter("observer.initial.flux_offset", Kind::Real(&FLUX), 0.0)
        .range(-10.0, 10.0)
        .describe("theta^(0)");
    INITIAL_VELOCITY = Variable::parameter("observer.initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("Estimate of p / m at the start");
    INITIAL_FROM_CURRENT = Variable::parameter("observer.initial.position_from_current", Kind::Boolean, 1.0)
        .describe("Whether the first estimate of y is c - k i / lam^, from the first current");
    INITIAL_POSITION = Variable::parameter("observer.initial.position", Kind::Real(&POSITION), 0.0)
        .range(-10.0, 1.0)
        .describe("Estimate of y at the start, unless it comes from the current");
    OBSERVER_VOLTAGE_SOURCE =
        Variable::parameter("observer.voltage_source", Kind::Enumeration(&VOLTAGE_SOURCE), VoltageSource::Command.number())
        .describe("Voltage that the observer takes as applied over the last sample");
    POLE = Variable::tunable("controller.pole", Kind::Real(&RATE), 60.0)
        .range(0.0, 1e5)
        .describe("rho, the error of the position has a triple pole at -rho");
    REFERENCE_FILTER = Variable::tunable("controller.reference_filter", Kind::Real(&RATE), 80.0)
        .range(1e-2, 1e5)
        .describe("wf, rate of the three low-passes that smooth the reference");
    INITIAL_REFERENCE = Variable::parameter("controller.initial_reference", Kind::Real(&POSITION), 0.0)
        .range(-10.0, 1.0)
        .describe("Where the filtered reference starts");
    CONTROLLER_FEEDBACK = Variable::tunable("controller.feedback", Kind::Enumeration(&FEEDBACK), Feedback::Estimate.number())
        .describe("Source of the law's state feedback");
    VOLTAGE_LIMIT = Variable::tunable("controller.voltage_limit", Kind::Real(&VOLTAGE), 12.0)
        .range(0.0, 1e6)
        .describe("Largest magnitude of the output; assumed");
    MASS = mass();
    RESISTANCE = resistance();
    INDUCTANCE_CONSTANT = inductance_constant();
    GAP = gap();
    GRAVITY = gravity();
}

pub static DESCRIPTION: Description = Description::new("LevitatedBallController", &VARIABLES)
    .summary("Sensorless observers and feedback-linearising law for a levitated ball")
    .experiment(1e-4, 5.0);
