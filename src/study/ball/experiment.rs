//! The experiment: runs, figures, tables and claims put together.

use std::path::Path;

use super::runs::Runs;
use super::{claims, cost, figures, tables};
use crate::model::system::BALL;
use crate::study::loop_packages::LoopPackages;
use crate::study::sweep::part;
use crate::study::{Findings, Progress, StudyError};

const PROVENANCE: &[&str] = &[
    "Source: A. Bobtsov, A. Pyrkin, R. Ortega, A. Vedyakov, Sensorless control of the levitated \
             ball, arXiv 1811.07732. The text at hand has lost every equation, number and figure. What is \
             left of it: the order of the design (parameter estimation-based observer, a regression that \
             is nonlinear in the flux offset, four filters, DREM that keeps the first component, speed \
             and position observers, feedback-linearising law), the references (filtered sinusoids and \
             steps), what the figures vary, and the words about them.",
    "The regression used here is a valid one of the announced kind (degree 5 in the offset, four \
             filters, exact), not provably the authors' own. Every numeric parameter is assumed or tuned: \
             a typical laboratory rig (84.4 g, 2.52 Ohm, 5 mm), gains, filters, references and initial \
             errors. What was reproduced are therefore the kinds of behaviour that the text reports, not \
             its numbers.",
    "The loop is sampled at 0.1 ms and the plant integrated inside its model. Numbers of the \
             continuous loop stand beside where they are known; they come from the same equations \
             integrated without sampling.",
];

/// Runs everything through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    progress(0.0, "ball: opening the packages");
    let packages = LoopPackages::open(packages, &BALL)?;
    let runs = Runs::simulate(&packages, &part(progress, 0.0, 0.95))?;
    let mut claims = claims::all(&runs);
    claims.push(cost::claim(&packages)?);
    Ok(Findings {
        name: "ball",
        title: "Sensorless control of the levitated ball",
        provenance: PROVENANCE,
        figures: figures::all(&runs),
        claims,
        summaries: tables::all(&runs),
        advice: Vec::new(),
    })
}
