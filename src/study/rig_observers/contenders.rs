//! The observers that are compared, each tuned for the same objective on the same data, and how they fare on other data.

use rayon::prelude::*;

use super::estimators::{DisturbanceKalman, ExtendedStateEstimator, WindowedNewton, velocity_error};
use crate::causes::with_causes;
use crate::observer::sampled_extended_state::{ExtendedStateSettings, Form};
use crate::study::StudyError;
use crate::study::report::quantity;
use crate::study::rig::recording::{Conditions, Recording, Reference};
use crate::study::tuning::candidate::{Candidate, SearchSpace, TABLE_3, TABLE_4};
use crate::study::tuning::noise_aware::{NOISES, NoiseAware, settings};
use crate::study::tuning::settings::SwarmSettings;
use crate::study::tuning::swarm::minimise;

/// Noise that the Kalman filter assumes \[V\], whatever the sensor's is: as all others, it is tuned once.
const ASSUMED_NOISE: f64 = 1e-3;
/// First sample that is scored.
const SCORED_FROM: usize = 500;
/// \[s\]
const DURATION: f64 = 4.0;
/// Seeds, none of which tuning saw.
const SEEDS: core::ops::Range<u64> = 1001..1006;

/// An observer with its parameters.
#[derive(Clone, Copy, Debug)]
pub enum Parameters {
    ExtendedState(ExtendedStateSettings),
    /// q of the disturbance's random walk.
    Kalman(f64),
    /// Samples, and whether a disturbance is estimated.
    Newton(usize, bool),
}

pub struct Contender {
    pub name: &'static str,
    /// What was tuned and what came out.
    pub tuning: String,
    pub parameters: Parameters,
}

/// Velocity error of an observer over a recording \[m/s\].
fn error(parameters: &Parameters, recording: &Recording) -> Option<f64> {
    match *parameters {
        Parameters::ExtendedState(settings) => {
            velocity_error(ExtendedStateEstimator::new(settings), recording, SCORED_FROM)
        }
        Parameters::Kalman(intensity) => {
            velocity_error(DisturbanceKalman::new(intensity, ASSUMED_NOISE), recording, SCORED_FROM)
        }
        Parameters::Newton(window, with_disturbance) => {
            velocity_error(WindowedNewton::new(window, with_disturbance), recording, SCORED_FROM)
        }
    }
}

/// All contenders, tuned.
pub fn contenders() -> Result<Vec<Contender>, StudyError> {
    let data = NoiseAware::new(&NOISES);
    let printed = |name, candidate: &Candidate, table: &str| Contender {
        name,
        tuning: format!("as printed in {table}"),
        parameters: Parameters::ExtendedState(settings(candidate)),
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
) -> Result<Contender, StudyError> {
    let observer = |candidate: &Candidate| {
        Parameters::ExtendedState(ExtendedStateSettings { form, ..settings(candidate) })
    };
    let cost = |position: &[f64]| {
        space.candidate(position).map_or(f64::INFINITY, |candidate| {
            let parameters = observer(&candidate);
            data.mean(|recording| error(&parameters, recording))
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
    Ok(Contender { name, tuning, parameters: observer(&candidate) })
}

/// The best of a list of parameters.
fn best<T: Copy + Send + Sync>(
    choices: Vec<T>,
    data: &NoiseAware,
    of: impl Fn(T) -> Parameters + Sync,
) -> Option<T> {
    let costs: Vec<(T, f64)> = choices
        .into_par_iter()
        .map(|choice| (choice, data.mean(|recording| error(&of(choice), recording))))
        .collect();
    costs.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(choice, _)| choice)
}

fn kalman(data: &NoiseAware) -> Contender {
    let choices = (0..=20).map(|step| libm::pow(10.0, -1.0 + 0.2 * f64::from(step))).collect();
    let intensity = best(choices, data, Parameters::Kalman).unwrap_or(10.0);
    Contender {
        name: "Kalman with disturbance",
        tuning: format!("grid: q = {}, assumes 1 mV", quantity(intensity, "m/s2/√s")),
        parameters: Parameters::Kalman(intensity),
    }
}

fn newton(name: &'static str, with_disturbance: bool, data: &NoiseAware) -> Contender {
    let choices = vec![4, 6, 8, 12, 16, 20, 24, 32, 48];
    let window = best(choices, data, |window| Parameters::Newton(window, with_disturbance)).unwrap_or(8);
    Contender {
        name,
        tuning: format!("grid: window of {window} samples"),
        parameters: Parameters::Newton(window, with_disturbance),
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

/// rms velocity errors \[m/s\], `[test][contender]`; infinite where an observer diverges.
pub fn scores(contenders: &[Contender]) -> Vec<Vec<f64>> {
    TESTS
        .par_iter()
        .map(|test| {
            let recordings: Vec<Recording> = SEEDS
                .map(|seed| {
                    Recording::make(&Conditions {
                        noise: test.noise,
                        mass_ratio: test.mass_ratio,
                        seed,
                        push: (1.0, 1.0),
                        ..Conditions::new(Reference::SineAndStep, DURATION)
                    })
                })
                .collect();
            contenders
                .iter()
                .map(|contender| {
                    let squares: Option<f64> = recordings
                        .iter()
                        .map(|recording| error(&contender.parameters, recording).map(|error| error * error))
                        .sum();
                    squares.map_or(f64::INFINITY, |sum| libm::sqrt(sum / recordings.len() as f64))
                })
                .collect()
        })
        .collect()
}
