//! An objective for the work an observer is for: velocity under sensor noise, with a ball that is not quite as heavy as
//! thought, while the reference moves and a force steps.
//!
//! ```text
//! E = geometric mean over all runs of rms (x' - z2 / k2)        [m/s]
//! ```
//!
//! so that each run counts by the factor, not by the amount, in which an observer is better. Position in sensor volts,
//! and each observer as the controller model runs it: linear exact, nonlinear by Runge-Kutta with the measurement held, both
//! from a steady start. Not from the paper.

use super::candidate::Candidate;
use super::paper_objective::DIVERGED;
use crate::observer::extended_state::{ExtendedState, LinearInjection, NonlinearInjection};
use crate::observer::sampled_extended_state::{
    Discretisation, ExtendedStateObserver, ExtendedStateSettings, Form, InjectionChoice,
};
use crate::study::rig::recording::{Conditions, RIG, Recording, Reference, SAMPLE_TIME, SENSOR, SET_POINT};

/// Standard deviations of the sensor \[V\] unless told otherwise.
pub const NOISES: [f64; 4] = [1e-4, 3e-4, 1e-3, 3e-3];
const MASS_RATIOS: [f64; 3] = [0.8, 1.0, 1.2];
const REFERENCES: [Reference; 2] = [Reference::SineAndStep, Reference::FastSine];
/// \[s\]
const DURATION: f64 = 3.0;
/// First sample that counts: a ball of another mass does not start at rest.
const SCORED_FROM: usize = 500;
/// 1 m/s2 from 1 s on.
const DISTURBANCE_STEP: (f64, f64) = (1.0, 1.0);

/// All runs.
pub struct NoiseAware {
    recordings: Vec<Recording>,
}

impl NoiseAware {
    /// Runs for these standard deviations of the sensor \[V\].
    pub fn new(noises: &[f64]) -> Self {
        let mut recordings = Vec::new();
        for &noise in noises {
            for mass_ratio in MASS_RATIOS {
                for reference in REFERENCES {
                    let seed = recordings.len() as u64;
                    recordings.push(Recording::make(&Conditions {
                        mass_ratio,
                        noise,
                        seed,
                        disturbance_step: DISTURBANCE_STEP,
                        ..Conditions::new(reference, DURATION)
                    }));
                }
            }
        }
        Self { recordings }
    }

    /// E \[m/s\]; [`DIVERGED`] if a run diverges.
    pub fn cost(&self, candidate: &Candidate) -> f64 {
        let settings = settings(candidate);
        self.mean(|recording| velocity_error(&settings, recording))
    }

    /// Geometric mean of an error over all runs; [`DIVERGED`] if one has none.
    pub fn mean(&self, error: impl Fn(&Recording) -> Option<f64>) -> f64 {
        let logarithms = self.recordings.iter().map(|recording| error(recording).map(libm::log));
        let sum: Option<f64> = logarithms.sum();
        sum.map_or(DIVERGED, |sum| libm::exp(sum / self.recordings.len() as f64))
    }
}

/// The observer as the controller model runs it by default, in volts.
pub fn settings(candidate: &Candidate) -> ExtendedStateSettings {
    let (injection, input_gain, discretisation) = match *candidate {
        Candidate::Linear { bandwidth, input_gain } => (
            InjectionChoice::Linear(LinearInjection::from_bandwidth(bandwidth)),
            input_gain,
            Discretisation::Exact,
        ),
        Candidate::Nonlinear { gains, input_gain, exponents, linear_zones } => (
            InjectionChoice::Nonlinear(NonlinearInjection::new(gains, exponents, linear_zones)),
            input_gain,
            Discretisation::RungeKutta(1),
        ),
    };
    ExtendedStateSettings {
        injection,
        input_gain,
        discretisation,
        form: Form::Predictor,
        sample_time: SAMPLE_TIME,
    }
}

/// rms (x' - z2 / k2) \[m/s\] over the scored part of a recording; `None` if the observer diverges.
pub fn velocity_error(settings: &ExtendedStateSettings, recording: &Recording) -> Option<f64> {
    // Its operating voltage is that of the printed mass.
    let steady = ExtendedState {
        position: recording.sensor_voltage.first().copied().unwrap_or_default(),
        velocity: 0.0,
        extended: -settings.input_gain * RIG.operating_voltage(SET_POINT),
    };
    let mut observer = ExtendedStateObserver::new(*settings, steady);
    let mut acted = 0.0;
    let (mut sum, mut count) = (0.0, 0.0);
    for (sample, (measurement, voltage)) in
        recording.sensor_voltage.iter().zip(&recording.voltage).enumerate()
    {
        let estimate = observer.update(*measurement, acted);
        if estimate.restarted {
            return None;
        }
        acted = *voltage;
        if sample >= SCORED_FROM {
            let error = recording.velocity[sample] - estimate.state.velocity / SENSOR.gain;
            sum += error * error;
            count += 1.0;
        }
    }
    Some((sum / count).sqrt())
}
