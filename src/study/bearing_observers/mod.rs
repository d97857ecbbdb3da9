//! All observers of the magnetic bearing on the same noisy data, next to the Cramer-Rao bound, and in the loop.

mod bound;
mod candidates;
mod claims;
mod comparison;
mod presentation;
mod settling;

use std::path::Path;

use super::loop_packages::LoopPackages;
use super::sweep::part;
use super::{Findings, Progress, StudyError};
use crate::model::system::BEARING;
use comparison::Comparison;

/// Standard deviations of the position sensor \[m\].
const NOISES: [f64; 5] = [0.0, 1e-9, 1e-8, 1e-7, 1e-6];
/// Sample times \[s\].
const SAMPLE_TIMES: [f64; 3] = [1e-4, 1e-3, 1e-2];
/// Simulated time \[s\], of which the start is not scored.
const DURATION: f64 = 10.0;
const SCORED_FROM: f64 = 0.5;
/// Flux at the start \[Wb\]: what u(0) = -150 V for 1 ms leaves behind, so that all sample times see the same motion.
const INITIAL_FLUX: f64 = -0.15;
/// A rotor that gets further than this from the centre counts as lost \[m\]; undisturbed it stays within 0.014 m.
const LOST_BEYOND: f64 = 0.05;

/// Seeds per sample time: a run at 0.1 ms takes ten times as many steps as one at 1 ms.
fn seeds(sample_time: f64) -> i32 {
    if sample_time < 1e-3 { 3 } else { 10 }
}

const PROVENANCE: &[&str] = &[
    "From the paper: the full-order Newton observer, its reduced-order form (section 3.1) and, by a \
     footnote, windows of more than three samples. Not from the paper: the exact model inside the observer, \
     the compensation of the reduced observer's lag, the Kalman filter and the flux cascade. The paper \
     shows no run with noise and none of the reduced observer.",
    "Law (8a), x1(0) = 0.01 m, flux -0.15 Wb at the start, no bias. Errors are scored after 0.5 s with the \
     true state fed back, so that every observer sees the same data; whether the loop stays up is judged \
     with the estimate fed back. The bound is the posterior Cramer-Rao bound of the same model with the \
     Kalman filter's prior, along the true trajectory.",
];

/// Runs everything through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    let packages = LoopPackages::open(packages, &BEARING)?;
    let comparison = Comparison::simulate(&packages, &part(progress, 0.0, 0.95))?;
    progress(0.97, "bearing-observers: laws that settle");
    let (settling_figure, settling_table) = settling::compare(&packages)?;
    let mut figures = presentation::figures(&comparison);
    figures.push(settling_figure);
    let mut summaries = presentation::tables(&comparison);
    summaries.push(settling_table);
    Ok(Findings {
        name: "bearing-observers",
        title: "Which observer for a magnetic bearing with a real sensor",
        provenance: PROVENANCE,
        figures,
        claims: claims::all(&packages, &comparison)?,
        summaries,
        advice: presentation::advice(&comparison),
    })
}
