//! All observers under all conditions.

use super::bound::{Bound, cramer_rao};
use super::candidates::{CANDIDATES, Conditions, remained_levitated, rms_error, simulate};
use super::conditions::{NOISES, SAMPLE_TIMES, seeds};
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::{indicator, root_mean_square};
use crate::study::sweep::{indices, sweep};
use crate::study::{Progress, StudyError};

/// One observer under one sample time and noise, with one seed or over all.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// Root mean square errors \[m/s\], \[Wb\].
    pub velocity: f64,
    pub flux: f64,
    /// Share of runs in which the rotor, held by the estimates, remained levitated.
    pub survival: f64,
}

/// Results by sample time, noise and observer.
pub struct Comparison {
    /// `[sample time][noise][observer]`
    pub scores: Vec<Vec<Vec<Score>>>,
    /// `[sample time][noise]`
    pub bounds: Vec<Vec<Bound>>,
}

impl Comparison {
    pub fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
        let conditions = indices([SAMPLE_TIMES.len(), NOISES.len(), CANDIDATES.len()]);
        let with_seeds = |case: [usize; 3]| (0..seeds(SAMPLE_TIMES[case[0]])).map(move |seed| (case, seed));
        let cases: Vec<_> = conditions.iter().flat_map(|case| with_seeds(*case)).collect();
        let action = "bearing-observers: comparing observers";
        let outcomes = sweep(&cases, progress, action, |([time, noise, who], seed)| {
            score(packages, SAMPLE_TIMES[*time], NOISES[*noise], *who, *seed)
        })?;
        let mut outcomes = outcomes.as_slice();
        let mut scores = vec![vec![Vec::new(); NOISES.len()]; SAMPLE_TIMES.len()];
        for [time, noise, _] in conditions {
            let (of_case, others) = outcomes.split_at(seeds(SAMPLE_TIMES[time]) as usize);
            scores[time][noise].push(Score::over(of_case));
            outcomes = others;
        }
        let bounds = SAMPLE_TIMES
            .iter()
            .map(|sample_time| NOISES.iter().map(|noise| bound(packages, *sample_time, *noise)).collect())
            .collect::<Result<_, _>>()?;
        Ok(Self { scores, bounds })
    }
}

impl Score {
    /// Of all seeds.
    fn over(seeds: &[Self]) -> Self {
        Self {
            velocity: root_mean_square(seeds.iter().map(|score| score.velocity)),
            flux: root_mean_square(seeds.iter().map(|score| score.flux)),
            survival: seeds.iter().map(|score| score.survival).sum::<f64>() / seeds.len() as f64,
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
) -> Result<Score, StudyError> {
    let parameters = CANDIDATES[who].parameters(noise);
    let run = |feedback| simulate(packages, Conditions { sample_time, noise, seed, feedback }, &parameters);
    let (observed, in_loop) = (run("state")?, run("estimate")?);
    Ok(Score {
        velocity: rms_error(&observed, "velocity"),
        flux: rms_error(&observed, "flux"),
        survival: indicator(remained_levitated(&in_loop)),
    })
}

/// The bound along the trajectory of the first seed; trajectories of other seeds hardly differ.
fn bound(packages: &LoopPackages, sample_time: f64, noise: f64) -> Result<Bound, StudyError> {
    let run = simulate(packages, Conditions { sample_time, noise, seed: 0, feedback: "state" }, &[])?;
    Ok(cramer_rao(&run, sample_time, noise))
}
