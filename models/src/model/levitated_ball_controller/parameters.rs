//! What the values of parameters mean to observer and law.

use super::table::*;
use crate::controller::ball_feedback_linearisation::BallFeedbackLinearisation;
use crate::model::ModelError;
use crate::observer::ball_observer::{Adaptation, BallObserverSettings, FluxEstimator, InitialBallEstimate};
use crate::observer::drem::MixingSettings;
use crate::plant::levitated_ball::LevitatedBall;

pub(super) fn observer_settings(values: &[f64; COUNT]) -> BallObserverSettings {
    let sample_time = values[SAMPLE_TIME];
    BallObserverSettings {
        ball: ball(values),
        sample_time,
        prefilters: [values[PREFILTER_1], values[PREFILTER_2]],
        filters: [values[FILTER_1], values[FILTER_2], values[FILTER_3], values[FILTER_4]],
        estimator: estimator(values),
        speed_rate: values[SPEED_RATE],
        position_rate: values[POSITION_RATE],
        // A quotient rounded up costs no sample; the cast saturates.
        held_samples: libm::ceil(values[STARTUP_HOLD] / sample_time * (1.0 - 1e-9)) as u32,
    }
}

fn estimator(values: &[f64; COUNT]) -> FluxEstimator {
    let gain = values[NEWTON_GAIN];
    match ObserverKind::from_number(values[OBSERVER]) {
        ObserverKind::PolynomialNewton => FluxEstimator::Newton { gain, adaptation: None },
        ObserverKind::PolynomialNewtonAdaptive => {
            let blamed = match AdaptationKind::from_number(values[ADAPTATION]) {
                AdaptationKind::Resistance => Adaptation::Resistance,
                AdaptationKind::VoltageOffset => Adaptation::VoltageOffset,
            };
            FluxEstimator::Newton { gain, adaptation: Some((blamed, values[ADAPTATION_GAIN])) }
        }
        ObserverKind::Drem => {
            let mixing = MixingSettings { gain: values[GAIN], excitation_scale: values[EXCITATION_SCALE] };
            match values[NORMALISATION] {
                0.0 => FluxEstimator::Mixing(mixing),
                level => FluxEstimator::NormalisedMixing { mixing, level },
            }
        }
    }
}

pub(super) fn initial_estimate(values: &[f64; COUNT]) -> InitialBallEstimate {
    InitialBallEstimate {
        flux: values[INITIAL_FLUX],
        flux_offset: values[INITIAL_OFFSET],
        velocity: values[INITIAL_VELOCITY],
        position: (values[INITIAL_FROM_CURRENT] == 0.0).then_some(values[INITIAL_POSITION]),
        filters_from_zero: values[FILTERS_FROM_ZERO] != 0.0,
    }
}

pub(super) fn law(values: &[f64; COUNT]) -> BallFeedbackLinearisation {
    BallFeedbackLinearisation { ball: ball(values), pole: values[POLE] }
}

fn ball(values: &[f64; COUNT]) -> LevitatedBall {
    LevitatedBall {
        mass: values[MASS],
        resistance: values[RESISTANCE],
        inductance_constant: values[INDUCTANCE_CONSTANT],
        gap: values[GAP],
        gravity: values[GRAVITY],
    }
}

/// Relative difference of the prefilters with which rounding begins to spoil the regression; at 1e-9 some digits are left.
const SMALLEST_DIFFERENCE: f64 = 1e-6;

/// The regression needs two different prefilters.
pub(super) fn check_prefilters(values: &[f64; COUNT]) -> Result<(), ModelError> {
    let difference = (values[PREFILTER_1] - values[PREFILTER_2]).abs();
    if difference > SMALLEST_DIFFERENCE * values[PREFILTER_1].max(values[PREFILTER_2]) {
        return Ok(());
    }
    let [first, second] = [PREFILTER_1, PREFILTER_2].map(|row| &VARIABLES[row]);
    let (value, unit) = (values[PREFILTER_1], first.unit());
    Err(ModelError::Equal { first: first.name, second: second.name, value, unit })
}
