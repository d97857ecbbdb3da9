//! How fast the laws bring the rotor to the centre: the printed law (8a) against the flux cascade, on estimates.

use crate::chart::Panel;
use crate::host::Value;
use crate::study::loop_packages::{LoopPackages, Parameter};
use crate::study::metrics::{largest, peak};
use crate::study::report::quantity;
use crate::study::run::Run;
use crate::study::sweep::indices;
use crate::study::{FigureWithData, StudyError, Summary, Table};

/// Starts of Table 1: x1(0) \[m\] and u(0) \[V\].
const POSITIONS: [f64; 3] = [0.0, 0.001, 0.01];
const VOLTAGES: [f64; 3] = [-50.0, -100.0, -150.0];
/// Bias fluxes \[Wb\]: epsilon = 0 and 0.0909.
const BIAS_FLUXES: [f64; 2] = [0.0, 100e-6];
const SAMPLE_TIME: f64 = 1e-3;
const DURATION: f64 = 5.0;
/// Displacement \[m\] below which the rotor counts as settled.
const SETTLED: f64 = 1e-5;

/// A law with an observer and a sensor.
struct Setting {
    name: &'static str,
    parameters: &'static [Parameter<'static>],
    /// Standard deviation of the sensor \[m\].
    noise: f64,
}

const SETTINGS: [Setting; 4] = [
    Setting { name: "law (8a), Newton, no noise", parameters: &[], noise: 0.0 },
    Setting {
        name: "flux cascade, Newton, no noise",
        parameters: &[
            ("controller.law", Value::Text("flux_cascade")),
            ("observer.map", Value::Text("exact")),
        ],
        noise: 0.0,
    },
    Setting {
        name: "flux cascade, Kalman, no noise",
        parameters: &[
            ("controller.law", Value::Text("flux_cascade")),
            ("observer.kind", Value::Text("kalman")),
        ],
        noise: 0.0,
    },
    Setting {
        name: "flux cascade, Kalman, noise 1e-7 m",
        parameters: &[
            ("controller.law", Value::Text("flux_cascade")),
            ("observer.kind", Value::Text("kalman")),
            ("observer.position_noise", Value::Real(1e-7)),
        ],
        noise: 1e-7,
    },
];

/// The figure and the table.
pub fn compare(packages: &LoopPackages) -> Result<(FigureWithData, Summary), StudyError> {
    let mut position = Panel::new("position, x1(0) = 10 mm, u(0) = -150 V", "time [s]", "position x1 [mm]");
    let mut distance = Panel::new("distance from the centre", "time [s]", "|x1| [mm]").logarithmic();
    let mut voltage = Panel::new("voltage, first 0.2 s", "time [s]", "voltage u [V]").between(0.0, 0.2);
    let mut runs = Vec::new();
    let mut rows = Vec::new();
    for (colour, setting) in SETTINGS.iter().enumerate() {
        let run = simulate(packages, setting, 0.01, -150.0, 0.0)?;
        position = position.line(setting.name, colour, run.points("plant.position", 1e3));
        distance = distance.line("", colour, run.magnitudes(run.state("position"), 1e3, 0.0));
        voltage = voltage.held("", colour, run.points("controller.voltage", 1.0));
        runs.push((setting.name.replace(',', ""), run));
        rows.push(row(packages, setting)?);
    }
    let runs: Vec<_> = runs.iter().map(|(name, run)| (name.clone(), run)).collect();
    let each = [("plant.position", "position [m]"), ("controller.voltage", "voltage [V]")];
    let title = "A law that settles: flux cascade with feed-forward against law (8a)";
    let figure = FigureWithData::new("bearing_flux_cascade", title, Table::of_runs(&runs, &[], &each))
        .caption("Position and voltage of the loop on estimates. The flux cascade is not from the paper.")
        .panels(3, [position, distance, voltage]);
    let title = format!(
        "Worst of {} starts of Table 1, epsilon = 0 and 0.0909: settling to {SETTLED:e} m",
        POSITIONS.len() * VOLTAGES.len()
    );
    let headers = ["law, observer, sensor", "settled from", "largest |x1| from 4 to 5 s", "largest |u|"];
    Ok((figure, Summary::new(title, headers, rows)))
}

/// The worst of a setting over all starts.
fn row(packages: &LoopPackages, setting: &Setting) -> Result<Vec<String>, StudyError> {
    let starts = indices([POSITIONS.len(), VOLTAGES.len(), BIAS_FLUXES.len()]);
    let simulate = |[position, voltage, bias]: [usize; 3]| {
        simulate(packages, setting, POSITIONS[position], VOLTAGES[voltage], BIAS_FLUXES[bias])
    };
    let runs = starts.into_iter().map(simulate).collect::<Result<Vec<Run>, StudyError>>()?;
    let settled = largest(runs.iter().map(|run| run.settled(run.state("position"), SETTLED)));
    let rest = largest(runs.iter().map(|run| peak(run.last(1.0, run.state("position")))));
    let voltage = largest(runs.iter().map(|run| peak(&run["controller.voltage"])));
    Ok(vec![
        setting.name.to_owned(),
        if settled.is_finite() { quantity(settled, "s") } else { format!("not within {DURATION} s") },
        quantity(rest, "m"),
        quantity(voltage, "V"),
    ])
}

fn simulate(
    packages: &LoopPackages,
    setting: &Setting,
    initial_position: f64,
    initial_voltage: f64,
    bias_flux: f64,
) -> Result<Run, StudyError> {
    let mut controller = vec![
        ("controller.initial_voltage", Value::Real(initial_voltage)),
        ("bias_flux", Value::Real(bias_flux)),
    ];
    controller.extend_from_slice(setting.parameters);
    packages.simulate(
        &[
            ("initial.position", Value::Real(initial_position)),
            ("bias_flux", Value::Real(bias_flux)),
            ("sensor.noise", Value::Real(setting.noise)),
        ],
        &controller,
        &[("plant", "position"), ("controller", "voltage")],
        SAMPLE_TIME,
        DURATION,
    )
}
