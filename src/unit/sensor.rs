//! The sensor of a plant: when it is read, and its noise. What it reads, its resolution and its range are the plant's.
//!
//! With a sample time the sensor is read at the start and at all multiples of the sample time, and holds its reading in
//! between. Without one the unit that solves itself reads it at each communication point; for an importer that
//! integrates the unit there are no such points, and the sensor shows its value in continuous time, without noise and
//! resolution, which belong to readings.

use super::UnitError;
use super::continuous::Solver;
use super::quantity::DURATION;
use super::sample_clock::SampleClock;
use super::variable::{Kind, Variable};
use crate::signal::GaussianNoise;
use serde::{Deserialize, Serialize};

/// Stream of a seed that the noise comes from.
const STREAM: u64 = 1;

/// Shortest sample time but 0 \[s\].
const SHORTEST_SAMPLE_TIME: f64 = 1e-6;

/// What a reading costs \[s\], see [`super::work`].
const COST_OF_READING: f64 = 60e-9;

const NAME: &str = "sensor.sample_time";

/// Row of the sample time.
pub(super) const fn sample_time() -> Variable {
    Variable::parameter(NAME, Kind::Real(&DURATION), 0.0).range(0.0, 1e3).describe(
        "Time between readings of the sensor, which lie at its multiples, 1e-6 s or more; 0 for a reading at each \
         communication point, in model exchange for the value in continuous time, without noise and resolution",
    )
}

/// Refuses a sample time \[s\] too short to step through.
pub(super) fn check_sample_time(value: f64) -> Result<(), UnitError> {
    if value == 0.0 || value >= SHORTEST_SAMPLE_TIME {
        return Ok(());
    }
    let expected = "0 or at least 1e-6 s";
    Err(UnitError::Unusable { name: NAME, value, unit: DURATION.unit.name, expected })
}

/// Noise, and the clock of the readings if they have one.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Sensor {
    noise: GaussianNoise,
    clock: Option<SampleClock>,
}

/// The readings within a step.
pub(super) struct Readings {
    /// Time from the step's begin to the last one \[s\], none without a reading. Only it can be seen after the step.
    pub last: Option<f64>,
    /// Readings before it.
    skipped: i64,
    /// The clock at the step's end.
    clock: Option<SampleClock>,
}

impl Sensor {
    /// A sensor that is read by nobody yet.
    pub(super) fn new() -> Self {
        Self { noise: GaussianNoise::new(0, STREAM), clock: None }
    }

    /// A sensor at `start_time` \[s\], where it is about to be read.
    pub(super) fn start(seed: f64, sample_time: f64, start_time: f64) -> Result<Self, UnitError> {
        let mut clock = None;
        if sample_time > 0.0 {
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
        self.clock.is_some() || solver == Solver::Unit
    }

    /// A reading of `value` with noise of the standard deviation `deviation`.
    #[inline]
    pub(super) fn read(&mut self, value: f64, deviation: f64) -> f64 {
        match deviation {
            0.0 => value,
            deviation => value + deviation * self.noise.sample(),
        }
    }

    /// Computing for readings per second of the unit's time.
    #[inline]
    pub(super) fn load(&self) -> f64 {
        self.clock.map_or(0.0, |clock| COST_OF_READING / clock.period())
    }

    /// When it is to be read in a step over `duration` \[s\]: at its end, or at the multiples of the sample time in it,
    /// its end included.
    #[inline]
    pub(super) fn readings_within(&self, duration: f64) -> Readings {
        let Some(begin) = self.clock else {
            return Readings { last: Some(duration), skipped: 0, clock: None };
        };
        let mut end = begin;
        let ticks = end.advance_through(duration);
        if ticks.is_empty() {
            return Readings { last: None, skipped: 0, clock: Some(end) };
        }
        // What lies at the end but for rounding is at the end.
        let last =
            if end.has_just_ticked() { duration } else { begin.until(ticks.end - 1).clamp(0.0, duration) };
        Readings {
            last: Some(last),
            skipped: ticks.end.saturating_sub(ticks.start).saturating_sub(1),
            clock: Some(end),
        }
    }

    /// Goes through the readings of a step up to the last one, which is still to be read.
    #[inline]
    pub(super) fn skip_to_last(&mut self, readings: &Readings, deviation: f64) {
        self.clock = readings.clock;
        // So that the noise of a reading does not depend on how the time was cut into steps.
        if deviation != 0.0 {
            for _ in 0..readings.skipped {
                self.noise.sample();
            }
        }
    }

    /// Whether an importer that integrates the unit has come to a reading by `time` \[s\], which is counted.
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
            Some(clock) => clock.may_stand_where_it_does(sample_time),
            None => sample_time == 0.0,
        }
    }
}
