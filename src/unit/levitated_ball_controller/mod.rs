//! Exported unit `LevitatedBallController`: sensorless observers and the feedback-linearising law as a sampled-data system.

mod parameters;
mod table;

use parameters::{check_prefilters, initial_estimate, law, observer_settings};
pub use table::DESCRIPTION;
use table::*;

use super::sample_clock::SampleClock;
use super::sampled::SampledUnit;
use super::start_delay::StartDelay;
use super::{Description, Journal, Topic, Unit, UnitError, start_values};
use crate::controller::ball_feedback_linearisation::BallFeedbackLinearisation;
use crate::controller::saturate;
use crate::observer::ball_observer::{BallEstimate, BallObserver};
use crate::plant::levitated_ball::State;
use crate::signal::{BallReferenceFilter, SmoothReference};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// What a tick costs at most \[s\], see [`super::work`].
const COST_OF_TICK: f64 = 0.8e-6;

/// The controller as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct LevitatedBallController {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    clock: SampleClock,
    start_delay: StartDelay,
    law: BallFeedbackLinearisation,
    awaits_first_tick: bool,
    reference: BallReferenceFilter,
    observer: BallObserver,
}

impl LevitatedBallController {
    /// The controller with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            clock: SampleClock::new(values[SAMPLE_TIME], 0.0),
            start_delay: StartDelay::new(0.0, values[START_DELAY], values[SAMPLE_TIME]),
            law: law(&values),
            awaits_first_tick: true,
            reference: BallReferenceFilter::new(values[INITIAL_REFERENCE]),
            observer: BallObserver::new(observer_settings(&values), initial_estimate(&values)),
            values,
        }
    }

    /// Reads the inputs, runs the observer, then the law, and sets the outputs.
    #[inline]
    fn tick_at(&mut self, time: f64, journal: &mut dyn Journal) {
        if self.start_delay.covers(time) {
            return;
        }
        self.values[TICK_TIME] = time;
        let values = &mut self.values;
        let (current, rate) = (values[CURRENT_INPUT], values[REFERENCE_FILTER]);
        let hears_applied_voltage = values[OBSERVER_VOLTAGE_SOURCE] == APPLIED;
        let acted = if hears_applied_voltage { values[VOLTAGE_APPLIED] } else { values[VOLTAGE_OUTPUT] };
        let estimate = if self.awaits_first_tick {
            self.reference.present(values[REFERENCE]);
            self.observer.start(current)
        } else {
            self.reference.update(values[REFERENCE], rate, values[SAMPLE_TIME]);
            self.observer.update(current, acted)
        };
        self.awaits_first_tick = false;
        if estimate.restarted && journal.wants(Topic::Observer) {
            note_restart(values[TICK_TIME], current, acted, journal);
        }

        let reference = self.reference.output(rate);
        let fed_back = if values[CONTROLLER_FEEDBACK] == STATE {
            State {
                position: values[STATE_POSITION],
                velocity: values[STATE_VELOCITY],
                flux: values[STATE_FLUX],
            }
        } else {
            estimate.state
        };
        self.law.ball.resistance = estimate.resistance;
        let wanted = self.law.voltage(fed_back, current, reference) - estimate.voltage_offset;
        values[VOLTAGE_OUTPUT] = saturate(wanted, values[VOLTAGE_LIMIT], values[VOLTAGE_OUTPUT]);
        self.publish(&estimate, reference);
    }

    /// Sets the outputs that describe observer and reference.
    #[inline]
    fn publish(&mut self, estimate: &BallEstimate, reference: SmoothReference) {
        let values = &mut self.values;
        values[ESTIMATE_FLUX] = estimate.state.flux;
        values[ESTIMATE_VELOCITY] = estimate.state.velocity;
        values[ESTIMATE_POSITION] = estimate.state.position;
        values[FLUX_OFFSET] = estimate.flux_offset;
        values[EXCITATION] = estimate.excitation;
        values[RESIDUAL] = estimate.residual;
        values[ESTIMATED_RESISTANCE] = estimate.resistance;
        values[ESTIMATED_OFFSET] = estimate.voltage_offset;
        values[ACTIVE] = f64::from(u8::from(estimate.active));
        values[REFERENCE_POSITION] = reference.position;
        values[REFERENCE_VELOCITY] = reference.velocity;
    }
}

#[cold]
fn note_restart(time: f64, current: f64, voltage: f64, journal: &mut dyn Journal) {
    journal.note(
        Topic::Observer,
        format_args!(
            "t = {time} s: the observer ran away and starts again, at a current of {current:e} A and a voltage of \
             {voltage:e} V"
        ),
    );
}

impl Default for LevitatedBallController {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for LevitatedBallController {
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
    }

    fn check_parameters(&self) -> Result<(), UnitError> {
        check_prefilters(&self.values)
    }

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        let values = &mut self.values;
        self.law = law(values);
        self.clock = SampleClock::starting(values[SAMPLE_TIME], start_time)?;
        self.start_delay = StartDelay::new(start_time, values[START_DELAY], values[SAMPLE_TIME]);
        self.reference = BallReferenceFilter::new(values[INITIAL_REFERENCE]);
        self.observer = BallObserver::new(observer_settings(values), initial_estimate(values));
        self.awaits_first_tick = true;
        values[TIME] = start_time;
        values[TICK_TIME] = start_time;
        values[VOLTAGE_OUTPUT] = 0.0;
        let estimate = self.observer.start(values[CURRENT_INPUT]);
        let reference = self.reference.output(values[REFERENCE_FILTER]);
        self.publish(&estimate, reference);
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
            && self.observer.belongs_to(&observer_settings(&self.values))
            && self.reference.is_consistent()
    }
}

impl SampledUnit for LevitatedBallController {
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
        COST_OF_TICK
    }
}
