//! The experiment: runs, figures, tables and claims put together.

use std::path::Path;

use super::candidates::{ObserverCandidate, TESTS, candidates, scores};
use super::{claims, force_step, peaking};
use crate::model::system::RIG as SYSTEM;
use crate::study::loop_packages::LoopPackages;
use crate::study::sweep::part;
use crate::study::{Findings, Progress, StudyError, Summary};

const PROVENANCE: &[&str] = &[
    "From the paper: LESO and NESO with their printed parameters, and the PID. Not from the paper: the loop through the \
     extended state (Gao's linear active disturbance rejection), the tuning under noise, the Kalman filter with a disturbing \
     acceleration as third state, and the Newton observer of the magnetic bearing's paper, here on the rig's model, without \
     and with that acceleration. The observer of the levitated ball's paper needs the coil's flux dynamics, which the rig's \
     current loop hides; it has no place here.",
    "The loops with a disturbance step and the table of starts come from the packaged models; the comparison of observers and the trade-off \
     run natively over recordings of the PID loop, with the very observers of the models. Every \
     observer of the comparison is tuned once for the same objective: the geometric mean of the velocity errors over \
     sensor noises of 0.1, 0.3, 1 and 3 mV, masses of -20, 0 and +20 %, and two references, with a disturbance step of 1 m/s². It is \
     scored on other seeds.",
];

/// Runs everything; the loops through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    let packages = LoopPackages::open(packages, &SYSTEM)?;
    let outcomes = force_step::compare(&packages, &part(progress, 0.0, 0.1))?;
    progress(0.1, "rig-observers: noise against peaking");
    let lines = peaking::trade_off();
    let starts = peaking::starts(&packages)?;
    progress(0.2, "rig-observers: tuning all observers");
    let candidates = candidates()?;
    progress(0.9, "rig-observers: comparing them");
    let scores = scores(&candidates);
    Ok(Findings {
        name: "rig-observers",
        title: "Maglev rig: which observer, and what for",
        provenance: PROVENANCE,
        figures: vec![force_step::figure(&outcomes), peaking::figure(&lines)],
        claims: claims::all(&outcomes),
        advice: vec![advice(&candidates, &scores)],
        summaries: vec![force_step::table(&outcomes), comparison(&candidates, &scores), starts],
    })
}

/// Velocity errors of all observers.
fn comparison(candidates: &[ObserverCandidate], scores: &[Vec<f64>]) -> Summary {
    let headers =
        ["observer", "tuning"].map(str::to_owned).into_iter().chain(TESTS.iter().map(|test| test.name()));
    let rows = candidates.iter().enumerate().map(|(who, candidate)| {
        let cells = scores.iter().map(|row| {
            if row[who].is_finite() { format!("{:.3} mm/s", 1e3 * row[who]) } else { "diverges".to_owned() }
        });
        [candidate.name.to_owned(), candidate.tuning.clone()].into_iter().chain(cells).collect()
    });
    Summary::new(
        "rms velocity error under the PID: sine and step of the reference, disturbance step of 1 m/s²",
        headers,
        rows,
    )
}

/// The best observer per condition.
fn advice(candidates: &[ObserverCandidate], scores: &[Vec<f64>]) -> String {
    let best = |row: &[f64]| {
        (0..row.len()).min_by(|a, b| row[*a].total_cmp(&row[*b])).map_or("none", |who| candidates[who].name)
    };
    let choices: Vec<String> =
        TESTS.iter().zip(scores).map(|(test, row)| format!("{}: {}", test.name(), best(row))).collect();
    format!(
        "Smallest velocity error by condition, each observer tuned once for all of them: {}. The controller model has them all, \
         as observer.kind = linear, nonlinear, kalman and windowed_newton. Of the extended state observers, tuned ones are \
         several times better than the printed; to control, give the observer the plant's input gain, about -3705 in volts.",
        choices.join("; ")
    )
}
