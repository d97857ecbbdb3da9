//! How fast the laws bring the rotor to the centre: the printed law (8a) against the flux cascade, on estimates.

use crate::chart::{Figure, Panel, Series, Stroke};
use crate::host::{Trace, Value};
use crate::study::loop_packages::{LoopPackages, Parameter};
use crate::study::report::quantity;
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

/// Worst figures of a setting over all starts.
struct Outcome {
    /// Time \[s\] from which on |x1| stays below [`SETTLED`]; infinite if it does not.
    settling_time: f64,
    /// Largest |x1| \[m\] in the last second.
    rest: f64,
    /// Largest |u| \[V\].
    voltage: f64,
}

/// The figure and the table.
pub fn compare(packages: &LoopPackages) -> Result<(FigureWithData, Summary), StudyError> {
    let mut position = Panel::new("position, x1(0) = 10 mm, u(0) = -150 V", "time [s]", "position x1 [mm]");
    let mut distance = Panel::new("distance from the centre", "time [s]", "|x1| [mm]").logarithmic();
    let mut voltage = Panel::new("voltage, first 0.2 s", "time [s]", "voltage u [V]").between(0.0, 0.2);
    let mut table = Table::default();
    let mut rows = Vec::new();
    for (colour, setting) in SETTINGS.iter().enumerate() {
        let trace = simulate(packages, setting, 0.01, -150.0, 0.0)?;
        let column = |name: &str| trace.column(name).unwrap_or_default().to_vec();
        let (x, u) = (column("plant.position"), column("controller.voltage"));
        let over_time = |values: &[f64], factor: f64| -> Vec<(f64, f64)> {
            trace.time.iter().zip(values).map(|(t, value)| (*t, factor * value)).collect()
        };
        let magnitudes: Vec<f64> = x.iter().map(|x| x.abs()).collect();
        position = position.with(Series::new(setting.name, colour, Stroke::Solid, over_time(&x, 1e3)));
        distance = distance.with(Series::new("", colour, Stroke::Solid, over_time(&magnitudes, 1e3)));
        voltage = voltage.with(Series::new("", colour, Stroke::Held, over_time(&u, 1.0)));
        if table.columns.is_empty() {
            table.headers.push("time [s]".to_owned());
            table.columns.push(trace.time.clone());
        }
        let name = setting.name.replace(',', "");
        table.headers.extend([format!("{name}: position [m]"), format!("{name}: voltage [V]")]);
        table.columns.extend([x, u]);

        let outcome = worst(packages, setting)?;
        rows.push(vec![
            setting.name.to_owned(),
            if outcome.settling_time.is_finite() {
                quantity(outcome.settling_time, "s")
            } else {
                format!("not within {DURATION} s")
            },
            quantity(outcome.rest, "m"),
            quantity(outcome.voltage, "V"),
        ]);
    }
    let figure = Figure {
        title: "A law that settles: flux cascade with feed-forward against law (8a)".to_owned(),
        caption: "Position and voltage of the loop on estimates. The flux cascade is not from the paper."
            .to_owned(),
        columns: 3,
        panels: vec![position, distance, voltage],
    };
    let summary = Summary {
        title: format!(
            "Worst of {} starts of Table 1, epsilon = 0 and 0.0909: settling to {SETTLED:e} m",
            POSITIONS.len() * VOLTAGES.len()
        ),
        headers: ["law, observer, sensor", "settled from", "largest |x1| from 4 to 5 s", "largest |u|"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    };
    Ok((FigureWithData { name: "bearing_flux_cascade".to_owned(), figure, table }, summary))
}

fn worst(packages: &LoopPackages, setting: &Setting) -> Result<Outcome, StudyError> {
    let mut worst = Outcome { settling_time: 0.0, rest: 0.0, voltage: 0.0 };
    for position in POSITIONS {
        for voltage in VOLTAGES {
            for bias in BIAS_FLUXES {
                let outcome = judge(&simulate(packages, setting, position, voltage, bias)?);
                worst.settling_time = worst.settling_time.max(outcome.settling_time);
                worst.rest = worst.rest.max(outcome.rest);
                worst.voltage = worst.voltage.max(outcome.voltage);
            }
        }
    }
    Ok(worst)
}

fn judge(trace: &Trace) -> Outcome {
    let position = trace.column("plant.position").unwrap_or_default();
    let last = position.iter().rposition(|x| x.abs() > SETTLED);
    let settling_time = match last {
        None => 0.0,
        Some(last) => trace.time.get(last + 1).copied().unwrap_or(f64::INFINITY),
    };
    let largest = |values: &mut dyn Iterator<Item = &f64>| values.fold(0.0, |peak: f64, x| peak.max(x.abs()));
    let end = trace.time.iter().zip(position).filter(|(t, _)| **t >= DURATION - 1.0);
    Outcome {
        settling_time,
        rest: largest(&mut end.map(|(_, x)| x)),
        voltage: largest(&mut trace.column("controller.voltage").unwrap_or_default().iter()),
    }
}

fn simulate(
    packages: &LoopPackages,
    setting: &Setting,
    initial_position: f64,
    initial_voltage: f64,
    bias_flux: f64,
) -> Result<Trace, StudyError> {
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
