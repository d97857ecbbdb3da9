//! DREM at its best: which gain, filters and normalisation serve it under noise.

use super::campaign::REFERENCES;
use super::candidate::{DremSetting, ObserverCandidate, newton};
use super::spread::Draw;
use super::trial::{self, Outcome};
use crate::study::ball::BallReference;
use crate::study::loop_packages::LoopPackages;
use crate::study::sweep::{indices, sweep};
use crate::study::{Progress, StudyError};

/// Standard deviations of the current sensor \[A\].
pub const NOISES: [f64; 4] = [0.0, 1e-5, 1e-4, 1e-3];
/// gamma \[1/s\]
pub const GAINS: [f64; 5] = [1e-2, 1.0, 10.0, 100.0, 1000.0];
const PREFILTERS: [[f64; 2]; 3] = [[100.0, 300.0], [50.0, 150.0], [200.0, 600.0]];
const FILTERS: [[f64; 4]; 2] = [[10.0, 25.0, 60.0, 150.0], [5.0, 15.0, 40.0, 100.0]];
/// 0 for the paper's gradient.
pub const NORMALISATIONS: [f64; 2] = [0.0, 1.0];
/// Initial flux offsets; each comes with its own noise.
const FLUX_OFFSETS: [f64; 4] = [0.05, -0.05, 0.1, -0.1];

/// A setting on one reference at one noise, over all offsets.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// Share of runs without contact.
    pub survival: f64,
    /// Root mean squares over the surviving runs: share of lam0, \[m\].
    pub flux: f64,
    pub position: f64,
}

/// All settings on both references at all noises.
pub struct Tuning {
    pub settings: Vec<DremSetting>,
    /// `[reference][noise][setting]`
    pub scores: Vec<Vec<Vec<Score>>>,
    /// Newton under the same conditions, `[reference][noise]`.
    pub newton: Vec<Vec<Score>>,
}

impl Tuning {
    /// Tries every `stride`th setting.
    pub fn simulate(
        packages: &LoopPackages,
        stride: usize,
        progress: Progress<'_>,
    ) -> Result<Self, StudyError> {
        let settings: Vec<DremSetting> = settings().into_iter().step_by(stride).collect();
        let mut candidates: Vec<ObserverCandidate> =
            settings.iter().map(|setting| ObserverCandidate::drem("", setting)).collect();
        candidates.push(newton());
        let cases = indices([REFERENCES.len(), NOISES.len(), candidates.len()]);
        let scores = sweep(&cases, progress, "ball-monte-carlo: tuning DREM", |&[reference, noise, who]| {
            score(packages, &candidates[who], REFERENCES[reference], NOISES[noise])
        })?;
        let rows: Vec<Vec<Score>> = scores.chunks(candidates.len()).map(<[Score]>::to_vec).collect();
        let mut scores: Vec<Vec<Vec<Score>>> = rows.chunks(NOISES.len()).map(<[_]>::to_vec).collect();
        let newton =
            scores.iter_mut().map(|noises| noises.iter_mut().filter_map(Vec::pop).collect()).collect();
        Ok(Self { settings, scores, newton })
    }

    /// The setting that loses fewest runs and, among those, has the smallest flux error.
    pub fn best(&self, reference: usize, noise: usize) -> usize {
        let row = &self.scores[reference][noise];
        (0..row.len()).min_by(|a, b| row[*a].rank(&row[*b])).unwrap_or_default()
    }

    /// The best setting for a sensor of `noise` \[A\], one of [`NOISES`].
    pub fn setting_for(&self, reference: usize, noise: f64) -> DremSetting {
        let place = NOISES.iter().position(|candidate| *candidate == noise).unwrap_or(NOISES.len() - 1);
        self.settings[self.best(reference, place)]
    }

    /// The best score with a gain and a normalisation; `None` if none was tried.
    pub fn best_with(&self, reference: usize, noise: usize, gain: f64, normalisation: f64) -> Option<Score> {
        let row = self.scores[reference][noise].iter().zip(&self.settings);
        row.filter(|(_, setting)| setting.gain == gain && setting.normalisation == normalisation)
            .map(|(score, _)| *score)
            .min_by(Score::rank)
    }
}

impl Score {
    /// The better one first.
    fn rank(&self, other: &Self) -> std::cmp::Ordering {
        other.survival.total_cmp(&self.survival).then(self.flux.total_cmp(&other.flux))
    }

    /// Whether no run is lost and the flux error is at most `limit`.
    pub fn is_within(&self, limit: f64) -> bool {
        self.survival == 1.0 && self.flux <= limit
    }
}

fn settings() -> Vec<DremSetting> {
    let lengths = [PREFILTERS.len(), FILTERS.len(), GAINS.len(), NORMALISATIONS.len()];
    let setting = |[prefilters, filters, gain, normalisation]: [usize; 4]| DremSetting {
        prefilters: PREFILTERS[prefilters],
        filters: FILTERS[filters],
        gain: GAINS[gain],
        normalisation: NORMALISATIONS[normalisation],
    };
    indices(lengths).into_iter().map(setting).collect()
}

fn score(
    packages: &LoopPackages,
    candidate: &ObserverCandidate,
    reference: BallReference,
    noise: f64,
) -> Result<Score, StudyError> {
    let (mut survivors, mut flux_squares, mut position_squares) = (0.0, 0.0, 0.0);
    for (seed, flux) in FLUX_OFFSETS.into_iter().enumerate() {
        let draw = Draw { noise, flux, seed: seed as i32, ..Draw::default() };
        if let Outcome::Survived { position, flux } = trial::run(packages, candidate, reference, &draw)? {
            survivors += 1.0;
            flux_squares += flux * flux;
            position_squares += position * position;
        }
    }
    let mean = |squares: f64| if survivors > 0.0 { f64::sqrt(squares / survivors) } else { f64::INFINITY };
    Ok(Score {
        survival: survivors / FLUX_OFFSETS.len() as f64,
        flux: mean(flux_squares),
        position: mean(position_squares),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_setting_loses_fewest_then_estimates_best() {
        let score = |survival, flux| Score { survival, flux, position: 0.0 };
        let row = vec![score(0.5, 0.001), score(1.0, 0.05), score(1.0, 0.02), score(0.75, 0.0)];
        let settings = settings().into_iter().take(4).collect();
        let tuning = Tuning { settings, scores: vec![vec![row]], newton: Vec::new() };
        assert_eq!(tuning.best(0, 0), 2);
        assert!(!score(0.75, 0.0).is_within(0.01) && score(1.0, 0.01).is_within(0.01));
    }
}
