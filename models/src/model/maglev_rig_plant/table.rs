//! Variables and description of the maglev rig.

use crate::model::Description;
use crate::model::maglev_rig::{
    BALL_ACCELERATION, BALL_DISTANCE, BALL_VELOCITY, DRIVER_VOLTAGE, OPERATING_VOLTAGE, RIG_CURRENT,
    RIG_FORCE, SENSOR_NOISE as SENSOR_NOISE_QUANTITY, SENSOR_VOLTAGE as SENSOR_VOLTAGE_QUANTITY, driver_gain,
    electromagnetic_constant, gravity, mass, sensor_gain, sensor_offset, voltage_max, voltage_min,
};
use crate::model::sensor::{SensorVariables, sensor_variables};
use crate::model::variable::{Kind, Variability, Variable, variable_table};

const SENSOR: SensorVariables = sensor_variables! {
    reads "sensor_voltage_measured", &SENSOR_VOLTAGE_QUANTITY, "Sensor voltage with noise, resolution and range",
        ideally "sensor voltage within the range";
    with errors &SENSOR_NOISE_QUANTITY, up to 1e3, of "the sensor";
    seeds "the sensor's";
};

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &DRIVER_VOLTAGE)
        .start(OPERATING_VOLTAGE)
        .describe("u, voltage at the coil's driver, held over a step unless its derivative is set, and limited by it");
    FORCE = Variable::input("force", &RIG_FORCE)
        .range(-1e3, 1e3)
        .describe("Disturbing force on the ball, positive downwards, held over a step unless its derivative is set");
    POSITION = Variable::output("position", &BALL_DISTANCE)
        .reinitialised()
        .describe("x, distance from coil to ball, positive downwards");
    VELOCITY = Variable::output("velocity", &BALL_VELOCITY)
        .reinitialised()
        .describe("x', velocity of the ball, positive downwards");
    CURRENT = Variable::output("current", &RIG_CURRENT)
        .describe("i = k1 u, coil current under voltage_measured: the mean over the last step, in model exchange the \
            one that flows; 0 before the first step, when no voltage has acted");
    SENSOR_VOLTAGE = Variable::output("sensor_voltage", &SENSOR_VOLTAGE_QUANTITY)
        .describe("k2 x + eta, true sensor voltage");
    SENSOR_VOLTAGE_MEASURED = SENSOR.reading;
    VOLTAGE_MEASURED = Variable::output("voltage_measured", &DRIVER_VOLTAGE)
        .describe("Mean voltage that acted over the last step, within the driver's limits, in model exchange the one \
            that acts; wire it to the controller's voltage_applied");
    CONTACT = Variable::held_output("contact", Kind::Boolean)
        .describe("Whether the ball rests on a stop");
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&BALL_VELOCITY), Variability::Continuous)
        .derivative_of("position")
        .describe("x', 0 at rest on a stop");
    ACCELERATION = Variable::local("acceleration", Kind::Real(&BALL_ACCELERATION), Variability::Continuous)
        .derivative_of("velocity")
        .describe("x'' under the present voltage and force; 0 at rest on a stop");
    UPPER_STOP_INDICATOR = Variable::event_indicator("event_indicator.upper_stop")
        .describe("Distance to the upper stop, relative to the travel; at rest there, acceleration towards it in g");
    LOWER_STOP_INDICATOR = Variable::event_indicator("event_indicator.lower_stop")
        .describe("Distance to the lower stop, relative to the travel; at rest there, acceleration towards it in g");
    MAGNETIC_FORCE = Variable::local("magnetic_force", Kind::Real(&RIG_FORCE), Variability::Continuous)
        .describe("K i^2 / x^2 under the present voltage, upwards");
    MASS = mass();
    GRAVITY = gravity();
    FORCE_CONSTANT = electromagnetic_constant();
    DRIVER_GAIN_PARAMETER = driver_gain();
    SENSOR_GAIN = sensor_gain();
    SENSOR_OFFSET = sensor_offset();
    VOLTAGE_MIN = voltage_min("voltage_min");
    VOLTAGE_MAX = voltage_max("voltage_max");
    UPPER_STOP = Variable::parameter("upper_stop", Kind::Real(&BALL_DISTANCE), 1e-3)
        .range(1e-4, 8e-3)
        .describe("Position at which the ball touches the coil; assumed, x = 0 is a pole of the force");
    LOWER_STOP = Variable::parameter("lower_stop", Kind::Real(&BALL_DISTANCE), 25e-3)
        .range(9e-3, 10.0)
        .describe("Position at which the ball lies; assumed, within the sensor's range");
    INITIAL_POSITION = Variable::parameter("initial.position", Kind::Real(&BALL_DISTANCE), 9e-3)
        .range(0.0, 10.0)
        .describe("x at the start, the rig manual's operating point; limited to the positions between the stops");
    INITIAL_VELOCITY = Variable::parameter("initial.velocity", Kind::Real(&BALL_VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("x' at the start");
    SENSOR_NOISE = SENSOR.noise;
    SENSOR_RESOLUTION = SENSOR.resolution;
    SENSOR_MINIMUM = Variable::tunable("sensor.minimum", Kind::Real(&SENSOR_VOLTAGE_QUANTITY), -3.75)
        .range(-1e3, 0.0)
        .describe("Smallest sensor voltage, which no ball can reach; -3.75 V with the offset of the rig's manual");
    SENSOR_MAXIMUM = Variable::tunable("sensor.maximum", Kind::Real(&SENSOR_VOLTAGE_QUANTITY), 1.25)
        .range(0.0, 1e3)
        .describe("Largest sensor voltage, 28 mm; 1.25 V with the offset of the rig's manual");
    SENSOR_SAMPLE_TIME = SENSOR.sample_time;
    SENSOR_SEED = SENSOR.seed;
}

pub static DESCRIPTION: Description = Description::new("MaglevRigPlant", &VARIABLES)
    .summary("Maglev rig Feedback 33-942S: a ball below a coil with its current driver and position sensor")
    .experiment(1e-3, 10.0);
