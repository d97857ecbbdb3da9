//! Exported unit `MagneticBearingController`: observers and control laws as a sampled-data system.

mod parameters;
mod table;

use parameters::{cost_of_tick, initial_estimate, law, observer_settings};
pub use table::DESCRIPTION;
use table::*;

use super::sample_clock::SampleClock;
use super::sampled::SampledUnit;
use super::start_delay::StartDelay;
use super::{Description, Journal, Topic, Unit, UnitError, start_values};
use crate::controller::{BearingLaw, saturate};
use crate::observer::{BearingObserver, Estimate};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// The controller as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct MagneticBearingController {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    clock: SampleClock,
    start_delay: StartDelay,
    law: BearingLaw,
    feeds_back_state: bool,
    hears_applied_voltage: bool,
    /// Whether the first tick, which puts out u(0), is still to come.
    awaits_first_tick: bool,
    observer: BearingObserver,
}

impl MagneticBearingController {
    /// The controller with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            clock: SampleClock::new(values[SAMPLE_TIME], 0.0),
            start_delay: StartDelay::new(0.0, values[START_DELAY], values[SAMPLE_TIME]),
            law: law(&values),
            feeds_back_state: values[CONTROLLER_FEEDBACK] == STATE,
            hears_applied_voltage: values[OBSERVER_VOLTAGE_SOURCE] == APPLIED,
            awaits_first_tick: true,
            observer: BearingObserver::new(observer_settings(&values), initial_estimate(&values)),
            values,
        }
    }

    /// Reads the inputs, runs the observer, then the law, and sets the outputs.
    #[inline]
    fn tick_at(&mut self, time: f64, journal: &mut dyn Journal) {
        if self.start_delay.covers(time) {
            return;
        }
        let values = &mut self.values;
        values[TICK_TIME] = time;
        let acted = if self.hears_applied_voltage { values[VOLTAGE_APPLIED] } else { values[VOLTAGE_OUTPUT] };
        let estimate = self.observer.update(values[POSITION], acted);

        let fed_back = if self.feeds_back_state {
            State { position: values[POSITION], velocity: values[STATE_VELOCITY], flux: values[STATE_FLUX] }
        } else {
            // The laws use the measured position, not its estimate.
            State { position: values[POSITION], ..estimate.state }
        };
        let wanted =
            if self.awaits_first_tick { values[INITIAL_VOLTAGE] } else { self.law.voltage(fed_back) };
        self.awaits_first_tick = false;
        values[VOLTAGE_OUTPUT] = saturate(wanted, values[VOLTAGE_LIMIT], values[VOLTAGE_OUTPUT]);
        values[OBSERVER_RESIDUAL] = estimate.residual;
        values[OBSERVER_ITERATIONS] = f64::from(estimate.iterations);
        let converged = f64::from(u8::from(estimate.converged));
        if converged != values[OBSERVER_CONVERGED] && journal.wants(Topic::Observer) {
            note_convergence(values[TICK_TIME], &estimate, journal);
        }
        values[OBSERVER_CONVERGED] = converged;
        self.publish(estimate.state);
    }

    /// Sets the outputs that describe the observer's state.
    #[inline]
    fn publish(&mut self, estimate: State) {
        let values = &mut self.values;
        values[ESTIMATE_POSITION] = estimate.position;
        values[ESTIMATE_VELOCITY] = estimate.velocity;
        values[ESTIMATE_FLUX] = estimate.flux;
        if let Some(deviation) = self.observer.deviation() {
            values[POSITION_DEVIATION] = deviation.position;
            values[VELOCITY_DEVIATION] = deviation.velocity;
            values[FLUX_DEVIATION] = deviation.flux;
        }
    }
}

#[cold]
fn note_convergence(time: f64, estimate: &Estimate, journal: &mut dyn Journal) {
    let verb = if estimate.converged { "converged" } else { "did not converge" };
    journal.note(
        Topic::Observer,
        format_args!(
            "t = {time} s: the observer {verb} after {} iterations, residual {:e} m",
            estimate.iterations, estimate.residual
        ),
    );
}

impl Default for MagneticBearingController {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for MagneticBearingController {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn adopt_parameters(&mut self) {
        self.observer.adopt(observer_settings(&self.values));
        self.law = law(&self.values);
        self.feeds_back_state = self.values[CONTROLLER_FEEDBACK] == STATE;
        self.hears_applied_voltage = self.values[OBSERVER_VOLTAGE_SOURCE] == APPLIED;
    }

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        self.adopt_parameters();
        let values = &mut self.values;
        let initial = initial_estimate(values);
        self.clock = SampleClock::starting(values[SAMPLE_TIME], start_time)?;
        self.start_delay = StartDelay::new(start_time, values[START_DELAY], values[SAMPLE_TIME]);
        self.observer = BearingObserver::new(observer_settings(values), initial);
        self.awaits_first_tick = true;
        values[TIME] = start_time;
        values[TICK_TIME] = start_time;
        for output in [
            VOLTAGE_OUTPUT,
            OBSERVER_RESIDUAL,
            OBSERVER_ITERATIONS,
            OBSERVER_CONVERGED,
            POSITION_DEVIATION,
            VELOCITY_DEVIATION,
            FLUX_DEVIATION,
        ] {
            values[output] = 0.0;
        }
        self.publish(initial);
        Ok(())
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        self.require_acceptable_step(duration)?;
        for k in self.clock.advance(duration) {
            self.tick_at(self.clock.time_of(k), journal);
        }
        Ok(())
    }

    fn sampled(&mut self) -> Option<&mut dyn SampledUnit> {
        Some(self)
    }

    fn is_consistent(&self) -> bool {
        self.clock.may_stand_where_it_does(self.values[SAMPLE_TIME])
            && self.observer.settings() == observer_settings(&self.values)
            && self.law == law(&self.values)
    }
}

impl SampledUnit for MagneticBearingController {
    fn clock(&self) -> &SampleClock {
        &self.clock
    }

    fn clock_mut(&mut self) -> &mut SampleClock {
        &mut self.clock
    }

    fn tick(&mut self, time: f64, journal: &mut dyn Journal) {
        self.tick_at(time, journal);
    }

    fn longest_step(&self) -> f64 {
        self.values[LONGEST_STEP]
    }

    fn cost_of_tick(&self) -> f64 {
        cost_of_tick(&self.values)
    }
}
