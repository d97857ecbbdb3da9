//! A search: what is to be small, and what was found.

use super::candidate::{Candidate, Model, ObserverKind, SearchSpace, TABLE_3, TABLE_4};
use super::noise_aware::NoiseAware;
use super::paper_objective;
use super::settings::SwarmSettings;
use super::swarm::{Iteration, Optimum, minimise};
use crate::causes::with_causes;
use crate::host::Value;
use crate::study::StudyError;
use crate::study::loop_packages::Parameter;
use crate::study::rig::recording::{Conditions, Recording, Reference};

/// What is to be small.
pub enum Objective {
    /// (15) over the sine of the reference, 2 s, see [`paper_objective`].
    Paper(Recording),
    /// See [`super::noise_aware`].
    NoiseAware(NoiseAware),
}

impl Objective {
    /// The paper's, on the recording on which the reconstruction measured it.
    pub fn paper() -> Self {
        Self::Paper(Recording::make(&Conditions::new(Reference::SineAndStep, 2.0)))
    }

    /// Velocity under these standard deviations of the sensor \[V\].
    pub fn noise_aware(noises: &[f64]) -> Self {
        Self::NoiseAware(NoiseAware::new(noises))
    }

    /// Symbol and unit. Summands of J are in m and m/s, without weights, so J has none.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Paper(_) => "J of (15)",
            Self::NoiseAware(_) => "E, mean velocity error [m/s]",
        }
    }

    /// Where the search takes place.
    pub fn space(&self, observer: ObserverKind) -> SearchSpace {
        match (self, observer) {
            (Self::Paper(_), ObserverKind::Linear) => SearchSpace::BandwidthAndGain,
            (Self::Paper(_), ObserverKind::Nonlinear) => SearchSpace::EverythingNonlinear,
            (Self::NoiseAware(_), ObserverKind::Linear) => SearchSpace::LogarithmicBandwidthAndGain,
            (Self::NoiseAware(_), ObserverKind::Nonlinear) => SearchSpace::TiedNonlinear,
        }
    }

    pub fn cost(&self, candidate: &Candidate) -> f64 {
        match self {
            Self::Paper(recording) => match candidate.model() {
                Model::Linear(model) => paper_objective::cost(&model, recording),
                Model::Nonlinear(model) => paper_objective::cost(&model, recording),
            },
            Self::NoiseAware(runs) => runs.cost(candidate),
        }
    }

    /// Parameters of the controller model with which it runs the observer as this objective does.
    fn surroundings(&self, observer: ObserverKind) -> Vec<Parameter<'static>> {
        let discretisation = match (self, observer) {
            (Self::NoiseAware(_), ObserverKind::Linear) => "exact",
            _ => "runge_kutta",
        };
        let (measurement, initial, form) = match self {
            Self::Paper(_) => ("metres", "zero", "current"),
            Self::NoiseAware(_) => ("volts", "steady", "predictor"),
        };
        vec![
            ("observer.measurement", Value::Text(measurement)),
            ("observer.initial", Value::Text(initial)),
            ("observer.discretisation", Value::Text(discretisation)),
            ("observer.form", Value::Text(form)),
            ("observer.substeps", Value::Integer(1)),
        ]
    }
}

/// A search and what it found.
pub struct Tuned {
    pub candidate: Candidate,
    pub optimum: Optimum,
    /// The objective with Table 3 or 4.
    pub printed_cost: f64,
    /// Of the controller model.
    pub parameters: Vec<Parameter<'static>>,
}

/// Searches; `watch` sees every iteration.
pub fn tune(
    observer: ObserverKind,
    objective: &Objective,
    settings: &SwarmSettings,
    watch: impl FnMut(&Iteration),
) -> Result<Tuned, StudyError> {
    let space = objective.space(observer);
    let cost = |position: &[f64]| {
        space.candidate(position).map_or(f64::INFINITY, |candidate| objective.cost(&candidate))
    };
    let failed = |reason: String| StudyError::Search { reason };
    let optimum =
        minimise(cost, space.bounds(), settings, watch).map_err(|error| failed(with_causes(&*error)))?;
    let candidate =
        space.candidate(&optimum.position).ok_or_else(|| failed("nothing was found".to_owned()))?;
    let printed = match observer {
        ObserverKind::Linear => TABLE_3,
        ObserverKind::Nonlinear => TABLE_4,
    };
    let mut parameters = candidate.parameters();
    parameters.extend(objective.surroundings(observer));
    Ok(Tuned { candidate, optimum, printed_cost: objective.cost(&printed), parameters })
}
