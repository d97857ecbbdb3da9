//! A disturbance step: the paper's PID against disturbance rejection through the extended state.

use crate::chart::Panel;
use crate::host::Value;
use crate::study::loop_packages::{LoopPackages, Parameter};
use crate::study::metrics::{difference, peak, root_mean_square};
use crate::study::report::quantity;
use crate::study::rig::observers::KINDS;
use crate::study::rig::recording::{Reference, SENSOR, SET_POINT};
use crate::study::rig::simulation::{Scenario, control_error, simulate};
use crate::study::run::Run;
use crate::study::sweep::sweep;
use crate::study::{FigureWithData, Progress, StudyError, Summary, Table};

/// 1 m/s2 from 1 s on.
const DISTURBANCE_STEP: (f64, f64) = (1.0, 1.0);
/// \[s\]
const DURATION: f64 = 3.0;
/// Sensor noise of the noisy runs \[V\].
const NOISE: f64 = 1e-3;
/// b0 of the plant at 9 mm \[V/(s2 V)\].
const INPUT_GAIN: f64 = -3705.0;
/// Masses over that of Table 1 with which each loop is tried.
const MASS_RATIOS: [f64; 3] = [1.0, 0.8, 1.2];

/// A law with its observer.
#[derive(Clone)]
pub struct Law {
    pub name: &'static str,
    parameters: Vec<Parameter<'static>>,
}

/// Disturbance rejection with bandwidths of observer and loop and an input gain.
fn rejection(
    name: &'static str,
    observer: Parameter<'static>,
    observer_bandwidth: f64,
    bandwidth: f64,
    input_gain: f64,
) -> Law {
    Law {
        name,
        parameters: vec![
            ("controller.kind", Value::Text("disturbance_rejection")),
            observer,
            ("observer.bandwidth", Value::Real(observer_bandwidth)),
            ("observer.input_gain", Value::Real(input_gain)),
            ("controller.bandwidth", Value::Real(bandwidth)),
            ("controller.input_gain", Value::Real(input_gain)),
        ],
    }
}

fn laws() -> Vec<Law> {
    let [linear, nonlinear] = KINDS;
    vec![
        Law { name: "PID, as printed", parameters: Vec::new() },
        rejection("LESO wo = 300, wc = 60", linear, 300.0, 60.0, INPUT_GAIN),
        rejection("LESO wo = 400, wc = 80", linear, 400.0, 80.0, INPUT_GAIN),
        rejection("NESO of Table 4, b0 = -3705, wc = 40", nonlinear, 100.0, 40.0, INPUT_GAIN),
        rejection("LESO of Table 3, b0 = -3705, wc = 40", linear, 100.0, 40.0, INPUT_GAIN),
        rejection("LESO of Table 3, b0 = 1, wc = 60", linear, 100.0, 60.0, 1.0),
    ]
}

/// What a law made of the disturbance step.
pub struct Outcome {
    pub law: Law,
    /// Without and with noise, printed mass.
    pub runs: [Run; 2],
    /// rms of the control error after the disturbance step \[V\], without and with noise; none if the ball was lost.
    pub errors: [Option<f64>; 2],
    /// Largest control error after the disturbance step, without noise \[V\].
    pub peak: f64,
    /// rms change of the voltage from sample to sample with noise \[V\].
    pub effort: f64,
    /// Of [`MASS_RATIOS`], with noise: how many loops keep the ball.
    pub kept: usize,
}

pub fn compare(packages: &LoopPackages, progress: Progress<'_>) -> Result<Vec<Outcome>, StudyError> {
    sweep(&laws(), progress, "rig-observers: disturbance steps", |law| {
        let run = |noise: f64, mass_ratio: f64| {
            let disturbance_step = DISTURBANCE_STEP;
            let scenario = Scenario::new(Reference::Hold, DURATION, &law.parameters);
            simulate(packages, &Scenario { noise, mass_ratio, disturbance_step, ..scenario })
        };
        let runs = [run(0.0, 1.0)?, run(NOISE, 1.0)?];
        let kept = MASS_RATIOS
            .iter()
            .map(|ratio| Ok(usize::from(run(NOISE, *ratio)?.lost_at.is_none())))
            .sum::<Result<usize, StudyError>>()?;
        // y - r from the disturbance step on [V].
        let late =
            [0, 1].map(|which| runs[which].since(DISTURBANCE_STEP.1, &control_error(&runs[which])).to_vec());
        let errors = [0, 1].map(|which| {
            let error = root_mean_square(&late[which]);
            runs[which].lost_at.is_none().then_some(error)
        });
        let voltage = &runs[1]["controller.voltage"][500..];
        let effort = root_mean_square(difference(&voltage[1..], voltage));
        Ok(Outcome { peak: peak(&late[0]), errors, effort, kept, law: law.clone(), runs })
    })
}

pub fn table(outcomes: &[Outcome]) -> Summary {
    let rows = outcomes.iter().map(|outcome| {
        let error = |error: Option<f64>| {
            error.map_or("ball lost".to_owned(), |error| {
                format!("{:.2} mV, {:.4} mm", 1e3 * error, 1e3 * error / SENSOR.gain)
            })
        };
        let is_lost = outcome.errors[0].is_none();
        let unless_lost = |text: String| if is_lost { "-".to_owned() } else { text };
        vec![
            outcome.law.name.to_owned(),
            error(outcome.errors[0]),
            unless_lost(format!("{:.1} mV", 1e3 * outcome.peak)),
            error(outcome.errors[1]),
            unless_lost(quantity(outcome.effort, "V")),
            format!("{} of {}", outcome.kept, MASS_RATIOS.len()),
        ]
    });
    Summary::new(
        "A disturbance step of 1 m/s² at 9 mm: control error over the 2 s after it",
        [
            "law",
            "rms, no noise",
            "peak, no noise",
            "rms, 1 mV",
            "rms voltage step, 1 mV",
            "ball kept with -20, 0, +20 % mass, 1 mV",
        ],
        rows,
    )
}

pub fn figure(outcomes: &[Outcome]) -> FigureWithData {
    const TIME: &str = "time [s]";
    let (start, end) = (DISTURBANCE_STEP.1 - 0.02, DISTURBANCE_STEP.1 + 0.3);
    let panel = |title: &str, y: &str| Panel::new(title, TIME, y).between(start, end);
    let mut position = panel("no noise", "distance below 9 mm [mm]");
    let mut noisy = panel("sensor noise 1 mV", "distance below 9 mm [mm]");
    let mut voltage = panel("sensor noise 1 mV", "voltage u [V]");
    let mut table = Table::default();
    for (colour, outcome) in outcomes.iter().filter(|outcome| outcome.errors[0].is_some()).enumerate() {
        let name = outcome.law.name;
        let below = |run: &Run| -> Vec<(f64, f64)> {
            let positions = run.time.iter().zip(run.state("position"));
            positions.map(|(time, x)| (*time, 1e3 * (x - SET_POINT))).collect()
        };
        position = position.line(name, colour, below(&outcome.runs[0]));
        noisy = noisy.line("", colour, below(&outcome.runs[1]));
        voltage = voltage.held("", colour, outcome.runs[1].points("controller.voltage", 1.0));
        if table.columns.is_empty() {
            table.add("time [s]", &outcome.runs[0].time);
        }
        for (run, noise) in outcome.runs.iter().zip(["no noise", "noise 1 mV"]) {
            table.add(format!("{name}, {noise}: x [m]"), run.state("position"));
            table.add(format!("{name}, {noise}: u [V]"), &run["controller.voltage"]);
        }
    }
    FigureWithData::new("rig_force_step", "A disturbance step of 1 m/s²: PID against disturbance rejection", table)
        .caption(
            "Position and voltage around the disturbance step at 1 s. The PID's slow integral leaves an error that \
             disturbance rejection removes within 0.1 s. Loops that lose the ball are in the table only.",
        )
        .panels(3, [position, noisy, voltage])
}
