//! A plant as a model: it keeps time, sensor, slopes and mode, and asks the equations for the rest.

use core::array::from_fn;

use super::evaluation::initialise;
use super::{Motion, PlantEquations};
use crate::model::sensor::{Sensor, check_sample_time};
use crate::model::work::require_affordable;
use crate::model::{ContinuousModel, Description, LogSink, Model, ModelError, Solver, TIME, Topic};
use crate::signal::{GaussianNoise, quantise};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// Stream of the seed that process noise comes from, another one than the sensor's.
const PROCESS_STREAM: u64 = 2;

/// A plant of `N` variables, `X` continuous states and `U` inputs that follows the equations `E`.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ContinuousPlant<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> {
    #[serde(with = "BigArray")]
    pub(super) values: [f64; N],
    pub(super) equations: E,
    pub(super) mode: E::Mode,
    /// Slopes of the inputs during steps \[1/s of their units\].
    #[serde(with = "BigArray")]
    pub(super) slopes: [f64; U],
    pub(super) solver: Solver,
    pub(super) sensor: Sensor,
    process_noise: GaussianNoise,
}

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> ContinuousPlant<E, N, X, U> {
    /// The plant with the start values of its table.
    pub fn new() -> Self {
        let values = from_fn(|row| E::DESCRIPTION.variables[row].start);
        Self {
            equations: E::new(&values),
            values,
            mode: E::Mode::default(),
            slopes: [0.0; U],
            solver: Solver::default(),
            sensor: Sensor::new(),
            process_noise: GaussianNoise::new(0, PROCESS_STREAM),
        }
    }

    pub(super) fn motion(&self) -> Motion<E::Mode, X> {
        Motion { state: E::STATES.map(|row| self.values[row]), mode: self.mode }
    }

    pub(super) fn inputs(&self) -> [f64; U] {
        E::INPUTS.map(|row| self.values[row])
    }

    #[inline]
    pub(super) fn set_motion(&mut self, motion: Motion<E::Mode, X>) {
        for (row, value) in E::STATES.into_iter().zip(motion.state) {
            self.values[row] = value;
        }
        E::report_mode(&mut self.values, motion.mode);
        self.mode = motion.mode;
    }

    /// Reads the sensor at a moment with this `measured` value.
    pub(super) fn read_sensor(&mut self, measured: f64) {
        let rows = E::SENSOR;
        let noisy = self.sensor.read(measured, self.values[rows.noise]);
        self.values[E::READING] =
            E::within_range(&self.values, quantise(noisy, self.values[rows.resolution]));
    }

    /// What becomes of a motion in `duration` \[s\], the inputs beginning with `inputs`.
    #[inline]
    fn moved(
        &self,
        motion: Motion<E::Mode, X>,
        inputs: [f64; U],
        duration: f64,
    ) -> Result<Motion<E::Mode, X>, ModelError> {
        let motion = if self.slopes == [0.0; U] {
            self.equations.advance(&self.values, motion, inputs, duration)
        } else {
            self.equations.advance_under_ramp(&self.values, motion, inputs, self.slopes, duration)
        };
        self.check_finite(&motion.state)?;
        Ok(motion)
    }

    #[inline]
    fn check_finite(&self, state: &[f64; X]) -> Result<(), ModelError> {
        let also = E::also_finite(&self.values, state);
        if state.iter().all(|number| number.is_finite()) && also.is_none_or(|(_, number)| number.is_finite())
        {
            return Ok(());
        }
        Err(diverged::<E, N, X, U>(E::STATES.into_iter().zip(*state).chain(also)))
    }

    /// Values of the inputs at the end of a step over `duration` \[s\]. One that its slope takes out of its range is
    /// refused, since nobody could set it there.
    #[inline]
    fn inputs_after(&self, begin: [f64; U], duration: f64) -> Result<[f64; U], ModelError> {
        let end = from_fn(|input| begin[input] + self.slopes[input] * duration);
        if self.slopes != [0.0; U] {
            for (input, row) in
                E::INPUTS.into_iter().enumerate().filter(|(input, _)| self.slopes[*input] != 0.0)
            {
                E::DESCRIPTION.variables[row].check(end[input]).map_err(ModelError::InputLeavesRange)?;
            }
        }
        Ok(end)
    }
}

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> Default
    for ContinuousPlant<E, N, X, U>
{
    fn default() -> Self {
        Self::new()
    }
}

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> Model
    for ContinuousPlant<E, N, X, U>
{
    fn description(&self) -> &'static Description {
        E::DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Tunable parameters are read from the values at each step.
    fn apply_tunable_parameters(&mut self) {}

    fn initialise(&mut self, start_time: f64) -> Result<(), ModelError> {
        let rows = E::SENSOR;
        let seed = self.values[rows.seed];
        self.sensor = Sensor::start(seed, self.values[rows.sample_time], start_time)?;
        self.process_noise = GaussianNoise::new(seed as u64, PROCESS_STREAM);
        let values = &mut self.values;
        values[TIME] = start_time;
        E::calculate_parameters(values);
        self.equations = E::new(values);
        self.mode = E::initial_mode(values, &E::initial_state(values));
        let is_read = self.sensor.is_read(self.solver);
        let is_noisy = is_read && values[rows.noise] != 0.0;
        let sample = if is_noisy { self.sensor.sample() } else { 0.0 };
        initialise::<E, f64, N, X, U>(values, self.mode, self.solver, is_read, sample);
        E::report_mode(values, self.mode);
        Ok(())
    }

    fn check_parameters(&self) -> Result<(), ModelError> {
        check_sample_time(self.values[E::SENSOR.sample_time])
    }

    #[inline]
    fn check_step(&self, duration: f64) -> Result<(), ModelError> {
        require_affordable(duration, [self.equations.load(), self.sensor.load()])
    }

    fn advance(&mut self, duration: f64, sink: &mut dyn LogSink) -> Result<(), ModelError> {
        self.check_step(duration)?;
        let (begin, slopes) = (self.inputs(), self.slopes);
        let end = self.inputs_after(begin, duration)?;
        let (mut motion, measured) = self.sensor.move_through(
            self.motion(),
            duration,
            |motion, time, duration| {
                self.moved(motion, from_fn(|input| begin[input] + slopes[input] * time), duration)
            },
            |motion| E::measured(&self.values, &motion.state),
        )?;
        if motion.mode != self.mode && sink.enabled(Topic::Events) {
            announce::<E, N, X, U>(self.values[TIME] + duration, motion.mode, sink);
        }
        if let Some(noise) = E::PROCESS_NOISE
            && self.values[noise.standard_deviation] > 0.0
        {
            motion.state[noise.state] += self.values[noise.standard_deviation] * self.process_noise.sample();
        }
        self.set_motion(E::at_communication_point(&self.values, motion));
        for (row, value) in E::INPUTS.into_iter().zip(end) {
            self.values[row] = value;
        }
        let voltage = E::mean_acting_voltage(&self.values, begin[0], slopes[0], duration);
        E::report_acting_voltage(&mut self.values, voltage);
        self.evaluate();
        self.sensor.skip_to_last(duration, self.values[E::SENSOR.noise]);
        if let Some(measured) = measured {
            self.read_sensor(measured);
        }
        Ok(())
    }

    fn continuous(&mut self) -> Option<&mut dyn ContinuousModel> {
        Some(self)
    }

    /// An importer may set states from which nothing can be computed, so that only they themselves have to be finite.
    fn is_consistent(&self, is_initialised: bool) -> bool {
        let are_finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        // Slopes outlive initialisation.
        if !is_initialised || !are_finite(&self.slopes) {
            return are_finite(&self.slopes);
        }
        let mut expected = self.values;
        E::calculate_parameters(&mut expected);
        expected.map(f64::to_bits) == self.values.map(f64::to_bits)
            && self.equations == E::new(&self.values)
            && are_finite(&self.motion().state)
            && self.sensor.belongs_to(self.values[E::SENSOR.sample_time])
    }
}

#[cold]
fn diverged<E, const N: usize, const X: usize, const U: usize>(
    components: impl IntoIterator<Item = (usize, f64)>,
) -> ModelError
where
    E: PlantEquations<N, X, U>,
{
    let is_finite = |(_, value): &(usize, f64)| value.is_finite();
    let (row, value) =
        components.into_iter().find(|component| !is_finite(component)).unwrap_or((0, f64::NAN));
    let variable = &E::DESCRIPTION.variables[row];
    ModelError::Diverged { name: variable.name, value, unit: variable.unit() }
}

#[cold]
fn announce<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize>(
    time: f64,
    mode: E::Mode,
    sink: &mut dyn LogSink,
) {
    if let Some(announcement) = E::announcement(mode) {
        sink.log(Topic::Events, format_args!("by t = {time} s {announcement}"));
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{ContinuousModel, LevitatedBallPlant, Model, Persistent};

    /// Guards: slopes that initialisation keeps and that no step can use.
    #[test]
    fn slopes_from_bytes_are_finite_before_initialisation_too() {
        let mut plant = LevitatedBallPlant::new();
        let (voltage, _) = plant.description().find("voltage").unwrap();
        let slope = 0.123_456_789_f64;
        plant.set_input_slope(voltage, slope);
        let mut bytes = [0; 4096];
        let length = plant.save(&mut bytes).unwrap();
        assert!(plant.restore(&bytes[..length], false).is_ok());
        assert_eq!(plant.input_slope(voltage), slope);
        let place = bytes.windows(8).position(|window| window == slope.to_le_bytes()).unwrap();
        bytes[place..place + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        assert!(plant.restore(&bytes[..length], false).is_err());
        assert_eq!(plant.input_slope(voltage), slope);
    }
}
