//! A controller as a model: it keeps the clock and asks observer and law at its ticks.

use core::array::from_fn;

use super::{ControllerRows, ObserverAndLaw, Sample};
use crate::model::controller_choices::VoltageSource;
use crate::model::sample_clock::SampleClock;
use crate::model::start_delay::StartDelay;
use crate::model::{Description, LogSink, Model, ModelError, SampledModel, TIME};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// A controller of `N` variables with the observer and the law `C`.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct SampledController<C: ObserverAndLaw<N>, const N: usize> {
    #[serde(with = "BigArray")]
    values: [f64; N],
    clock: SampleClock,
    start_delay: StartDelay,
    /// Whether the first tick is still to come.
    is_first_sample: bool,
    controller: C,
}

impl<C: ObserverAndLaw<N>, const N: usize> SampledController<C, N> {
    const ROWS: ControllerRows = ControllerRows::of(C::DESCRIPTION.variables);

    /// The controller with the start values of its table.
    pub fn new() -> Self {
        let values = from_fn(|row| C::DESCRIPTION.variables[row].start);
        let sample_time = values[Self::ROWS.sample_time];
        Self {
            clock: SampleClock::new(sample_time, 0.0),
            start_delay: StartDelay::new(0.0, values[Self::ROWS.start_delay], sample_time),
            is_first_sample: true,
            controller: C::new(&values),
            values,
        }
    }

    #[inline]
    fn tick_at(&mut self, time: f64, sink: &mut dyn LogSink) {
        if self.start_delay.covers(time) {
            return;
        }
        let (values, rows) = (&mut self.values, Self::ROWS);
        values[rows.tick_time] = time;
        let is_applied = VoltageSource::Applied.is(values[rows.voltage_source]);
        let acting_voltage = values[if is_applied { rows.voltage_applied } else { rows.voltage }];
        let sample = Sample { time, is_first: self.is_first_sample, acting_voltage };
        self.is_first_sample = false;
        self.controller.tick(values, sample, sink);
    }
}

impl<C: ObserverAndLaw<N>, const N: usize> Default for SampledController<C, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<C: ObserverAndLaw<N>, const N: usize> Model for SampledController<C, N> {
    fn description(&self) -> &'static Description {
        C::DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn apply_tunable_parameters(&mut self) {
        self.controller.apply_tunable_parameters(&self.values);
    }

    fn check_parameters(&self) -> Result<(), ModelError> {
        C::check_parameters(&self.values)
    }

    fn initialise(&mut self, start_time: f64) -> Result<(), ModelError> {
        let (values, rows) = (&mut self.values, Self::ROWS);
        let sample_time = values[rows.sample_time];
        self.clock = SampleClock::starting(sample_time, start_time)?;
        self.start_delay = StartDelay::new(start_time, values[rows.start_delay], sample_time);
        self.is_first_sample = true;
        values[TIME] = start_time;
        values[rows.tick_time] = start_time;
        self.controller.initialise(values);
        Ok(())
    }

    #[inline]
    fn check_step(&self, duration: f64) -> Result<(), ModelError> {
        self.require_acceptable_step(duration)
    }

    fn advance(&mut self, duration: f64, sink: &mut dyn LogSink) -> Result<(), ModelError> {
        self.check_step(duration)?;
        for k in self.clock.advance(duration) {
            self.tick_at(self.clock.time_of(k), sink);
        }
        Ok(())
    }

    fn sampled(&mut self) -> Option<&mut dyn SampledModel> {
        Some(self)
    }

    fn is_consistent(&self, is_initialised: bool) -> bool {
        !is_initialised
            || self.clock.is_valid_for(self.values[Self::ROWS.sample_time])
                && self.controller.is_consistent(&self.values)
    }
}

impl<C: ObserverAndLaw<N>, const N: usize> SampledModel for SampledController<C, N> {
    fn clock(&self) -> &SampleClock {
        &self.clock
    }

    fn clock_mut(&mut self) -> &mut SampleClock {
        &mut self.clock
    }

    fn tick(&mut self, time: f64, sink: &mut dyn LogSink) {
        self.tick_at(time, sink);
    }

    fn longest_step(&self) -> f64 {
        self.values[Self::ROWS.longest_step]
    }

    fn cost_of_tick(&self) -> f64 {
        C::cost_of_tick(&self.values)
    }
}
