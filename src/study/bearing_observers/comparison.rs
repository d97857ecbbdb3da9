//! All observers under all conditions.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::bound::{Bound, cramer_rao};
use super::contenders::{CONTENDERS, Conditions, rms_error, simulate, stayed_up};
use super::{NOISES, SAMPLE_TIMES, seeds};
use crate::study::loop_packages::LoopPackages;
use crate::study::{Progress, StudyError};

/// One observer under one sample time and noise, over all seeds.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// Root mean square errors \[m/s\], \[Wb\].
    pub velocity: f64,
    pub flux: f64,
    /// Share of runs in which the loop on estimates stays up.
    pub survival: f64,
}

/// Results by sample time, noise and observer.
pub struct Comparison {
    /// `[sample time][noise][observer]`
    pub scores: Vec<Vec<Vec<Score>>>,
    /// `[sample time][noise]`
    pub bounds: Vec<Vec<Bound>>,
}

/// Sums over the seeds done so far.
#[derive(Clone, Copy, Default)]
struct Sums {
    velocity_square: f64,
    flux_square: f64,
    survivors: f64,
    runs: f64,
}

impl Comparison {
    pub fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
        let cases: Vec<(usize, usize, usize, i32)> = (0..SAMPLE_TIMES.len())
            .flat_map(|time| (0..seeds(SAMPLE_TIMES[time])).map(move |seed| (time, seed)))
            .flat_map(|(time, seed)| (0..NOISES.len()).map(move |noise| (time, noise, seed)))
            .flat_map(|(time, noise, seed)| (0..CONTENDERS.len()).map(move |who| (time, noise, who, seed)))
            .collect();
        let done = AtomicUsize::new(0);
        let outcomes = cases
            .par_iter()
            .map(|&(time, noise, who, seed)| {
                let outcome = score(packages, SAMPLE_TIMES[time], NOISES[noise], who, seed)?;
                let count = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(0.95 * count as f64 / cases.len() as f64, "bearing-observers: comparing observers");
                Ok(outcome)
            })
            .collect::<Result<Vec<Sums>, StudyError>>()?;

        let mut sums = vec![vec![vec![Sums::default(); CONTENDERS.len()]; NOISES.len()]; SAMPLE_TIMES.len()];
        for (&(time, noise, who, _), outcome) in cases.iter().zip(&outcomes) {
            let sum = &mut sums[time][noise][who];
            sum.velocity_square += outcome.velocity_square;
            sum.flux_square += outcome.flux_square;
            sum.survivors += outcome.survivors;
            sum.runs += 1.0;
        }
        let scores = sums
            .iter()
            .map(|noises| noises.iter().map(|row| row.iter().map(Sums::score).collect()).collect())
            .collect();
        let bounds = SAMPLE_TIMES
            .iter()
            .map(|sample_time| NOISES.iter().map(|noise| bound(packages, *sample_time, *noise)).collect())
            .collect::<Result<_, _>>()?;
        Ok(Self { scores, bounds })
    }
}

impl Sums {
    fn score(&self) -> Score {
        Score {
            velocity: (self.velocity_square / self.runs).sqrt(),
            flux: (self.flux_square / self.runs).sqrt(),
            survival: self.survivors / self.runs,
        }
    }
}

/// One seed: errors on common data, then the loop on estimates.
fn score(
    packages: &LoopPackages,
    sample_time: f64,
    noise: f64,
    who: usize,
    seed: i32,
) -> Result<Sums, StudyError> {
    let parameters = CONTENDERS[who].parameters(noise);
    let observed =
        simulate(packages, Conditions { sample_time, noise, seed, feedback: "state" }, &parameters)?;
    let in_loop =
        simulate(packages, Conditions { sample_time, noise, seed, feedback: "estimate" }, &parameters)?;
    let velocity = rms_error(&observed, "plant.velocity", "controller.estimate.velocity");
    let flux = rms_error(&observed, "plant.flux", "controller.estimate.flux");
    Ok(Sums {
        velocity_square: velocity * velocity,
        flux_square: flux * flux,
        survivors: f64::from(u8::from(stayed_up(&in_loop))),
        runs: 1.0,
    })
}

/// The bound along the trajectory of the first seed; trajectories of other seeds hardly differ.
fn bound(packages: &LoopPackages, sample_time: f64, noise: f64) -> Result<Bound, StudyError> {
    let trace = simulate(packages, Conditions { sample_time, noise, seed: 0, feedback: "state" }, &[])?;
    Ok(cramer_rao(&trace, sample_time, noise))
}
