//! Tuning of the maglev rig's observers by particle swarm.

pub mod candidate;
pub mod paper_objective;
pub mod settings;
pub mod swarm;

use candidate::{Candidate, Model};
use crate::study::rig::recording::Recording;

/// J of (15) of a candidate.
pub fn paper_cost(candidate: &Candidate, recording: &Recording) -> f64 {
    match candidate.model() {
        Model::Linear(model) => paper_objective::cost(&model, recording),
        Model::Nonlinear(model) => paper_objective::cost(&model, recording),
    }
}
