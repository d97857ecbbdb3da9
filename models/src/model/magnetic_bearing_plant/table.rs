//! Variables and description of the magnetic bearing.

use crate::model::Description;
use crate::model::magnetic_bearing::{MAP, MapChoice, bias_flux, saturation_flux};
use crate::model::quantity::{ACCELERATION, LENGTH, MAGNETIC_FLUX, RATIO, VELOCITY, VOLTAGE};
use crate::model::sensor::{SensorVariables, sensor_variables};
use crate::model::variable::{Kind, Variability, Variable, variable_table};

const SENSOR: SensorVariables = sensor_variables! {
    reads "position_measured", &LENGTH, "Displacement with sensor noise and resolution", ideally "displacement itself";
    with errors &LENGTH, up to 1.0, of "the position sensor";
    seeds "sensor and process";
};

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step unless its derivative is set");
    POSITION = Variable::output("position", &LENGTH)
        .describe("x1, rotor displacement");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .describe("x2, rotor velocity");
    FLUX = Variable::output("flux", &MAGNETIC_FLUX)
        .describe("x3, magnetic flux");
    VOLTAGE_MEASURED = Variable::output("voltage_measured", &VOLTAGE)
        .describe("Mean voltage applied over the last step; in model exchange the present one; wire it to the \
            controller's voltage_applied");
    POSITION_MEASURED = SENSOR.reading;
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&VELOCITY), Variability::Continuous)
        .derivative_of("position")
        .describe("x1' = x2");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .derivative_of("velocity")
        .describe("x2' = epsilon x3 + x3 |x3|");
    FLUX_DERIVATIVE = Variable::local("der(flux)", Kind::Real(&VOLTAGE), Variability::Continuous)
        .derivative_of("flux")
        .describe("x3' = u");
    FLUX_SIGN = Variable::event_indicator("event_indicator.flux_sign")
        .describe("Flux in units of 0.1 Wb; x3 |x3| has a kink where its sign changes");
    EPSILON = Variable::calculated("epsilon", Kind::Real(&RATIO))
        .describe("2 bias_flux / saturation_flux");
    INITIAL_POSITION = Variable::parameter("initial.position", Kind::Real(&LENGTH), 0.01)
        .range(-1.0, 1.0)
        .describe("x1 at the start");
    INITIAL_VELOCITY = Variable::parameter("initial.velocity", Kind::Real(&VELOCITY), 0.0)
        .range(-1e3, 1e3)
        .describe("x2 at the start");
    INITIAL_FLUX = Variable::parameter("initial.flux", Kind::Real(&MAGNETIC_FLUX), 1e-9)
        .range(-1e3, 1e3)
        .describe("x3 at the start");
    BIAS_FLUX = bias_flux();
    SATURATION_FLUX = saturation_flux();
    SENSOR_NOISE = SENSOR.noise;
    SENSOR_RESOLUTION = SENSOR.resolution;
    SENSOR_SAMPLE_TIME = SENSOR.sample_time;
    SENSOR_SEED = SENSOR.seed;
    PROCESS_FLUX_NOISE = Variable::tunable("process.flux_noise", Kind::Real(&MAGNETIC_FLUX), 0.0)
        .range(0.0, 1e3)
        .describe("For studies: standard deviation of white noise added to the flux at each communication point, not in \
            model exchange");
    MAP_CHOICE = Variable::parameter("map", Kind::Enumeration(&MAP), MapChoice::Exact.number())
        .describe("How a step is solved; of no effect in model exchange");
}

pub static DESCRIPTION: Description = Description::new("MagneticBearingPlant", &VARIABLES)
    .summary("Flux-controlled active magnetic bearing with one degree of freedom")
    .experiment(1e-3, 10.0);
