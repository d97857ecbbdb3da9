//! The cart: m x'' = k u - d x', with the voltage u of its motor, and a sensor of the position x.

use maglev_fmu::model::continuous_plant::{ContinuousPlant, Motion, PlantEquations};
use maglev_fmu::model::quantity::Quantity;
use maglev_fmu::model::sensor::{SensorVariables, sensor_variables};
use maglev_fmu::model::unit_of_measure::{METRE_PER_SECOND_SQUARED, NEWTON_SECOND_PER_METRE};
use maglev_fmu::model::variable::{Kind, Variability, Variable, variable_table};
use maglev_fmu::model::work::Load;
use maglev_fmu::model::{Description, quantity};
use maglev_fmu::plant::runge_kutta;
use maglev_fmu::scalar::Scalar;
use serde::{Deserialize, Serialize};

use super::{
    MASS as MASS_QUANTITY, MOTOR_CONSTANT as MOTOR_CONSTANT_QUANTITY, POSITION as POSITION_QUANTITY,
    VELOCITY as VELOCITY_QUANTITY, VOLTAGE as VOLTAGE_QUANTITY,
};

static ACCELERATION_QUANTITY: Quantity = Quantity {
    name: "CartAcceleration",
    description: "Acceleration of the cart",
    unit: &METRE_PER_SECOND_SQUARED,
    nominal: 1.0,
};
static FRICTION_QUANTITY: Quantity = Quantity {
    name: "ViscousFriction",
    description: "Force against the motion per velocity",
    unit: &NEWTON_SECOND_PER_METRE,
    nominal: 1.0,
};
const SENSOR: SensorVariables = sensor_variables! {
    reads "position_measured", &POSITION_QUANTITY, "Position with sensor noise and resolution", ideally "position itself";
    with errors &POSITION_QUANTITY, up to 1.0, of "the position sensor";
    seeds "the sensor's";
};

variable_table! {
    TIME = Variable::time();
    VOLTAGE = Variable::input("voltage", &VOLTAGE_QUANTITY)
        .describe("u, voltage of the motor");
    POSITION = Variable::output("position", &POSITION_QUANTITY)
        .describe("x, position of the cart");
    VELOCITY = Variable::output("velocity", &VELOCITY_QUANTITY)
        .describe("x', velocity of the cart");
    VOLTAGE_MEASURED = Variable::output("voltage_measured", &VOLTAGE_QUANTITY)
        .describe("Mean voltage that acted over the last step, in model exchange the one that acts");
    POSITION_MEASURED = SENSOR.reading;
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&VELOCITY_QUANTITY), Variability::Continuous)
        .derivative_of("position")
        .describe("x'");
    ACCELERATION = Variable::local("acceleration", Kind::Real(&ACCELERATION_QUANTITY), Variability::Continuous)
        .derivative_of("velocity")
        .describe("x'' = (k u - d x') / m");
    DAMPING = Variable::calculated("damping", Kind::Real(&quantity::RATE))
        .describe("d / m");
    MASS = Variable::parameter("mass", Kind::Real(&MASS_QUANTITY), 2.0)
        .range(0.1, 100.0)
        .describe("m");
    FRICTION = Variable::parameter("friction", Kind::Real(&FRICTION_QUANTITY), 1.0)
        .range(0.0, 10.0)
        .describe("d");
    MOTOR_CONSTANT = Variable::tunable("motor_constant", Kind::Real(&MOTOR_CONSTANT_QUANTITY), 4.0)
        .range(0.0, 100.0)
        .describe("k");
    INITIAL_POSITION = Variable::parameter("initial.position", Kind::Real(&POSITION_QUANTITY), 0.0)
        .range(-10.0, 10.0)
        .describe("x at the start");
    INITIAL_VELOCITY = Variable::parameter("initial.velocity", Kind::Real(&VELOCITY_QUANTITY), 0.0)
        .range(-1e3, 1e3)
        .describe("x' at the start");
    SENSOR_NOISE = SENSOR.noise;
    SENSOR_RESOLUTION = SENSOR.resolution;
    SENSOR_SAMPLE_TIME = SENSOR.sample_time;
    SENSOR_SEED = SENSOR.seed;
}

pub static DESCRIPTION: Description = Description::new("CartPlant", &VARIABLES)
    .summary("Cart on a rail, driven by a motor")
    .experiment(1e-3, 5.0);

/// Longest step of the integrator \[s\], a tenth of the fastest time constant.
const SUBSTEP: f64 = 1e-3;

/// What a step of the integrator costs \[s\].
const COST_OF_SUBSTEP: f64 = 200e-9;

pub type CartPlant = ContinuousPlant<CartEquations, COUNT, 2, 1>;

#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub struct CartEquations;

fn acceleration<S: Scalar>(values: &[S; COUNT], velocity: S, voltage: S) -> S {
    values[MOTOR_CONSTANT] / values[MASS] * voltage - values[DAMPING] * velocity
}

impl PlantEquations<COUNT, 2, 1> for CartEquations {
    type Mode = ();

    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const MODES: &'static [()] = &[()];
    const STATES: [usize; 2] = [POSITION, VELOCITY];
    const INPUTS: [usize; 1] = [VOLTAGE];
    const READING: usize = POSITION_MEASURED;

    fn new(_: &[f64; COUNT]) -> Self {
        Self
    }

    fn calculate_parameters<S: Scalar>(values: &mut [S; COUNT]) {
        values[DAMPING] = values[FRICTION] / values[MASS];
    }

    fn initial_state<S: Scalar>(values: &[S; COUNT]) -> [S; 2] {
        [values[INITIAL_POSITION], values[INITIAL_VELOCITY]]
    }

    fn evaluate<S: Scalar>(values: &mut [S; COUNT], (): ()) {
        values[POSITION_DERIVATIVE] = values[VELOCITY];
        values[ACCELERATION] = acceleration(values, values[VELOCITY], values[VOLTAGE]);
    }

    fn report_acting_voltage<S: Scalar>(values: &mut [S; COUNT], voltage: S) {
        values[VOLTAGE_MEASURED] = voltage;
    }

    fn measured<S: Scalar>(_: &[S; COUNT], &[position, _]: &[S; 2]) -> S {
        position
    }

    fn advance(
        &self,
        values: &[f64; COUNT],
        motion: Motion<(), 2>,
        inputs: [f64; 1],
        duration: f64,
    ) -> Motion<(), 2> {
        self.advance_under_ramp(values, motion, inputs, [0.0], duration)
    }

    fn advance_under_ramp(
        &self,
        values: &[f64; COUNT],
        motion: Motion<(), 2>,
        [voltage]: [f64; 1],
        [slope]: [f64; 1],
        duration: f64,
    ) -> Motion<(), 2> {
        let count = libm::ceil(duration / SUBSTEP).max(1.0);
        let rate =
            |&[_, velocity, voltage]: &[f64; 3]| [velocity, acceleration(values, velocity, voltage), slope];
        let [position, velocity] = motion.state;
        let end = (0..count as u64).fold([position, velocity, voltage], |state, _| {
            runge_kutta::step(rate, &state, duration / count)
        });
        Motion { state: [end[0], end[1]], ..motion }
    }

    fn load(&self) -> Load {
        Load { cost: COST_OF_SUBSTEP, interval: SUBSTEP }
    }
}
