//! The sensor of a plant: when it is read, and its noise. What it reads, its resolution and its range are the plant's.
//!
//! With a sample time the sensor is read at the start and at all multiples of the sample time, and holds its reading in
//! between. Without one the model that solves itself reads it at each communication point; for an importer that
//! integrates the model there are no such points, and the sensor shows its value in continuous time, without noise and
//! resolution, which belong to readings.

use super::ModelError;
use super::continuous::Solver;
use super::quantity::{DURATION, Quantity};
use super::sample_clock::SampleClock;
use super::variable::{Kind, Variable};
use super::work::Load;
use crate::scalar::Scalar;
use crate::signal::GaussianNoise;
use serde::{Deserialize, Serialize};

/// Stream of a seed that the noise comes from.
const STREAM: u64 = 1;

/// Shortest sample time but 0 \[s\].
const SHORTEST_SAMPLE_TIME: f64 = 1e-6;

/// What a reading costs \[s\], see [`super::work`].
const COST_OF_READING: f64 = 60e-9;

const NAME: &str = "sensor.sample_time";

/// The variables of a plant's sensor, declared with [`sensor_variables!`].
#[derive(Clone, Copy, Debug)]
pub struct SensorVariables {
    /// An output.
    pub reading: Variable,
    /// Standard deviation of the white noise.
    pub noise: Variable,
    pub resolution: Variable,
    pub sample_time: Variable,
    /// Of the random numbers.
    pub seed: Variable,
}

impl SensorVariables {
    /// A sensor that reads `reading`; what is random or rounded is an `error`, at most `largest_error` in size.
    pub const fn new(
        reading: (&'static str, &'static Quantity, &'static str),
        (error, largest_error): (&'static Quantity, f64),
        [noise, resolution, seed]: [&'static str; 3],
    ) -> Self {
        let (name, quantity, description) = reading;
        Self {
            reading: Variable::output(name, quantity).describe(description),
            noise: Variable::tunable("sensor.noise", Kind::Real(error), 0.0)
                .range(0.0, largest_error)
                .describe(noise),
            resolution: Variable::tunable("sensor.resolution", Kind::Real(error), 0.0)
                .range(0.0, largest_error)
                .describe(resolution),
            sample_time: sample_time(),
            seed: Variable::parameter("sensor.seed", Kind::Integer, 1.0)
                .range(0.0, i32::MAX as f64)
                .describe(seed),
        }
    }
}

/// The variables of a sensor from what differs from plant to plant.
#[macro_export]
macro_rules! sensor_variables {
    (
        reads $name:literal, $quantity:expr, $description:literal, ideally $ideal:literal;
        with errors $error:expr, up to $largest_error:literal, of $sensor:literal;
        seeds $noise:literal;
    ) => {
        $crate::model::sensor::SensorVariables::new(
            (
                $name,
                $quantity,
                concat!(
                    $description,
                    ", one reading per step or per sensor.sample_time; without the latter in model exchange the ",
                    $ideal
                ),
            ),
            ($error, $largest_error),
            [
                concat!("Standard deviation of ", $sensor, "'s white noise, per reading"),
                concat!("Quantisation step of ", $sensor, "'s output, 0 for none"),
                concat!("Seed of ", $noise, " noise; the same seed gives the same run on every platform"),
            ],
        )
    };
}
pub use sensor_variables;

const fn sample_time() -> Variable {
    Variable::parameter(NAME, Kind::Real(&DURATION), 0.0).range(0.0, 1e3).describe(
        "Time between readings of the sensor, which lie at its multiples, 1e-6 s or more; 0 for a reading at each \
         communication point, in model exchange for the value in continuous time, without noise and resolution",
    )
}

/// Refuses a sample time \[s\] too short to step through.
pub(super) fn check_sample_time(value: f64) -> Result<(), ModelError> {
    if value == 0.0 || value >= SHORTEST_SAMPLE_TIME {
        return Ok(());
    }
    let expected = "0 or at least 1e-6 s";
    Err(ModelError::Unusable { name: NAME, value, unit: DURATION.unit.name, expected })
}

/// A `value` with noise of the standard deviation `standard_deviation`; `sample` has that of 1, or is 0 where there is none.
#[inline]
pub(super) fn noisy<S: Scalar>(value: S, standard_deviation: S, sample: S) -> S {
    if sample.is_zero() { value } else { value + standard_deviation * sample }
}

/// Noise, and the clock of the readings if they have one.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Sensor {
    noise: GaussianNoise,
    clock: Option<SampleClock>,
}

impl Sensor {
    /// A sensor that is read by nobody yet.
    pub(super) fn new() -> Self {
        Self { noise: GaussianNoise::new(0, STREAM), clock: None }
    }

    /// A sensor at `start_time` \[s\], where it is about to be read.
    pub(super) fn start(seed: f64, sample_time: f64, start_time: f64) -> Result<Self, ModelError> {
        let mut clock = None;
        // What is refused in the end may stand there meanwhile, and all else be read.
        if sample_time >= SHORTEST_SAMPLE_TIME {
            let mut ticking = SampleClock::starting(sample_time, start_time)?;
            ticking.advance_through(0.0);
            clock = Some(ticking);
        }
        Ok(Self { noise: GaussianNoise::new(seed as u64, STREAM), clock })
    }

    /// First number of the noise that comes from a seed.
    pub(super) fn first_noise(seed: f64) -> f64 {
        GaussianNoise::new(seed as u64, STREAM).sample()
    }

    /// Whether there are readings at all.
    pub(super) fn is_read(&self, solver: Solver) -> bool {
        self.clock.is_some() || solver == Solver::Model
    }

    /// A reading of `value` with noise of the standard deviation `standard_deviation`.
    #[inline]
    pub(super) fn read(&mut self, value: f64, standard_deviation: f64) -> f64 {
        if standard_deviation == 0.0 { value } else { noisy(value, standard_deviation, self.sample()) }
    }

    /// The next number of the noise, of standard deviation 1.
    #[inline]
    pub(super) fn sample(&mut self) -> f64 {
        self.noise.sample()
    }

    /// Work of its readings.
    #[inline]
    pub(super) fn load(&self) -> Load {
        match &self.clock {
            Some(clock) => Load { cost: COST_OF_READING, interval: clock.period() },
            None => Load::NONE,
        }
    }

    /// Moves a plant through a step over `duration` \[s\]: up to the last reading in it, the only one that can be seen after
    /// the step, and from there to its end. Readings lie at the end, or at the multiples of the sample time, the end
    /// included. Returns the state at the end and what the sensor sees at that reading, none without one.
    ///
    /// `moved` gives what becomes of a state from a time since the step's begin on, in a time, both in s; `seen` is what
    /// the sensor measures of a state.
    #[inline]
    pub(super) fn move_through<S: Copy>(
        &self,
        start: S,
        duration: f64,
        mut moved: impl FnMut(S, f64, f64) -> Result<S, ModelError>,
        seen: impl Fn(S) -> f64,
    ) -> Result<(S, Option<f64>), ModelError> {
        let last_reading = match &self.clock {
            None => Some(duration),
            Some(clock) => last_tick_through(clock, duration),
        };
        let (mut begin, mut end) = (0.0, last_reading.unwrap_or(duration));
        let (mut state, mut before_end) = (start, None);
        // A loop, so that one place moves the plant, into which that is compiled.
        loop {
            state = moved(state, begin, end - begin)?;
            if end >= duration {
                break;
            }
            before_end = Some(seen(state));
            (begin, end) = (end, duration);
        }
        Ok((state, before_end.or(last_reading.map(|_| seen(state)))))
    }

    /// Goes through the readings of a step up to the last one, which is still to be read.
    #[inline]
    pub(super) fn skip_to_last(&mut self, duration: f64, standard_deviation: f64) {
        if let Some(clock) = &mut self.clock {
            let readings = clock.advance_through(duration);
            // So that the noise of a reading does not depend on how the time was cut into steps.
            if standard_deviation != 0.0 {
                for _ in 1..readings.end.saturating_sub(readings.start) {
                    self.noise.sample();
                }
            }
        }
    }

    /// Whether an importer that integrates the model has come to a reading by `time` \[s\], which is counted.
    pub(super) fn reaches_reading(&mut self, time: f64) -> bool {
        self.clock.as_mut().is_some_and(|clock| !clock.advance_up_to(time).is_empty())
    }

    /// Time of the next reading \[s\], if it lies after `now`.
    pub(super) fn next_reading(&self, now: f64) -> Option<f64> {
        self.clock.map(|clock| clock.next_time()).filter(|time| *time > now)
    }

    /// Whether it can have been started with this sample time \[s\].
    pub(super) fn belongs_to(&self, sample_time: f64) -> bool {
        match self.clock {
            Some(clock) => clock.is_valid_for(sample_time),
            None => sample_time < SHORTEST_SAMPLE_TIME,
        }
    }
}

#[inline(never)]
fn last_tick_through(begin: &SampleClock, duration: f64) -> Option<f64> {
    let mut end = *begin;
    let ticks = end.advance_through(duration);
    if ticks.is_empty() {
        return None;
    }
    // What lies at the end but for rounding is at the end.
    let is_at_end = end.has_just_ticked();
    Some(if is_at_end { duration } else { begin.until(ticks.end - 1).clamp(0.0, duration) })
}
