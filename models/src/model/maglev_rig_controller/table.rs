//! Variables and description of the controller of the maglev rig.

use crate::model::Description;
use crate::model::choice::choice;
use crate::model::controller_choices::VoltageSource;
use crate::model::longest_step::longest_step;
use crate::model::maglev_rig::{
    BALL_ACCELERATION, BALL_DISTANCE, BALL_VELOCITY, BANDWIDTH, DRIVER_VOLTAGE, FIRST_OBSERVER_GAIN,
    INPUT_GAIN, OBSERVED_ACCELERATION, OBSERVED_INPUT_GAIN, OBSERVED_POSITION, OBSERVED_VELOCITY,
    OPERATING_SENSOR_VOLTAGE, OPERATING_VOLTAGE, SECOND_OBSERVER_GAIN, SENSOR_NOISE as SENSOR_NOISE_QUANTITY,
    SENSOR_VOLTAGE as SENSOR_VOLTAGE_QUANTITY, THIRD_OBSERVER_GAIN, driver_gain, electromagnetic_constant,
    gravity, mass, sensor_gain, sensor_offset, voltage_max, voltage_min,
};
use crate::model::quantity::{DURATION, Enumeration, RATE, RATIO, TIME as TIME_QUANTITY};
use crate::model::start_delay::start_delay;
use crate::model::variable::{Kind, Variability, Variable, variable_table};
use crate::observer::gauss_newton::MAX_WINDOW;

choice! {
    pub(super) enum ObserverKind = "RigObserver", "State estimator" {
        Linear = "linear", "LESO, the error is fed in with constant gains, (12)";
        Nonlinear = "nonlinear", "NESO, the error is fed in through Han's function fal, (11)";
        Kalman = "kalman", "Extended Kalman filter on (6) with a disturbing acceleration as third state";
        WindowedNewton = "windowed_newton",
            "Least squares by Gauss-Newton over a window of samples on (6) with a disturbing acceleration";
    }
}

choice! {
    pub(super) enum Tuning = "RigObserverTuning", "Where the observer's gains come from" {
        Bandwidth = "bandwidth", "3 w, 3 w^2, w^3 with w = observer.bandwidth, (13)";
        Gains = "gains", "The parameters observer.gain";
    }
}

choice! {
    pub(super) enum DiscretisationKind = "RigObserverDiscretisation",
        "How the observer's differential equation is solved over a sample"
    {
        Exact = "exact", "Closed form for held signals; of nonlinear with its gains frozen over the sample";
        RungeKutta = "runge_kutta", "Classical Runge-Kutta, observer.substeps times per sample";
        Euler = "euler", "Forward Euler; nonlinear is unstable by it at 1 ms with the printed parameters";
        Automatic = "automatic", "exact for linear, runge_kutta for nonlinear";
    }
}

choice! {
    pub(super) enum FormKind = "RigObserverForm", "Which samples an estimate uses" {
        Predictor = "predictor", "Those before the tick; the measurement is held over a sample";
        Current = "current",
            "That of the tick, too: exact and euler correct a prediction with it, runge_kutta interpolates the \
             measurement linearly between samples";
    }
}

choice! {
    pub(super) enum MeasurementKind = "RigObserverMeasurement", "What the observer takes for its measurement" {
        Volts = "volts", "The sensor voltage";
        Metres = "metres", "The distance computed from it with sensor_gain and sensor_offset";
    }
}

choice! {
    pub(super) enum Initial = "RigObserverStart", "Estimate at the first tick" {
        Matched = "matched", "Position as measured, all else zero";
        Zero = "zero", "Zero, as the paper assumes: its Table 5 is the transient that follows";
        Steady = "steady", "At rest as measured, held by controller.operating_voltage: no transient";
    }
}

choice! {
    pub(super) enum LawKind = "RigController", "Control law" {
        Pid = "pid", "Digital PID of the sensor voltage with anti-windup";
        DisturbanceRejection = "disturbance_rejection",
            "Linear active disturbance rejection: the estimated extended state is cancelled";
    }
}

choice! {
    pub(super) enum DerivativeKind = "RigDerivative", "What the derivative of the PID is taken of" {
        Error = "error", "Of the error, as reconstructed: a step of the reference kicks the voltage";
        Measurement = "measurement", "Of the sensor voltage alone";
    }
}

static OBSERVER_KIND: Enumeration = ObserverKind::ENUMERATION;
static TUNING: Enumeration = Tuning::ENUMERATION;
static DISCRETISATION: Enumeration = DiscretisationKind::ENUMERATION;
static FORM: Enumeration = FormKind::ENUMERATION;
static MEASUREMENT: Enumeration = MeasurementKind::ENUMERATION;
static INITIAL: Enumeration = Initial::ENUMERATION;
static VOLTAGE_SOURCE: Enumeration = VoltageSource::ENUMERATION;
static CONTROLLER_KIND: Enumeration = LawKind::ENUMERATION;
static DERIVATIVE: Enumeration = DerivativeKind::ENUMERATION;

variable_table! {
    TIME = Variable::time();
    SENSOR_VOLTAGE = Variable::input("sensor_voltage", &SENSOR_VOLTAGE_QUANTITY)
        .start(OPERATING_SENSOR_VOLTAGE)
        .range(-1e6, 1e6)
        .describe("y, measured voltage of the position sensor; it grows as the ball falls");
    REFERENCE = Variable::input("reference", &SENSOR_VOLTAGE_QUANTITY)
        .start(OPERATING_SENSOR_VOLTAGE)
        .range(-1e6, 1e6)
        .describe("r, wanted sensor voltage; sensor_gain x + sensor_offset is a distance x from the coil");
    VOLTAGE_APPLIED = Variable::input("voltage_applied", &DRIVER_VOLTAGE)
        .start(OPERATING_VOLTAGE)
        .range(-1e6, 1e6)
        .describe("Voltage that acted on the plant over the last sample, used with observer.voltage_source = applied");
    VOLTAGE_OUTPUT = Variable::held_output("voltage", Kind::Real(&DRIVER_VOLTAGE))
        .initially_from(&["controller.operating_voltage", "controller.voltage_min", "controller.voltage_max"])
        .describe("u, held between ticks; the operating voltage before the first");
    ESTIMATE_POSITION = Variable::held_output("estimate.position", Kind::Real(&OBSERVED_POSITION))
        .initially_from(&[
            "sensor_voltage", "observer.initial", "observer.measurement", "sensor_gain", "sensor_offset",
        ])
        .describe("z1 at the last tick, in V or m as observer.measurement selects");
    ESTIMATE_VELOCITY = Variable::held_output("estimate.velocity", Kind::Real(&OBSERVED_VELOCITY))
        .describe("z2 at the last tick, in V/s or m/s as observer.measurement selects");
    ESTIMATE_EXTENDED = Variable::held_output("estimate.extended", Kind::Real(&OBSERVED_ACCELERATION))
        .initially_from(&["observer.initial", "observer.input_gain", "controller.operating_voltage"])
        .describe("z3 at the last tick: estimate of the acceleration minus b u, in V/s2 or m/s2 as \
            observer.measurement selects; for kalman and windowed_newton the model's acceleration under the applied \
            voltage, plus the estimated disturbance, minus b u");
    OBSERVER_RESIDUAL = Variable::held_output("observer.residual", Kind::Real(&OBSERVED_POSITION))
        .describe("Innovation at the last tick: y minus its prediction, in V or m as observer.measurement selects");
    OBSERVER_RESTARTS = Variable::held_output("observer.restarts", Kind::Integer)
        .describe("How often the observer diverged and started anew from the measurement");
    SI_POSITION = Variable::local("estimate.si.position", Kind::Real(&BALL_DISTANCE), Variability::Discrete)
        .describe("z1 as a distance, whatever observer.measurement");
    SI_VELOCITY = Variable::local("estimate.si.velocity", Kind::Real(&BALL_VELOCITY), Variability::Discrete)
        .describe("z2 as a velocity, whatever observer.measurement");
    SI_EXTENDED = Variable::local("estimate.si.extended", Kind::Real(&BALL_ACCELERATION), Variability::Discrete)
        .describe("z3 as an acceleration, whatever observer.measurement");
    FILTERED_REFERENCE =
        Variable::local("controller.reference", Kind::Real(&SENSOR_VOLTAGE_QUANTITY), Variability::Discrete)
        .describe("Filtered reference at the last tick");
    TICK_TIME = Variable::local("tick_time", Kind::Real(&TIME_QUANTITY), Variability::Discrete)
        .describe("Time of the last tick, a multiple of sample_time; the start time before the first");
    SAMPLE_TIME = Variable::parameter("sample_time", Kind::Real(&DURATION), 1e-3)
        .range(1e-6, 1.0)
        .describe("T, the controller ticks at all multiples of it, whatever the communication step size");
    START_DELAY = start_delay();
    LONGEST_STEP = longest_step();
    OBSERVER = Variable::parameter("observer.kind", Kind::Enumeration(&OBSERVER_KIND), ObserverKind::Linear.number())
        .describe("State estimator");
    OBSERVER_TUNING = Variable::tunable("observer.tuning", Kind::Enumeration(&TUNING), Tuning::Bandwidth.number())
        .describe("Where the gains of linear and nonlinear come from");
    OBSERVER_BANDWIDTH = Variable::tunable("observer.bandwidth", Kind::Real(&BANDWIDTH), 100.0)
        .range(1e-3, 1e5)
        .describe("w_o, minus the triple pole of the linear observer; printed in Table 3. With disturbance_rejection \
            300 is a good choice");
    OBSERVER_GAIN_1 = Variable::tunable("observer.gain[1]", Kind::Real(&FIRST_OBSERVER_GAIN), 300.0)
        .range(0.0, 1e6)
        .describe("L1, printed in Tables 3 and 4");
    OBSERVER_GAIN_2 = Variable::tunable("observer.gain[2]", Kind::Real(&SECOND_OBSERVER_GAIN), 3e4)
        .range(0.0, 1e12)
        .describe("L2, printed in Tables 3 and 4");
    OBSERVER_GAIN_3 = Variable::tunable("observer.gain[3]", Kind::Real(&THIRD_OBSERVER_GAIN), 1e6)
        .range(0.0, 1e18)
        .describe("L3, printed in Tables 3 and 4");
    OBSERVER_INPUT_GAIN = Variable::tunable("observer.input_gain", Kind::Real(&OBSERVED_INPUT_GAIN), 1.0)
        .range(-1e9, 1e9)
        .describe("b, assumed input gain: acceleration per driver voltage. Printed 1 (Tables 3, 4) has \
            the wrong sign: it suffices for estimation; for control set it to controller.input_gain. kalman and \
            windowed_newton use it only to compute estimate.extended");
    EXPONENT_1 = Variable::tunable("observer.exponent[1]", Kind::Real(&RATIO), 1.0)
        .range(0.01, 2.0)
        .describe("alpha1 of nonlinear, printed in Table 4; 1 is linear");
    EXPONENT_2 = Variable::tunable("observer.exponent[2]", Kind::Real(&RATIO), 0.5)
        .range(0.01, 2.0)
        .describe("alpha2 of nonlinear, printed in Table 4");
    EXPONENT_3 = Variable::tunable("observer.exponent[3]", Kind::Real(&RATIO), 0.25)
        .range(0.01, 2.0)
        .describe("alpha3 of nonlinear, printed in Table 4");
    LINEAR_ZONE_1 = Variable::tunable("observer.linear_zone[1]", Kind::Real(&OBSERVED_POSITION), 0.01)
        .range(1e-9, 1e3)
        .describe("delta1 of nonlinear, error up to which it is linear, printed in Table 4 without a unit");
    LINEAR_ZONE_2 = Variable::tunable("observer.linear_zone[2]", Kind::Real(&OBSERVED_POSITION), 0.01)
        .range(1e-9, 1e3)
        .describe("delta2 of nonlinear");
    LINEAR_ZONE_3 = Variable::tunable("observer.linear_zone[3]", Kind::Real(&OBSERVED_POSITION), 0.01)
        .range(1e-9, 1e3)
        .describe("delta3 of nonlinear");
    OBSERVER_DISCRETISATION =
        Variable::parameter("observer.discretisation", Kind::Enumeration(&DISCRETISATION), DiscretisationKind::Automatic.number())
        .describe("How the observer's differential equation is solved over a sample");
    OBSERVER_FORM = Variable::parameter("observer.form", Kind::Enumeration(&FORM), FormKind::Predictor.number())
        .describe("Which samples an estimate uses");
    OBSERVER_SUBSTEPS = Variable::parameter("observer.substeps", Kind::Integer, 1.0)
        .range(1.0, 1000.0)
        .describe("Steps of runge_kutta per sample");
    WINDOW = Variable::parameter("observer.window", Kind::Integer, 24.0)
        .range(3.0, MAX_WINDOW as f64)
        .describe("N, length of windowed_newton's window in samples");
    MAX_ITERATIONS = Variable::tunable("observer.max_iterations", Kind::Integer, 3.0)
        .range(1.0, 1000.0)
        .describe("Largest number of Gauss-Newton iterations per tick of windowed_newton, which start from the last solution");
    ESTIMATE_DISTURBANCE = Variable::parameter("observer.estimate_disturbance", Kind::Boolean, 1.0)
        .describe("Whether kalman and windowed_newton estimate a disturbing acceleration, which stands for a force or \
            another mass, too; without it they trust their model alone");
    DISTURBANCE_NOISE = Variable::tunable("observer.disturbance_noise", Kind::Real(&BALL_ACCELERATION), 2.0)
        .range(0.0, 1e6)
        .describe("Standard deviation of the change of the disturbing acceleration within a second that kalman assumes, \
            a random walk: the larger, the faster and the noisier it follows");
    OBSERVER_SENSOR_NOISE = Variable::tunable("observer.sensor_noise", Kind::Real(&SENSOR_NOISE_QUANTITY), 1e-3)
        .range(1e-9, 1e3)
        .describe("Standard deviation of the sensor voltage that kalman assumes");
    OBSERVER_MEASUREMENT = Variable::parameter("observer.measurement", Kind::Enumeration(&MEASUREMENT), MeasurementKind::Volts.number())
        .describe("What the observer takes for its measurement");
    OBSERVER_INITIAL = Variable::parameter("observer.initial", Kind::Enumeration(&INITIAL), Initial::Steady.number())
        .describe("Estimate at the first tick");
    OBSERVER_VOLTAGE_SOURCE =
        Variable::parameter("observer.voltage_source", Kind::Enumeration(&VOLTAGE_SOURCE), VoltageSource::Command.number())
        .describe("Voltage that the observer takes as applied over the last sample");
    CONTROLLER_KIND_CHOICE = Variable::tunable("controller.kind", Kind::Enumeration(&CONTROLLER_KIND), LawKind::Pid.number())
        .describe("Control law");
    KP = Variable::tunable("controller.kp", Kind::Real(&RATIO), 4.2)
        .range(-1e6, 1e6)
        .describe("Kp of pid, on y - r in sensor volts, printed in Table 2");
    KI = Variable::tunable("controller.ki", Kind::Real(&RATE), 2.2)
        .range(-1e6, 1e6)
        .describe("Ki of pid, printed in Table 2");
    KD = Variable::tunable("controller.kd", Kind::Real(&DURATION), 0.02)
        .range(-1e3, 1e3)
        .describe("Kd of pid, printed in Table 2");
    CONTROLLER_DERIVATIVE = Variable::tunable("controller.derivative", Kind::Enumeration(&DERIVATIVE), DerivativeKind::Error.number())
        .describe("What the derivative of pid is taken of");
    CONTROLLER_OPERATING_VOLTAGE =
        Variable::tunable("controller.operating_voltage", Kind::Real(&DRIVER_VOLTAGE), OPERATING_VOLTAGE)
        .range(-100.0, 100.0)
        .describe("u0, voltage of pid without an error; the start value holds the ball at 9 mm");
    CONTROLLER_BANDWIDTH = Variable::tunable("controller.bandwidth", Kind::Real(&BANDWIDTH), 60.0)
        .range(0.0, 1e5)
        .describe("w_c of disturbance_rejection, minus the double pole of the loop; a fifth of observer.bandwidth");
    CONTROLLER_INPUT_GAIN = Variable::tunable("controller.input_gain", Kind::Real(&INPUT_GAIN), -3705.0)
        .range(-1e9, 1e9)
        .describe("b0 of disturbance_rejection, acceleration in sensor volts per driver voltage, not 0; a wrong sign \
            loses the ball");
    REFERENCE_FILTER = Variable::tunable("controller.reference_filter", Kind::Real(&BANDWIDTH), 0.0)
        .range(0.0, 1e5)
        .describe("w of the filter of the reference, two poles at -w, whose derivatives disturbance_rejection feeds \
            forward; 0 for none");
    VOLTAGE_MIN = voltage_min("controller.voltage_min");
    VOLTAGE_MAX = voltage_max("controller.voltage_max");
    SENSOR_GAIN = sensor_gain();
    SENSOR_OFFSET = sensor_offset();
    MASS = mass();
    GRAVITY = gravity();
    FORCE_CONSTANT = electromagnetic_constant();
    DRIVER_GAIN = driver_gain();
}

pub static DESCRIPTION: Description = Description::new("MaglevRigController", &VARIABLES)
    .summary("Observers, PID and disturbance rejection for the maglev rig Feedback 33-942S")
    .experiment(1e-3, 10.0);
