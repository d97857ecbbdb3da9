//! Exported unit `MagneticBearingPlant`: the bearing, a position sensor and, for studies, process noise.

use super::magnetic_bearing::{EXACT, MAP, bias_flux, map, saturation_flux};
use super::quantity::{ACCELERATION, LENGTH, MAGNETIC_FLUX, RATIO, VELOCITY, VOLTAGE};
use super::variable::{Kind, Variability, Variable, variable_table};
use super::{Description, Journal, Unit, UnitError, start_values};
use crate::plant::magnetic_bearing::{MagneticBearing, State};
use crate::signal::{GaussianNoise, quantise};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step");
    POSITION = Variable::output("position", &LENGTH)
        .initially_from(&["initial.position"])
        .describe("x1, rotor displacement");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .initially_from(&["initial.velocity"])
        .describe("x2, rotor velocity");
    FLUX = Variable::output("flux", &MAGNETIC_FLUX)
        .initially_from(&["initial.flux"])
        .describe("x3, magnetic flux");
    VOLTAGE_MEASURED = Variable::held_output("voltage_measured", Kind::Real(&VOLTAGE))
        .describe("Voltage that acted over the last step; wire it to the controller's voltage_applied");
    POSITION_MEASURED = Variable::held_output("position_measured", Kind::Real(&LENGTH))
        .initially_from(&["initial.position", "sensor.noise", "sensor.resolution", "sensor.seed"])
        .describe("Displacement with sensor noise and resolution, one reading per step");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .initially_from(&["initial.flux", "bias_flux", "saturation_flux"])
        .describe("x2' = epsilon x3 + x3 |x3|");
    EPSILON = Variable::calculated("epsilon", Kind::Real(&RATIO))
        .initially_from(&["bias_flux", "saturation_flux"])
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
    SENSOR_NOISE = Variable::tunable("sensor.noise", Kind::Real(&LENGTH), 0.0)
        .range(0.0, 1.0)
        .describe("Standard deviation of the position sensor's white noise, per reading");
    SENSOR_RESOLUTION = Variable::tunable("sensor.resolution", Kind::Real(&LENGTH), 0.0)
        .range(0.0, 1.0)
        .describe("Step of the position sensor's output, 0 for none");
    SENSOR_SEED = Variable::parameter("sensor.seed", Kind::Integer, 1.0)
        .range(0.0, i32::MAX as f64)
        .describe("Seed of sensor and process noise; the same seed gives the same run on every platform");
    PROCESS_FLUX_NOISE = Variable::tunable("process.flux_noise", Kind::Real(&MAGNETIC_FLUX), 0.0)
        .range(0.0, 1e3)
        .describe("For studies: standard deviation of white noise added to the flux at each communication point");
    MAP_CHOICE = Variable::parameter("map", Kind::Enumeration(&MAP), EXACT)
        .describe("How a step is solved");
}

pub static DESCRIPTION: Description = Description {
    name: "MagneticBearingPlant",
    summary: "Flux-controlled active magnetic bearing with one degree of freedom",
    documentation: &[
        "Rotor between two electromagnets, equation (3) of A. Mystkowski, Ü. Kotta, V. Kaparin, Newton observer for \
         a nonlinear flux-controlled AMB system, Proc. Estonian Acad. Sci. 67(1), 61-72, 2018: x1' = x2, \
         x2' = epsilon x3 + x3 |x3|, x3' = u. The paper calls its variables normalised; the units here are those of \
         its Table 1.",
        "The input voltage is held over a communication step and the step is solved in closed form, so the result \
         does not depend on the step size. The paper's closed form (4a) is exact only while the flux keeps its sign; \
         map = exact splits the step at the zero crossing, map = printed uses (4a) as it stands.",
        "Not in the paper: the sensor model and the process noise, which are off at the start values.",
    ],
    variables: &VARIABLES,
    step_size: 1e-3,
    stop_time: 10.0,
};

/// Streams of the one seed.
const SENSOR_STREAM: u64 = 1;
const PROCESS_STREAM: u64 = 2;

/// The plant as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct MagneticBearingPlant {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    bearing: MagneticBearing,
    state: State,
    sensor_noise: GaussianNoise,
    process_noise: GaussianNoise,
}

impl MagneticBearingPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        Self {
            values: start_values(&VARIABLES),
            bearing: MagneticBearing { epsilon: 0.0 },
            state: State::default(),
            sensor_noise: GaussianNoise::new(0, SENSOR_STREAM),
            process_noise: GaussianNoise::new(0, PROCESS_STREAM),
        }
    }

    /// Writes the state and what follows from it to the outputs; takes one sensor reading.
    fn publish(&mut self) {
        let reading = match self.values[SENSOR_NOISE] {
            0.0 => self.state.position,
            deviation => self.state.position + deviation * self.sensor_noise.sample(),
        };
        self.values[POSITION] = self.state.position;
        self.values[VELOCITY_OUTPUT] = self.state.velocity;
        self.values[FLUX] = self.state.flux;
        self.values[POSITION_MEASURED] = quantise(reading, self.values[SENSOR_RESOLUTION]);
        self.values[ACCELERATION_LOCAL] = self.bearing.acceleration(self.state.flux);
    }
}

impl Default for MagneticBearingPlant {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for MagneticBearingPlant {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Sensor and process noise are read from the values at each step.
    fn adopt_parameters(&mut self) {}

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        let values = &mut self.values;
        self.bearing = MagneticBearing::with_bias(values[BIAS_FLUX], values[SATURATION_FLUX]);
        values[EPSILON] = self.bearing.epsilon;
        values[TIME] = start_time;
        values[VOLTAGE_MEASURED] = 0.0;
        self.state = State {
            position: values[INITIAL_POSITION],
            velocity: values[INITIAL_VELOCITY],
            flux: values[INITIAL_FLUX],
        };
        let seed = values[SENSOR_SEED] as u64;
        self.sensor_noise = GaussianNoise::new(seed, SENSOR_STREAM);
        self.process_noise = GaussianNoise::new(seed, PROCESS_STREAM);
        self.publish();
        Ok(())
    }

    fn advance(&mut self, duration: f64, _: &mut dyn Journal) -> Result<(), UnitError> {
        let voltage = self.values[VOLTAGE_INPUT];
        let mut state = self.bearing.advance(map(self.values[MAP_CHOICE]), self.state, voltage, duration);
        check_finite(&state)?;
        if self.values[PROCESS_FLUX_NOISE] > 0.0 {
            state.flux += self.values[PROCESS_FLUX_NOISE] * self.process_noise.sample();
        }
        self.state = state;
        self.values[VOLTAGE_MEASURED] = voltage;
        self.publish();
        Ok(())
    }

    fn is_consistent(&self) -> bool {
        self.bearing == MagneticBearing::with_bias(self.values[BIAS_FLUX], self.values[SATURATION_FLUX])
            && check_finite(&self.state).is_ok()
    }

    fn boxed_clone(&self) -> Box<dyn Unit> {
        Box::new(self.clone())
    }
}

fn check_finite(state: &State) -> Result<(), UnitError> {
    let components = [(POSITION, state.position), (VELOCITY_OUTPUT, state.velocity), (FLUX, state.flux)];
    match components.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(row, value)) => {
            Err(UnitError::Diverged { name: VARIABLES[row].name, value, unit: VARIABLES[row].unit() })
        }
        None => Ok(()),
    }
}
