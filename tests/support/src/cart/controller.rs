//! The cart's controller: u = kp (reference - y) - kd v, with a filtered derivative v of the measured position y.
//!
//! The filter knows how the motor accelerates the cart: v(k) = a (v(k-1) + k/m T u(k-1)) + (1 - a) (y(k) - y(k-1)) / T with
//! a = exp(-T / tau) and u the voltage that acted.

use maglev_fmu::controller::saturate;
use maglev_fmu::model::controller_choices::VoltageSource;
use maglev_fmu::model::longest_step::longest_step;
use maglev_fmu::model::quantity::{self, DURATION, Enumeration, POSITION_GAIN, VELOCITY_GAIN};
use maglev_fmu::model::sampled_controller::{ObserverAndLaw, Sample, SampledController};
use maglev_fmu::model::start_delay::start_delay;
use maglev_fmu::model::variable::{Kind, Variability, Variable, variable_table};
use maglev_fmu::model::{Description, LogSink};
use serde::{Deserialize, Serialize};

use super::{
    MASS as MASS_QUANTITY, MOTOR_CONSTANT as MOTOR_CONSTANT_QUANTITY, POSITION as POSITION_QUANTITY,
    VELOCITY as VELOCITY_QUANTITY, VOLTAGE as VOLTAGE_QUANTITY,
};

static VOLTAGE_SOURCES: Enumeration = VoltageSource::ENUMERATION;

variable_table! {
    TIME = Variable::time();
    MEASURED = Variable::input("position", &POSITION_QUANTITY)
        .describe("y, measured position");
    VOLTAGE_APPLIED = Variable::input("voltage_applied", &VOLTAGE_QUANTITY)
        .describe("Voltage that acted over the last sample, used with observer.voltage_source = applied");
    REFERENCE = Variable::input("reference", &POSITION_QUANTITY)
        .start(0.1)
        .describe("Where the cart is to go");
    VOLTAGE = Variable::held_output("voltage", Kind::Real(&VOLTAGE_QUANTITY))
        .describe("u, held between ticks, 0 before the first");
    ESTIMATE_VELOCITY = Variable::held_output("estimate.velocity", Kind::Real(&VELOCITY_QUANTITY))
        .describe("v at the last tick");
    TICK_TIME = Variable::local("tick_time", Kind::Real(&quantity::TIME), Variability::Discrete)
        .describe("Time of the last tick; the start time before the first");
    SAMPLE_TIME = Variable::parameter("sample_time", Kind::Real(&DURATION), 2e-3)
        .range(1e-6, 1.0)
        .describe("T");
    START_DELAY = start_delay();
    LONGEST_STEP = longest_step();
    VOLTAGE_SOURCE = Variable::parameter(
        "observer.voltage_source",
        Kind::Enumeration(&VOLTAGE_SOURCES),
        VoltageSource::Command.number(),
    )
        .describe("Which voltage the filter believes acted over the last sample");
    FILTER_TIME = Variable::tunable("observer.filter_time", Kind::Real(&DURATION), 20e-3)
        .range(1e-6, 10.0)
        .describe("tau");
    MASS = Variable::tunable("observer.mass", Kind::Real(&MASS_QUANTITY), 2.0)
        .range(0.1, 100.0)
        .describe("m, mass that the filter assumes");
    MOTOR_CONSTANT = Variable::tunable("observer.motor_constant", Kind::Real(&MOTOR_CONSTANT_QUANTITY), 4.0)
        .range(0.0, 100.0)
        .describe("k, force per voltage that the filter assumes; 0 for a derivative that knows no motor");
    POSITION_GAIN_PARAMETER = Variable::tunable("controller.position_gain", Kind::Real(&POSITION_GAIN), 20.0)
        .range(0.0, 1e6)
        .describe("kp");
    VELOCITY_GAIN_PARAMETER = Variable::tunable("controller.velocity_gain", Kind::Real(&VELOCITY_GAIN), 6.0)
        .range(0.0, 1e6)
        .describe("kd");
    VOLTAGE_LIMIT = Variable::tunable("controller.voltage_limit", Kind::Real(&VOLTAGE_QUANTITY), 12.0)
        .range(0.0, 1e3)
        .describe("Largest magnitude of the voltage");
}

pub static DESCRIPTION: Description = Description::new("CartController", &VARIABLES)
    .summary("PD law with a filtered derivative for a cart on a rail")
    .experiment(2e-3, 5.0);

pub type CartController = SampledController<DerivativeAndLaw, COUNT>;

/// What the filter remembers from tick to tick.
#[derive(Clone, Serialize, Deserialize)]
pub struct DerivativeAndLaw {
    /// y(k-1) \[m\]
    position: f64,
    /// v(k-1) \[m/s\]
    velocity: f64,
}

impl ObserverAndLaw<COUNT> for DerivativeAndLaw {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    fn new(_: &[f64; COUNT]) -> Self {
        Self { position: 0.0, velocity: 0.0 }
    }

    /// Tunable parameters are read from the values at each tick.
    fn apply_tunable_parameters(&mut self, _: &[f64; COUNT]) {}

    fn initialise(&mut self, values: &mut [f64; COUNT]) {
        *self = Self::new(values);
        values[VOLTAGE] = 0.0;
        values[ESTIMATE_VELOCITY] = 0.0;
    }

    fn tick(&mut self, values: &mut [f64; COUNT], sample: Sample, _: &mut dyn LogSink) {
        let (position, sample_time) = (values[MEASURED], values[SAMPLE_TIME]);
        if !sample.is_first {
            let share = libm::exp(-sample_time / values[FILTER_TIME]);
            let predicted =
                self.velocity + values[MOTOR_CONSTANT] / values[MASS] * sample_time * sample.acting_voltage;
            let velocity = share * predicted + (1.0 - share) * (position - self.position) / sample_time;
            // What has overflowed is forgotten.
            self.velocity = if velocity.is_finite() { velocity } else { 0.0 };
        }
        self.position = position;
        let error = values[REFERENCE] - position;
        let wanted =
            values[POSITION_GAIN_PARAMETER] * error - values[VELOCITY_GAIN_PARAMETER] * self.velocity;
        values[VOLTAGE] = saturate(wanted, values[VOLTAGE_LIMIT], values[VOLTAGE]);
        values[ESTIMATE_VELOCITY] = self.velocity;
    }

    fn is_consistent(&self, _: &[f64; COUNT]) -> bool {
        self.position.is_finite() && self.velocity.is_finite()
    }

    fn cost_of_tick(_: &[f64; COUNT]) -> f64 {
        100e-9
    }
}
