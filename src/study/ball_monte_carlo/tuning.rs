//! DREM at its best: which gain, filters and normalisation serve it under noise.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::contender::{Contender, DremSetting};
use super::spread::Draw;
use super::trial::{self, Outcome};
use crate::signal::BallReference::{Sinusoids, Steps};
use crate::study::loop_packages::LoopPackages;
use crate::study::{Progress, StudyError};

/// Standard deviations of the current sensor \[A\].
pub const NOISES: [f64; 4] = [0.0, 1e-5, 1e-4, 1e-3];
/// gamma \[1/s\]
pub const GAINS: [f64; 5] = [1e-4, 1e-2, 1.0, 10.0, 100.0];
const PREFILTERS: [[f64; 2]; 3] = [[100.0, 300.0], [50.0, 150.0], [200.0, 600.0]];
const FILTERS: [[f64; 4]; 2] = [[10.0, 25.0, 60.0, 150.0], [5.0, 15.0, 40.0, 100.0]];
/// 0 for the paper's gradient.
pub const NORMALISATIONS: [f64; 2] = [0.0, 1.0];
/// Initial flux offsets; each comes with its own noise.
const FLUX_OFFSETS: [f64; 2] = [0.05, -0.05];

/// A setting at one noise, over both references and all offsets.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// Share of runs without contact.
    pub survival: f64,
    /// Root mean squares over the surviving runs: share of lam0, \[m\].
    pub flux: f64,
    pub position: f64,
}

/// All settings at all noises.
pub struct Tuning {
    pub settings: Vec<DremSetting>,
    /// `[noise][setting]`
    pub scores: Vec<Vec<Score>>,
    /// Newton under the same conditions, by noise.
    pub newton: Vec<Score>,
}

impl Tuning {
    pub fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
        let settings = settings();
        let mut contenders: Vec<Contender> =
            settings.iter().map(|setting| Contender::drem("", setting)).collect();
        contenders.push(super::newton());
        let done = AtomicUsize::new(0);
        let cases: Vec<(usize, usize)> =
            (0..NOISES.len()).flat_map(|noise| (0..contenders.len()).map(move |who| (noise, who))).collect();
        let scores = cases
            .par_iter()
            .map(|&(noise, who)| {
                let score = score(packages, &contenders[who], NOISES[noise])?;
                let count = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(count as f64 / cases.len() as f64, "ball-monte-carlo: tuning DREM");
                Ok(score)
            })
            .collect::<Result<Vec<Score>, StudyError>>()?;
        let mut scores: Vec<Vec<Score>> = scores.chunks(contenders.len()).map(<[Score]>::to_vec).collect();
        let newton = scores.iter_mut().filter_map(Vec::pop).collect();
        Ok(Self { settings, scores, newton })
    }

    /// The setting with the smallest flux error among those that lose no run, or else among those that lose fewest.
    pub fn best(&self, noise: usize) -> usize {
        let row = &self.scores[noise];
        let most = row.iter().map(|score| score.survival).fold(0.0, f64::max);
        (0..row.len())
            .filter(|who| row[*who].survival == most)
            .min_by(|a, b| row[*a].flux.total_cmp(&row[*b].flux))
            .unwrap_or_default()
    }

    /// The best setting with a gain and a normalisation, at one noise.
    pub fn best_with(&self, noise: usize, gain: f64, normalisation: f64) -> Score {
        let row = &self.scores[noise];
        let fits = |who: &usize| {
            let setting = &self.settings[*who];
            setting.gain == gain && setting.normalisation == normalisation
        };
        let better = |a: &usize, b: &usize| {
            let (a, b) = (&row[*a], &row[*b]);
            b.survival.total_cmp(&a.survival).then(a.flux.total_cmp(&b.flux))
        };
        let best = (0..row.len()).filter(fits).min_by(better).unwrap_or_default();
        row[best]
    }
}

fn settings() -> Vec<DremSetting> {
    let mut settings = Vec::new();
    for prefilters in PREFILTERS {
        for filters in FILTERS {
            for gain in GAINS {
                for normalisation in NORMALISATIONS {
                    settings.push(DremSetting { prefilters, filters, gain, normalisation });
                }
            }
        }
    }
    settings
}

fn score(packages: &LoopPackages, contender: &Contender, noise: f64) -> Result<Score, StudyError> {
    let (mut survivors, mut flux_squares, mut position_squares, mut runs) = (0.0, 0.0, 0.0, 0.0);
    for reference in [Sinusoids, Steps] {
        for (seed, flux) in FLUX_OFFSETS.into_iter().enumerate() {
            let draw = Draw {
                resistance: 0.0,
                inductance_constant: 0.0,
                mass: 0.0,
                voltage_offset: 0.0,
                noise,
                flux,
                seed: seed as i32,
            };
            if let Outcome::Survived { position, flux } = trial::run(packages, contender, reference, &draw)? {
                survivors += 1.0;
                flux_squares += flux * flux;
                position_squares += position * position;
            }
            runs += 1.0;
        }
    }
    let mean = |squares: f64| if survivors > 0.0 { f64::sqrt(squares / survivors) } else { f64::INFINITY };
    Ok(Score { survival: survivors / runs, flux: mean(flux_squares), position: mean(position_squares) })
}
