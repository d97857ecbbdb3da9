//! Variables and description of the levitated ball.

use crate::model::Description;
use crate::model::levitated_ball::{
    ACCELERATION, CURRENT, FLUX, FORCE, LABORATORY_FLUX, POSITION, VELOCITY, VOLTAGE, gap, gravity,
    inductance_constant, mass, resistance,
};
use crate::model::sensor::{SensorVariables, sensor_variables};
use crate::model::variable::{Kind, Variability, Variable, variable_table};

const SENSOR: SensorVariables = sensor_variables! {
    reads "current_measured", &CURRENT, "Current with sensor noise and resolution", ideally "current itself";
    with errors &CURRENT, up to 1e3, of "the current sensor";
    seeds "the sensor's";
};

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step unless its derivative is set");
    FORCE_INPUT = Variable::input("force", &FORCE)
        .range(-1e6, 1e6)
        .describe("Disturbing force on the ball, positive upwards, held over a step unless its derivative is set");
    CURRENT_OUTPUT = Variable::output("current", &CURRENT)
        .describe("i = (c - y) lam / k, coil current");
    POSITION_OUTPUT = Variable::output("position", &POSITION)
        .reinitialised()
        .describe("y, position of the ball, positive upwards, the magnet's face at gap");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .reinitialised()
        .describe("p / m, velocity of the ball, positive upwards");
    FLUX_OUTPUT = Variable::output("flux", &FLUX)
        .describe("lam, flux linkage of the coil");
    VOLTAGE_MEASURED = Variable::output("voltage_measured", &VOLTAGE)
        .describe("Mean voltage applied over the last step; in model exchange the present one; wire it to the \
            controller's voltage_applied");
    CURRENT_MEASURED = SENSOR.reading;
    CONTACT = Variable::held_output("contact", Kind::Boolean)
        .describe("Whether the ball rests on the magnet or on the lower stop");
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&VELOCITY), Variability::Continuous)
        .derivative_of("position")
        .describe("y', 0 in contact");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .derivative_of("velocity")
        .describe("p' / m under the present force; 0 in contact");
    FLUX_DERIVATIVE = Variable::local("der(flux)", Kind::Real(&VOLTAGE), Variability::Continuous)
        .derivative_of("flux")
        .describe("lam' = u - R i");
    LOWER_STOP_INDICATOR = Variable::event_indicator("event_indicator.lower_stop")
        .describe("Distance to the lower stop, relative to the travel; at rest there, acceleration towards it in g");
    MAGNET_INDICATOR = Variable::event_indicator("event_indicator.magnet")
        .describe("Distance to the magnet, relative to the travel; at rest there, acceleration towards it in g");
    MAGNETIC_FORCE = Variable::local("magnetic_force", Kind::Real(&FORCE), Variability::Continuous)
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
        .describe("y at the start; limited to the positions between the stops");
    INITIAL_VELOCITY = Variable::parameter("initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("p / m at the start");
    INITIAL_FLUX = Variable::parameter("initial.flux", Kind::Real(&FLUX), LABORATORY_FLUX)
        .range(-10.0, 10.0)
        .describe("lam at the start; the start value is sqrt(2 k m g), which balances the \
            weight with the other start values");
    SENSOR_NOISE = SENSOR.noise;
    SENSOR_RESOLUTION = SENSOR.resolution;
    SENSOR_SAMPLE_TIME = SENSOR.sample_time;
    SENSOR_SEED = SENSOR.seed;
}

pub static DESCRIPTION: Description = Description::new("LevitatedBallPlant", &VARIABLES)
    .summary("Steel ball levitated by an electromagnet, one degree of freedom, voltage driven")
    .experiment(1e-4, 5.0);
