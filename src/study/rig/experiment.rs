//! The experiment: runs, figures, tables and claims put together.

use std::path::Path;

use super::observers::{KINDS, PRINTED_INPUT_GAIN, holding, interpolating};
use super::ranking::{
    Comparison, PRINTED_EXPERIMENT, PRINTED_SIMULATION, Start, Table5, both, compare, start_up,
};
use super::recording::Reference;
use super::searches::Searches;
use super::simulation::{Measurement, Scenario, simulate};
use super::{claims, figures, ranking};
use crate::host::Value;
use crate::model::system::RIG as SYSTEM;
use crate::study::loop_packages::LoopPackages;
use crate::study::report::quantity;
use crate::study::run::Run;
use crate::study::sweep::part;
use crate::study::{Findings, Progress, StudyError, Summary};

const PROVENANCE: &[&str] = &[
    "Source: A. J. Humaidi et al., Experimental Design and Verification of Extended State \
             Observers for Magnetic Levitation System Based on PSO, Open Electr. Electron. Eng. J. 12, \
             110-120, 2018. Printed there: Tables 1 to 5 and the gains of the PID. The equations are \
             pictures that were not at hand; their form follows the words around them and the standard \
             works (Han, Gao). Assumed: the objective's form, T = 1 ms, metres or volts, all that is not \
             printed about the runs. From the rig's manual: the sensor.",
    "The loop is the rig under its digital PID, through the packaged models; the searches run \
             natively over a recording of the same loop. Errors are scored at every millisecond, the \
             first sample included.",
];

/// Runs everything through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    progress(0.0, "rig: Table 5");
    let packages = LoopPackages::open(packages, &SYSTEM)?;
    let table = Table5::simulate(&packages)?;
    let comparisons = compare(&packages, &part(progress, 0.1, 0.6))?;
    progress(0.6, "rig: particle swarms");
    let searches = Searches::run()?;
    progress(0.8, "rig: claims");
    let start_up = both(&packages, &start_up(4.0))?;
    let steady = Scenario::new(Reference::SineAndStep, 4.0, &holding(Measurement::Volts, "steady"));
    let moving = both(&packages, &steady)?;
    Ok(Findings {
        name: "rig",
        title: "Extended state observers for the maglev rig",
        provenance: PROVENANCE,
        figures: vec![
            figures::nonlinear_gain(),
            figures::estimates(&start_up, &moving, PRINTED_INPUT_GAIN),
            figures::ranking(&comparisons),
            figures::discretisations(&discretisations(&packages)?),
            searches.figure(),
        ],
        claims: claims::all(&packages, &table, &comparisons, &searches)?,
        summaries: vec![table_5(&table), conditions(&comparisons)],
        advice: vec![advice(&comparisons)],
    })
}

/// NESO with Table 4 by each discretisation at 1 ms.
fn discretisations(packages: &LoopPackages) -> Result<Vec<(&'static str, Run)>, StudyError> {
    ["euler", "runge_kutta", "exact"]
        .into_iter()
        .map(|item| {
            let mut parameters = interpolating(Measurement::Metres, "zero");
            parameters.extend([
                KINDS[1],
                ("observer.discretisation", Value::Text(item)),
                ("observer.form", Value::Text("predictor")),
            ]);
            let name = match item {
                "euler" => "forward Euler",
                "exact" => "exact with frozen gains",
                _ => "Runge-Kutta",
            };
            Ok((name, simulate(packages, &Scenario::new(Reference::Hold, 1.0, &parameters))?))
        })
        .collect()
}

fn table_5(table: &Table5) -> Summary {
    let row = |name: &str, [linear, nonlinear]: [f64; 2], unit: &str| {
        vec![
            name.to_owned(),
            format!("{linear:.4e} {unit}"),
            format!("{nonlinear:.4e} {unit}"),
            format!("{:.4}", nonlinear / linear),
        ]
    };
    Summary::new(
        "Table 5: RMSE as printed and as computed",
        ["row", "LESO", "NESO", "NESO over LESO"],
        vec![
            row("by simulation, printed", PRINTED_SIMULATION, ""),
            row("by simulation, here: metres, from zero, 8.5 mm, 2 s", table.simulation_errors, "m"),
            row("by experiment, printed", PRINTED_EXPERIMENT, ""),
            row(
                "in place of the experiment: innovation, sine 0.71 V 0.5 Hz, 0.1 mV",
                table.experiment_errors,
                "V",
            ),
        ],
    )
}

/// Who wins, in words.
fn conditions(comparisons: &[Comparison]) -> Summary {
    let noises = [0.0, 1e-4, 1e-3, 1e-2];
    let mut rows = Vec::new();
    for (start, start_name) in ranking::STARTS {
        for (measurement, unit) in ranking::MEASUREMENTS {
            for (reference, (_, name)) in ranking::REFERENCES.iter().enumerate() {
                let cells = noises.iter().map(|noise| {
                    let case = comparisons.iter().find(|case| {
                        (case.measurement, case.start, case.reference, case.noise)
                            == (measurement, start, reference, *noise)
                    });
                    match case.map(|case| (case.linear_wins(), case.ratios)) {
                        Some((Some(linear), [z1, z2, z3])) => {
                            let winner = if linear { "LESO" } else { "NESO" };
                            format!("{winner} ({z1:.2}, {z2:.2}, {z3:.2})")
                        }
                        _ => "no error".to_owned(),
                    }
                });
                let head = format!("{unit}, {start_name}, {name}");
                rows.push(std::iter::once(head).chain(cells).collect());
            }
        }
    }
    Summary::new(
        "Better observer of z1, printed parameters (rms errors of NESO over LESO of z1, z2, z3)",
        std::iter::once("unit, estimates at the start, reference".to_owned())
            .chain(noises.iter().map(|noise| format!("noise {}", quantity(*noise, "V")))),
        rows,
    )
}

/// From the numbers: when which observer.
fn advice(comparisons: &[Comparison]) -> String {
    let steady: Vec<&Comparison> = comparisons.iter().filter(|case| case.start == Start::Steady).collect();
    let flips: Vec<String> = ranking::REFERENCES
        .iter()
        .enumerate()
        .map(|(reference, (_, name))| {
            let nonlinear_up_to = steady
                .iter()
                .filter(|case| case.reference == reference && case.measurement == Measurement::Volts)
                .filter(|case| case.linear_wins() == Some(false))
                .map(|case| case.noise)
                .fold(None, |largest: Option<f64>, noise| {
                    Some(largest.map_or(noise, |known| known.max(noise)))
                });
            match nonlinear_up_to {
                Some(noise) => format!("{name}: NESO up to {} of noise", quantity(noise, "V")),
                None => format!("{name}: LESO at every noise tried"),
            }
        })
        .collect();
    format!(
        "With the printed parameters, in sensor volts and from a steady start, the smaller position \
             error has: {}. The printed ranking says how an observer starts from zero in metres, nothing \
             more. Start estimates with observer.initial = steady, and tune: maglev-fmu tune.",
        flips.join("; ")
    )
}
