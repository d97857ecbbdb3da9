//! The experiment: runs, figures, tables and claims put together.

use std::path::Path;

use super::{claims, figures, runs::Runs};
use crate::model::system::BEARING;
use crate::study::loop_packages::LoopPackages;
use crate::study::sweep::part;
use crate::study::{Findings, Progress, StudyError};

const PROVENANCE: &[&str] = &[
    "Source: A. Mystkowski, Ü. Kotta, V. Kaparin, Newton observer for a nonlinear flux-controlled \
             AMB system, Proc. Estonian Acad. Sci. 67(1), 61-72, 2018. Printed there: the plant (3), its \
             discrete-time model (4), the observer, the laws (8) and Table 1. The paper's pictures were \
             not at hand; the figures here follow its captions and its text.",
    "Chosen here where the paper is silent: figures 4 to 6 start from x1(0) = 0.01 m, and figures \
             2, 3, 5 and 6 from u(0) = -150 V; until two past samples exist the estimate is the measured \
             position with the observer's initial velocity and flux. The plant is solved exactly; the \
             observer inverts the model (4a) as printed, d = 10.",
];

/// Runs everything through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    progress(0.0, "bearing: opening the packages");
    let packages = LoopPackages::open(packages, &BEARING)?;
    let runs = Runs::simulate(&packages, &part(progress, 0.0, 0.9))?;
    Ok(Findings {
        name: "bearing",
        title: "Newton observer for a flux-controlled magnetic bearing",
        provenance: PROVENANCE,
        figures: figures::all(&runs),
        claims: claims::all(&packages, &runs)?,
        summaries: Vec::new(),
        advice: Vec::new(),
    })
}
