//! Observer and law of the levitated ball.

use super::parameters::{check_prefilters, initial_estimate, law, observer_settings};
use super::table::*;
use crate::controller::ball_feedback_linearisation::BallFeedbackLinearisation;
use crate::controller::saturate;
use crate::model::controller_choices::Feedback;
use crate::model::sampled_controller::{ObserverAndLaw, Sample, SampledController};
use crate::model::{Description, LogSink, ModelError, Topic};
use crate::observer::ball_observer::{BallEstimate, BallObserver};
use crate::plant::levitated_ball::State;
use crate::signal::{BallReferenceFilter, SmoothReference};
use serde::{Deserialize, Serialize};

/// The controller as a model.
pub type LevitatedBallController = SampledController<BallObserverAndLaw, COUNT>;

/// What a tick costs at most \[s\], see [`crate::model::work`].
const COST_OF_TICK: f64 = 0.8e-6;

/// What observer, reference filter and law remember from tick to tick.
#[derive(Clone, Serialize, Deserialize)]
pub struct BallObserverAndLaw {
    law: BallFeedbackLinearisation,
    reference: BallReferenceFilter,
    observer: BallObserver,
}

/// Sets the outputs that describe observer and reference.
#[inline]
fn publish(estimate: &BallEstimate, reference: SmoothReference, values: &mut [f64; COUNT]) {
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

impl ObserverAndLaw<COUNT> for BallObserverAndLaw {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    fn new(values: &[f64; COUNT]) -> Self {
        Self {
            law: law(values),
            reference: BallReferenceFilter::new(values[INITIAL_REFERENCE]),
            observer: BallObserver::new(observer_settings(values), initial_estimate(values)),
        }
    }

    fn check_parameters(values: &[f64; COUNT]) -> Result<(), ModelError> {
        check_prefilters(values)
    }

    fn apply_tunable_parameters(&mut self, values: &[f64; COUNT]) {
        self.observer.apply_settings(observer_settings(values));
        self.law = law(values);
    }

    fn initialise(&mut self, values: &mut [f64; COUNT]) {
        *self = Self::new(values);
        values[VOLTAGE_OUTPUT] = 0.0;
        let estimate = self.observer.start(values[CURRENT_INPUT]);
        publish(&estimate, self.reference.output(values[REFERENCE_FILTER]), values);
    }

    #[inline]
    fn tick(&mut self, values: &mut [f64; COUNT], sample: Sample, sink: &mut dyn LogSink) {
        let (current, rate) = (values[CURRENT_INPUT], values[REFERENCE_FILTER]);
        let estimate = if sample.is_first {
            self.reference.present(values[REFERENCE]);
            self.observer.start(current)
        } else {
            self.reference.update(values[REFERENCE], rate, values[SAMPLE_TIME]);
            self.observer.update(current, sample.acting_voltage)
        };
        if estimate.restarted && sink.enabled(Topic::Observer) {
            log_restart(current, sample, sink);
        }
        let reference = self.reference.output(rate);
        let fed_back = if Feedback::State.is(values[CONTROLLER_FEEDBACK]) {
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
        publish(&estimate, reference, values);
    }

    fn is_consistent(&self, values: &[f64; COUNT]) -> bool {
        self.observer.belongs_to(&observer_settings(values)) && self.reference.is_consistent()
    }

    fn cost_of_tick(_: &[f64; COUNT]) -> f64 {
        COST_OF_TICK
    }
}

#[cold]
fn log_restart(current: f64, sample: Sample, sink: &mut dyn LogSink) {
    let Sample { time, acting_voltage, .. } = sample;
    sink.log(
        Topic::Observer,
        format_args!(
            "t = {time} s: the observer diverged and is reset, at a current of {current:e} A and a voltage of \
             {acting_voltage:e} V"
        ),
    );
}
