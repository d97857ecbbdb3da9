//! All runs: every candidate on every draw of every spread.

use super::candidate::{CANDIDATES, ObserverCandidate};
use super::spread::SPREADS;
use super::trial::{self, Outcome};
use crate::study::ball::BallReference::{self, Sinusoids, Steps};
use crate::study::interval::{Interval, bootstrap};
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics;
use crate::study::sweep::sweep;
use crate::study::{Progress, StudyError};

pub const REFERENCES: [BallReference; 2] = [Sinusoids, Steps];

/// Outcomes by `[spread][reference][candidate][run]`, and what they come to by `[spread][reference][candidate]`.
pub struct Campaign {
    pub outcomes: Vec<Vec<Vec<Vec<Outcome>>>>,
    errors: Vec<Vec<Vec<Errors>>>,
}

/// What the runs of a candidate come to.
pub struct Errors {
    /// rms |y - y*| \[m\]
    pub position: Median,
    /// rms flux error, share of lam0
    pub flux: Median,
}

/// Median over all runs, lost ones counting as infinite, and where that of all possible runs lies.
pub struct Median {
    pub value: f64,
    pub interval: Interval,
}

impl Campaign {
    /// At most `cap` runs per spread and reference; `candidates(spread, reference)` names who runs.
    pub fn simulate(
        packages: &LoopPackages,
        candidates: impl Fn(usize, usize) -> [ObserverCandidate; CANDIDATES],
        cap: u32,
        progress: Progress<'_>,
    ) -> Result<Self, StudyError> {
        let mut cases = Vec::new();
        let mut fields = Vec::new();
        for (spread, widths) in SPREADS.iter().enumerate() {
            for reference in 0..REFERENCES.len() {
                let field = fields.len();
                fields.push(candidates(spread, reference));
                for who in 0..CANDIDATES {
                    let runs = 0..widths.runs.min(cap);
                    cases.extend(runs.map(|run| (spread, reference, (field, who), run)));
                }
            }
        }
        let action = "ball-monte-carlo: simulating";
        let outcomes = sweep(&cases, progress, action, |&(spread, reference, (field, who), run)| {
            let draw = SPREADS[spread].draw(run);
            trial::run(packages, &fields[field][who], REFERENCES[reference], &draw)
        })?;
        let mut outcomes = outcomes.into_iter();
        let outcomes: Vec<Vec<Vec<Vec<Outcome>>>> = SPREADS
            .iter()
            .map(|spread| {
                let mut runs = || outcomes.by_ref().take(spread.runs.min(cap) as usize).collect();
                let mut by_candidate = || (0..CANDIDATES).map(|_| runs()).collect();
                REFERENCES.iter().map(|_| by_candidate()).collect()
            })
            .collect();
        let by_candidate = |field: &Vec<Vec<Outcome>>| field.iter().map(|runs| Errors::of(runs)).collect();
        let errors = outcomes.iter().map(|spread| spread.iter().map(by_candidate).collect()).collect();
        Ok(Self { outcomes, errors })
    }

    /// Number of runs of a spread on a reference.
    pub fn runs(&self, spread: usize) -> u32 {
        self.of(spread, 0, 0).len() as u32
    }

    /// Runs of a candidate.
    pub fn of(&self, spread: usize, reference: usize, who: usize) -> &[Outcome] {
        &self.outcomes[spread][reference][who]
    }

    /// What the runs of a candidate come to.
    pub fn errors(&self, spread: usize, reference: usize, who: usize) -> &Errors {
        &self.errors[spread][reference][who]
    }

    /// Number of survivors.
    pub fn survivors(&self, spread: usize, reference: usize, who: usize) -> usize {
        self.of(spread, reference, who).iter().filter(|outcome| outcome.survived()).count()
    }
}

impl Errors {
    fn of(runs: &[Outcome]) -> Self {
        let median = |value: fn(&Outcome) -> f64| {
            let values: Vec<f64> = runs.iter().map(value).collect();
            let interval = bootstrap(&values, |sample| metrics::median(sample));
            Median { value: metrics::median(values), interval }
        };
        Self { position: median(Outcome::position), flux: median(Outcome::flux) }
    }
}
