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

/// Outcomes by `[spread][reference][candidate][run]`.
pub struct Campaign {
    pub outcomes: Vec<Vec<Vec<Vec<Outcome>>>>,
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
        let outcomes = SPREADS
            .iter()
            .map(|spread| {
                let mut runs = || outcomes.by_ref().take(spread.runs.min(cap) as usize).collect();
                let mut by_candidate = || (0..CANDIDATES).map(|_| runs()).collect();
                REFERENCES.iter().map(|_| by_candidate()).collect()
            })
            .collect();
        Ok(Self { outcomes })
    }

    /// Number of runs of a spread on a reference.
    pub fn runs(&self, spread: usize) -> u32 {
        self.of(spread, 0, 0).len() as u32
    }

    /// Runs of a candidate.
    pub fn of(&self, spread: usize, reference: usize, who: usize) -> &[Outcome] {
        &self.outcomes[spread][reference][who]
    }

    /// Number of survivors.
    pub fn survivors(&self, spread: usize, reference: usize, who: usize) -> usize {
        self.of(spread, reference, who).iter().filter(|outcome| outcome.survived()).count()
    }
}

/// Median over all runs, lost ones counting as infinite.
pub fn median(outcomes: &[Outcome], value: impl Fn(&Outcome) -> f64) -> f64 {
    metrics::median(outcomes.iter().map(value))
}

/// Where the [`median`] of all possible runs lies, by bootstrap.
pub fn median_interval(outcomes: &[Outcome], value: impl Fn(&Outcome) -> f64) -> Interval {
    let values: Vec<f64> = outcomes.iter().map(value).collect();
    bootstrap(&values, |sample| metrics::median(sample))
}
