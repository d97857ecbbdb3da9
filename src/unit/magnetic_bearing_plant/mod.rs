//! Exported unit `MagneticBearingPlant`: the bearing, a position sensor and, for studies, process noise.

mod continuous;

use super::input_ramp::end_of_ramp;
use super::magnetic_bearing::{EXACT, MAP, bias_flux, map, saturation_flux};
use super::quantity::{ACCELERATION, LENGTH, MAGNETIC_FLUX, RATIO, VELOCITY, VOLTAGE};
use super::sensor::{Sensor, check_sample_time, sample_time};
use super::variable::{Dependency, Kind, Variability, Variable, variable_table};
use super::work::require_affordable;
use super::{ContinuousUnit, Description, Journal, Solver, Unit, UnitError, start_values};
use crate::plant::magnetic_bearing::{MagneticBearing, State};
use crate::signal::{GaussianNoise, quantise};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

variable_table! {
    TIME = Variable::time();
    VOLTAGE_INPUT = Variable::input("voltage", &VOLTAGE)
        .describe("u, coil voltage, held over a step unless its derivative is set");
    POSITION = Variable::output("position", &LENGTH)
        .initially_from(&["initial.position"])
        .depends_on(&[Dependency::constant("position")])
        .describe("x1, rotor displacement");
    VELOCITY_OUTPUT = Variable::output("velocity", &VELOCITY)
        .initially_from(&["initial.velocity"])
        .depends_on(&[Dependency::constant("velocity")])
        .describe("x2, rotor velocity");
    FLUX = Variable::output("flux", &MAGNETIC_FLUX)
        .initially_from(&["initial.flux"])
        .depends_on(&[Dependency::constant("flux")])
        .describe("x3, magnetic flux");
    VOLTAGE_MEASURED = Variable::output("voltage_measured", &VOLTAGE)
        .initially_from(&["voltage"])
        .depends_on(&[Dependency::dependent("voltage")])
        .describe("Mean voltage that acted over the last step, in model exchange the one that acts; wire it to the \
            controller's voltage_applied");
    POSITION_MEASURED = Variable::output("position_measured", &LENGTH)
        .initially_from(&[
            "initial.position", "sensor.noise", "sensor.resolution", "sensor.sample_time", "sensor.seed",
        ])
        .depends_on(&[Dependency::dependent("position")])
        .describe("Displacement with sensor noise and resolution, one reading per step or per sensor.sample_time; without \
            the latter in model exchange the displacement itself");
    POSITION_DERIVATIVE = Variable::local("der(position)", Kind::Real(&VELOCITY), Variability::Continuous)
        .initially_from(&["initial.velocity"])
        .derivative_of("position")
        .depends_on(&[Dependency::constant("velocity")])
        .describe("x1' = x2");
    ACCELERATION_LOCAL = Variable::local("acceleration", Kind::Real(&ACCELERATION), Variability::Continuous)
        .initially_from(&["initial.flux", "bias_flux", "saturation_flux"])
        .derivative_of("velocity")
        .depends_on(&[
            Dependency::dependent("flux"),
            Dependency::dependent("bias_flux"),
            Dependency::dependent("saturation_flux"),
        ])
        .describe("x2' = epsilon x3 + x3 |x3|");
    FLUX_DERIVATIVE = Variable::local("der(flux)", Kind::Real(&VOLTAGE), Variability::Continuous)
        .initially_from(&["voltage"])
        .derivative_of("flux")
        .depends_on(&[Dependency::constant("voltage")])
        .describe("x3' = u");
    FLUX_SIGN = Variable::event_indicator("event_indicator.flux_sign")
        .initially_from(&["initial.flux"])
        .depends_on(&[Dependency::dependent("flux")])
        .describe("Flux in units of 0.1 Wb; x3 |x3| has a kink where its sign changes");
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
    SENSOR_SAMPLE_TIME = sample_time();
    SENSOR_SEED = Variable::parameter("sensor.seed", Kind::Integer, 1.0)
        .range(0.0, i32::MAX as f64)
        .describe("Seed of sensor and process noise; the same seed gives the same run on every platform");
    PROCESS_FLUX_NOISE = Variable::tunable("process.flux_noise", Kind::Real(&MAGNETIC_FLUX), 0.0)
        .range(0.0, 1e3)
        .describe("For studies: standard deviation of white noise added to the flux at each communication point, not in \
            model exchange");
    MAP_CHOICE = Variable::parameter("map", Kind::Enumeration(&MAP), EXACT)
        .describe("How a step is solved; of no effect in model exchange");
}

pub static DESCRIPTION: Description = Description::new("MagneticBearingPlant", &VARIABLES)
    .summary("Flux-controlled active magnetic bearing with one degree of freedom")
    .documentation(&[
        "Rotor between two electromagnets, equation (3) of A. Mystkowski, Ü. Kotta, V. Kaparin, Newton observer for \
         a nonlinear flux-controlled AMB system, Proc. Estonian Acad. Sci. 67(1), 61-72, 2018: x1' = x2, \
         x2' = epsilon x3 + x3 |x3|, x3' = u. The paper calls its variables normalised; the units here are those of \
         its Table 1.",
        "The input voltage is held over a communication step and the step is solved in closed form, so the result \
         does not depend on the step size. The paper's closed form (4a) is exact only while the flux keeps its sign; \
         map = exact splits the step at the zero crossing, map = printed uses (4a) as it stands.",
        "For model exchange the states are position, velocity and flux, and the right-hand side is equation (3) itself, \
         without regard to map. The flux's change of sign is offered as a state event, since x3 |x3| has a kink there. \
         Readings of the sensor are time events if sensor.sample_time is not 0; without it position_measured is the \
         displacement itself there. voltage_measured is the voltage that acts. In co-simulation the voltage may have a \
         slope (input derivative of order 1, FMI 2.0); the step is then solved exactly, too, whatever map is.",
        "Not in the paper: the sensor model and the process noise, which are off at the start values.",
    ])
    .experiment(1e-3, 10.0);

/// Stream of the seed, another one than the sensor's.
const PROCESS_STREAM: u64 = 2;

/// The plant as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct MagneticBearingPlant {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    bearing: MagneticBearing,
    /// Slope of the input voltage during steps \[V/s\].
    voltage_slope: f64,
    /// On which side of zero the flux was at the last event.
    is_flux_positive: bool,
    solver: Solver,
    sensor: Sensor,
    process_noise: GaussianNoise,
}

impl MagneticBearingPlant {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        Self {
            values: start_values(&VARIABLES),
            bearing: MagneticBearing { epsilon: 0.0 },
            voltage_slope: 0.0,
            is_flux_positive: true,
            solver: Solver::default(),
            sensor: Sensor::new(),
            process_noise: GaussianNoise::new(0, PROCESS_STREAM),
        }
    }

    fn state(&self) -> State {
        let values = &self.values;
        State { position: values[POSITION], velocity: values[VELOCITY_OUTPUT], flux: values[FLUX] }
    }

    fn set_state(&mut self, state: State) {
        self.values[POSITION] = state.position;
        self.values[VELOCITY_OUTPUT] = state.velocity;
        self.values[FLUX] = state.flux;
    }

    /// Reads the sensor at a moment with this `position` \[m\].
    fn read_sensor(&mut self, position: f64) {
        let reading = self.sensor.read(position, self.values[SENSOR_NOISE]);
        self.values[POSITION_MEASURED] = quantise(reading, self.values[SENSOR_RESOLUTION]);
    }

    /// What becomes of a state in `duration` \[s\], the voltage beginning with `voltage` \[V\].
    #[inline]
    fn moved(&self, state: State, voltage: f64, duration: f64) -> Result<State, UnitError> {
        let state = if self.voltage_slope == 0.0 {
            self.bearing.advance(map(self.values[MAP_CHOICE]), state, voltage, duration)
        } else {
            self.bearing.advance_under_ramp(state, voltage, self.voltage_slope, duration)
        };
        check_finite(&state)?;
        Ok(state)
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
        let sensor = Sensor::start(values[SENSOR_SEED], values[SENSOR_SAMPLE_TIME], start_time)?;
        self.bearing = MagneticBearing::with_bias(values[BIAS_FLUX], values[SATURATION_FLUX]);
        values[EPSILON] = self.bearing.epsilon;
        values[TIME] = start_time;
        values[VOLTAGE_MEASURED] = 0.0;
        let state = State {
            position: values[INITIAL_POSITION],
            velocity: values[INITIAL_VELOCITY],
            flux: values[INITIAL_FLUX],
        };
        self.is_flux_positive = state.flux >= 0.0;
        self.sensor = sensor;
        self.process_noise = GaussianNoise::new(values[SENSOR_SEED] as u64, PROCESS_STREAM);
        self.set_state(state);
        self.evaluate();
        if self.sensor.is_read(self.solver) {
            self.read_sensor(state.position);
        }
        Ok(())
    }

    fn check_parameters(&self) -> Result<(), UnitError> {
        check_sample_time(self.values[SENSOR_SAMPLE_TIME])
    }

    fn advance(&mut self, duration: f64, _: &mut dyn Journal) -> Result<(), UnitError> {
        require_affordable(duration, [self.sensor.load()])?;
        let (voltage, slope) = (self.values[VOLTAGE_INPUT], self.voltage_slope);
        let end = end_of_ramp(&VARIABLES[VOLTAGE_INPUT], voltage, slope, duration)?;
        let (mut state, seen) = self.sensor.move_through(
            self.state(),
            duration,
            |state, begin, duration| self.moved(state, voltage + slope * begin, duration),
            |state| state.position,
        )?;
        if self.values[PROCESS_FLUX_NOISE] > 0.0 {
            state.flux += self.values[PROCESS_FLUX_NOISE] * self.process_noise.sample();
        }
        self.set_state(state);
        self.values[VOLTAGE_INPUT] = end;
        self.values[VOLTAGE_MEASURED] = voltage + 0.5 * slope * duration;
        self.settle_flux_sign();
        self.evaluate();
        self.sensor.skip_to_last(duration, self.values[SENSOR_NOISE]);
        if let Some(position) = seen {
            self.read_sensor(position);
        }
        Ok(())
    }

    fn is_consistent(&self) -> bool {
        self.bearing == MagneticBearing::with_bias(self.values[BIAS_FLUX], self.values[SATURATION_FLUX])
            && check_finite(&self.state()).is_ok()
            && self.voltage_slope.is_finite()
            && self.sensor.belongs_to(self.values[SENSOR_SAMPLE_TIME])
    }

    fn continuous(&mut self) -> Option<&mut dyn ContinuousUnit> {
        Some(self)
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
