//! The paper's tuning repeated: its objective with its swarm, and with swarms that settle.

use crate::study::metrics::{median, smallest};
use crate::study::tuning::candidate::ObserverKind;
use crate::study::tuning::settings::SwarmSettings;
use crate::study::tuning::{Objective, Tuned, convergence, tune};
use crate::study::{FigureWithData, StudyError};

pub const SWARMS: [(&str, SwarmSettings); 3] = [
    ("w = 1 as printed", SwarmSettings::PRINTED),
    ("w from 0.9 to 0.4", SwarmSettings::FALLING_INERTIA),
    ("constriction", SwarmSettings::CONSTRICTION),
];
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// All searches: `[observer][swarm][seed]`.
pub struct Searches {
    pub linear: Vec<Vec<Tuned>>,
    pub nonlinear: Vec<Vec<Tuned>>,
    /// J with Table 3 and with Table 4.
    pub printed: [f64; 2],
}

impl Searches {
    pub fn run() -> Result<Self, StudyError> {
        let objective = Objective::paper();
        let all = |observer| -> Result<Vec<Vec<Tuned>>, StudyError> {
            SWARMS
                .iter()
                .map(|(_, settings)| {
                    SEEDS
                        .iter()
                        .map(|seed| {
                            tune(observer, &objective, &SwarmSettings { seed: *seed, ..*settings }, |_| ())
                        })
                        .collect()
                })
                .collect()
        };
        let (linear, nonlinear) = (all(ObserverKind::Linear)?, all(ObserverKind::Nonlinear)?);
        let printed = [linear[0][0].printed_cost, nonlinear[0][0].printed_cost];
        Ok(Self { linear, nonlinear, printed })
    }

    /// The search for LESO with each swarm, first seed.
    pub fn figure(&self) -> FigureWithData {
        let searches: Vec<_> = SWARMS
            .iter()
            .zip(&self.linear)
            .map(|((name, _), seeds)| ((*name).to_owned(), seeds[0].optimum.history.as_slice()))
            .collect();
        convergence(
            "rig_swarm",
            "Particle swarm on the paper's objective, LESO: as printed, and such that it settles".to_owned(),
            "J of (15)",
            &searches,
            Some(self.printed[0]),
        )
    }
}

/// Smallest J of some searches.
pub fn best(searches: &[Tuned]) -> f64 {
    smallest(searches.iter().map(|tuned| tuned.optimum.cost))
}

/// Middle one of the velocities over range that are left after the last iteration.
pub fn final_velocity(searches: &[Tuned]) -> f64 {
    let last = searches.iter().filter_map(|tuned| tuned.optimum.history.last());
    median(last.map(|iteration| iteration.relative_velocity))
}
