//! The experiment: runs, figures, tables and claims put together.

use std::path::Path;

use super::comparison::Comparison;
use super::{claims, presentation, settling};
use crate::model::system::BEARING;
use crate::study::loop_packages::LoopPackages;
use crate::study::sweep::part;
use crate::study::{Findings, Progress, StudyError};

const PROVENANCE: &[&str] = &[
    "From the paper: the full-order Newton observer, its reduced-order form (section 3.1) and, by a \
     footnote, windows of more than three samples. Not from the paper: the exact model inside the observer, \
     the compensation of the reduced observer's lag, the Kalman filter and the flux cascade. The paper \
     shows no run with noise and none of the reduced observer.",
    "Law (8a), x1(0) = 0.01 m, flux -0.15 Wb at the start, no bias. Errors are scored after 0.5 s with the \
     true state fed back, so that every observer sees the same data; whether the rotor remained levitated is judged \
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
