//! The observers that are compared, each tuned for the same objective on the same data, and how they fare on other data.

use rayon::prelude::*;

use crate::causes::with_causes;
use crate::observer::gauss_newton::GaussNewtonSettings;
use crate::observer::rig_kalman::RigKalmanSettings;
use crate::observer::rig_measurement::Measurement;
use crate::observer::rig_model::DisturbedRig;
use crate::observer::rig_observer::{RigEstimatorSettings, RigObserver, RigObserverSettings, RigStart};
use crate::observer::sampled_extended_state::{ExtendedStateSettings, Form};
use crate::study::StudyError;
use crate::study::report::quantity;
use crate::study::rig::recording::{Conditions, RIG, Recording, Reference, SAMPLE_TIME, SENSOR, SET_POINT};
use crate::study::tuning::candidate::{Candidate, SearchSpace, TABLE_3, TABLE_4};
use crate::study::tuning::noise_aware::{NOISES, NoiseAware, settings};
use crate::study::tuning::settings::SwarmSettings;
use crate::study::tuning::swarm::minimise;

/// Noise that the Kalman filter assumes \[V\], whatever the sensor's is: as all others, it is tuned once.
const ASSUMED_NOISE: f64 = 1e-3;
/// The rig as the model-based observers know it, with the printed mass.
const MODEL: DisturbedRig = DisturbedRig { rig: RIG, sample_time: SAMPLE_TIME };
/// Gauss-Newton iterations per sample.
const ITERATIONS: u32 = 3;
/// First sample that is scored.
const SCORED_FROM: usize = 500;
/// \[s\]
const DURATION: f64 = 4.0;
/// Seeds, none of which tuning saw.
const SEEDS: core::ops::Range<u64> = 1001..1006;

/// An observer with its parameters.
pub struct ObserverCandidate {
    pub name: &'static str,
    /// What was tuned and what came out.
    pub tuning: String,
    pub parameters: RigEstimatorSettings,
}

/// rms (x' - estimate) \[m/s\] of an observer in sensor volts, from a steady start, over a recording from sample `scored_from`
/// on; `None` if it is not finite.
pub fn velocity_error(
    estimator: RigEstimatorSettings,
    recording: &Recording,
    scored_from: usize,
) -> Option<f64> {
    let input_gain = match &estimator {
        RigEstimatorSettings::ExtendedState(settings) => settings.input_gain,
        // Of the extended state, which is not looked at.
        RigEstimatorSettings::Kalman(_) | RigEstimatorSettings::WindowedNewton(..) => 1.0,
    };
    let settings = RigObserverSettings { measurement: Measurement::Volts(SENSOR), input_gain, estimator };
    let held = RIG.operating_voltage(SET_POINT);
    let mut observer = RigObserver::new(settings, RigStart::Held(SENSOR.voltage(SET_POINT), held));
    let (mut sum, mut count, mut acted) = (0.0, 0.0, held);
    for (sample, (measured, voltage)) in recording.sensor_voltage.iter().zip(&recording.voltage).enumerate() {
        let estimate = observer.update(*measured, acted).state;
        let error = recording.velocity[sample] - estimate.velocity / SENSOR.gain;
        acted = *voltage;
        if sample >= scored_from {
            sum += error * error;
            count += 1.0;
        }
    }
    let error = libm::sqrt(sum / count);
    error.is_finite().then_some(error)
}

fn error(parameters: RigEstimatorSettings, recording: &Recording) -> Option<f64> {
    velocity_error(parameters, recording, SCORED_FROM)
}

/// The Kalman filter that assumes a disturbance of this intensity \[m/s2 after a second\] and a sensor noise \[V\].
fn kalman_settings(intensity: f64, sensor_noise: f64) -> RigEstimatorSettings {
    RigEstimatorSettings::Kalman(RigKalmanSettings {
        model: MODEL,
        position_noise: sensor_noise / SENSOR.gain,
        disturbance_noise: Some(intensity),
    })
}

/// The windowed observer, with or without a disturbance.
fn newton_settings(window: usize, with_disturbance: bool) -> RigEstimatorSettings {
    let estimated_states = if with_disturbance { 3 } else { 2 };
    let settings = GaussNewtonSettings { window, max_iterations: ITERATIONS, estimated_states };
    RigEstimatorSettings::WindowedNewton(MODEL, settings)
}

/// All candidates, tuned.
pub fn candidates() -> Result<Vec<ObserverCandidate>, StudyError> {
    let data = NoiseAware::new(&NOISES);
    let printed = |name, candidate: &Candidate, table: &str| ObserverCandidate {
        name,
        tuning: format!("as printed in {table}"),
        parameters: RigEstimatorSettings::ExtendedState(settings(candidate)),
    };
    Ok(vec![
        printed("LESO, Table 3", &TABLE_3, "Table 3"),
        printed("NESO, Table 4", &TABLE_4, "Table 4"),
        extended_state("LESO", SearchSpace::LogarithmicBandwidthAndGain, Form::Predictor, &data)?,
        extended_state("LESO, current form", SearchSpace::LogarithmicBandwidthAndGain, Form::Current, &data)?,
        extended_state("NESO", SearchSpace::TiedNonlinear, Form::Predictor, &data)?,
        kalman(&data),
        newton("Newton", false, &data),
        newton("Newton with disturbance", true, &data),
    ])
}

fn extended_state(
    name: &'static str,
    space: SearchSpace,
    form: Form,
    data: &NoiseAware,
) -> Result<ObserverCandidate, StudyError> {
    let observer = |candidate: &Candidate| {
        RigEstimatorSettings::ExtendedState(ExtendedStateSettings { form, ..settings(candidate) })
    };
    let cost = |position: &[f64]| {
        space.candidate(position).map_or(f64::INFINITY, |candidate| {
            let parameters = observer(&candidate);
            data.mean(|recording| error(parameters, recording))
        })
    };
    let failed = |reason: String| StudyError::Search { reason };
    let optimum = minimise(cost, space.bounds(), &SwarmSettings::FALLING_INERTIA, |_| ())
        .map_err(|error| failed(with_causes(&*error)))?;
    let candidate =
        space.candidate(&optimum.position).ok_or_else(|| failed("nothing was found".to_owned()))?;
    let tuning = match candidate {
        Candidate::Linear { bandwidth, input_gain } => {
            format!("swarm: wo = {}, b = {input_gain:.0}", quantity(bandwidth, "rad/s"))
        }
        Candidate::Nonlinear { gains, input_gain, exponents, linear_zones } => format!(
            "swarm: wo = {}, b = {input_gain:.0}, alpha2 = {:.2}, alpha3 = {:.2}, delta = {}",
            quantity(gains[0] / 3.0, "rad/s"),
            exponents[1],
            exponents[2],
            quantity(linear_zones[0], "V")
        ),
    };
    Ok(ObserverCandidate { name, tuning, parameters: observer(&candidate) })
}

/// The best of a list of parameters.
fn best<T: Copy + Send + Sync>(
    choices: Vec<T>,
    data: &NoiseAware,
    of: impl Fn(T) -> RigEstimatorSettings + Sync,
) -> Option<T> {
    let costs: Vec<(T, f64)> = choices
        .into_par_iter()
        .map(|choice| (choice, data.mean(|recording| error(of(choice), recording))))
        .collect();
    costs.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(choice, _)| choice)
}

fn kalman(data: &NoiseAware) -> ObserverCandidate {
    let choices = (0..=20).map(|step| libm::pow(10.0, -1.0 + 0.2 * f64::from(step))).collect();
    let intensity =
        best(choices, data, |intensity| kalman_settings(intensity, ASSUMED_NOISE)).unwrap_or(10.0);
    ObserverCandidate {
        name: "Kalman with disturbance",
        tuning: format!("grid: q = {}, assumes 1 mV", quantity(intensity, "m/s2/√s")),
        parameters: kalman_settings(intensity, ASSUMED_NOISE),
    }
}

fn newton(name: &'static str, with_disturbance: bool, data: &NoiseAware) -> ObserverCandidate {
    let choices = vec![4, 6, 8, 12, 16, 20, 24, 32, 48];
    let window = best(choices, data, |window| newton_settings(window, with_disturbance)).unwrap_or(8);
    ObserverCandidate {
        name,
        tuning: format!("grid: window of {window} samples"),
        parameters: newton_settings(window, with_disturbance),
    }
}

/// Conditions under which the observers are scored.
#[derive(Clone, Copy, Debug)]
pub struct Test {
    /// \[V\]
    pub noise: f64,
    pub mass_ratio: f64,
}

pub const TESTS: [Test; 6] = [
    Test { noise: 0.0, mass_ratio: 1.0 },
    Test { noise: 1e-4, mass_ratio: 1.0 },
    Test { noise: 1e-3, mass_ratio: 1.0 },
    Test { noise: 3e-3, mass_ratio: 1.0 },
    Test { noise: 1e-3, mass_ratio: 1.2 },
    Test { noise: 1e-3, mass_ratio: 0.8 },
];

impl Test {
    pub fn name(&self) -> String {
        let noise = if self.noise == 0.0 { "no noise".to_owned() } else { quantity(1e3 * self.noise, "mV") };
        match self.mass_ratio {
            1.0 => noise,
            ratio => format!("{noise}, mass {:+.0} %", 100.0 * (ratio - 1.0)),
        }
    }
}

/// rms velocity errors \[m/s\], `[test][candidate]`; infinite where an observer diverges.
pub fn scores(candidates: &[ObserverCandidate]) -> Vec<Vec<f64>> {
    TESTS
        .par_iter()
        .map(|test| {
            let recordings: Vec<Recording> = SEEDS
                .map(|seed| {
                    Recording::make(&Conditions {
                        noise: test.noise,
                        mass_ratio: test.mass_ratio,
                        seed,
                        disturbance_step: (1.0, 1.0),
                        ..Conditions::new(Reference::SineAndStep, DURATION)
                    })
                })
                .collect();
            candidates
                .iter()
                .map(|candidate| {
                    let squares: Option<f64> = recordings
                        .iter()
                        .map(|recording| error(candidate.parameters, recording).map(|error| error * error))
                        .sum();
                    squares.map_or(f64::INFINITY, |sum| libm::sqrt(sum / recordings.len() as f64))
                })
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn model_based_observers_are_exact_without_noise_and_error() {
        let recording = Recording::make(&Conditions::new(Reference::SineAndStep, 3.0));
        let kalman = error(kalman_settings(100.0, 1e-6), &recording).unwrap();
        let newton = error(newton_settings(8, false), &recording).unwrap();
        let disturbed = error(newton_settings(12, true), &recording).unwrap();
        for error in [kalman, newton, disturbed] {
            assert!(error < 2e-5, "{kalman:e} {newton:e} {disturbed:e}");
        }
    }

    #[test]
    fn disturbance_states_bear_a_wrong_mass() {
        let heavy = Conditions { mass_ratio: 1.2, ..Conditions::new(Reference::SineAndStep, 3.0) };
        let recording = Recording::make(&heavy);
        let without = error(newton_settings(8, false), &recording).unwrap();
        let with = error(newton_settings(8, true), &recording).unwrap();
        let kalman = error(kalman_settings(100.0, 1e-5), &recording).unwrap();
        assert!(without > 5.0 * with && without > 5.0 * kalman, "{without:e} {with:e} {kalman:e}");
    }
}
