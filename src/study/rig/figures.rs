//! Figures 3 and 5 of the paper as its text describes them, and what the comparison and the swarm showed.

use super::observers::NAMES;
use super::ranking::{Comparison, MEASUREMENTS, NOISES, REFERENCES, Start};
use super::recording::SENSOR;
use super::simulation::{ESTIMATES, Measurement, truth};
use crate::chart::{Panel, Series, Stroke};
use crate::observer::fal::Fal;
use crate::study::findings::{FigureWithData, Table};
use crate::study::run::Run;

const TIME: &str = "time [s]";
/// Length of the enlarged start \[s\].
const START: f64 = 0.1;

/// When the reference jumps \[s\].
const STEP: f64 = 2.0;

/// fal for several exponents, in the linear zone and beyond.
pub fn nonlinear_gain() -> FigureWithData {
    const LINEAR_ZONE: f64 = 0.1;
    const EXPONENTS: [f64; 4] = [1.0, 0.75, 0.5, 0.25];
    let errors: Vec<f64> = (-500..=500).map(|k| f64::from(k) * 2e-3).collect();
    let mut table = Table::default();
    table.add("error e [1]", &errors);
    let panel = |title: &str| Panel::new(title, "error e [1]", "fal(e) [1]");
    let mut whole = panel("fal(e) = e / delta^(1 - alpha) up to delta = 0.1, |e|^alpha beyond");
    let mut zone = panel("around the linear zone").between(-0.2, 0.2).from_to(-0.8, 0.8);
    for (colour, exponent) in EXPONENTS.into_iter().enumerate() {
        let function = Fal::new(exponent, LINEAR_ZONE);
        let values: Vec<f64> = errors.iter().map(|error| function.value(*error)).collect();
        let label =
            if exponent == 1.0 { "alpha = 1, linear".to_owned() } else { format!("alpha = {exponent}") };
        let points = || errors.iter().copied().zip(values.iter().copied());
        whole = whole.line(label, colour, points());
        zone = zone.line("", colour, points());
        table.add(format!("alpha = {exponent} [1]"), &values);
    }
    FigureWithData::new("rig_figure_3", "Figure 3: linear and nonlinear gain", table)
        .caption(
            "The nonlinear gain of NESO: small errors weigh more, large ones less; with alpha = 1 it is \
             linear.",
        )
        .panels(2, [whole, zone])
}

/// How a component is shown: name, unit, factor.
type Quantity = (&'static str, &'static str, f64);
const METRES: [Quantity; 3] =
    [("position", "mm", 1e3), ("velocity", "m/s", 1.0), ("extended state x'' - u", "m/s²", 1.0)];

/// Truth and both estimates: the start-up of Table 5, and a moving reference after a steady start.
pub fn estimates(start_up: &[Run; 2], moving: &[Run; 2], input_gain: f64) -> FigureWithData {
    let mut panels = Vec::new();
    let mut table = Table::default();
    let rows = [
        (start_up, Measurement::Metres, "from zero", Some((0.0, START))),
        (moving, Measurement::Volts, "around the step", Some((STEP - 0.02, STEP + 0.2))),
    ];
    for (runs, measurement, row, range) in rows {
        let truth = truth(&runs[0], measurement, input_gain);
        let offset = match measurement {
            Measurement::Metres => 0.0,
            Measurement::Volts => SENSOR.offset,
        };
        // All in metres, whatever the observer's unit.
        let scale = if measurement == Measurement::Volts { 1.0 / SENSOR.gain } else { 1.0 };
        table.add(format!("{row}: time [s]"), &runs[0].time);
        for (state, (name, unit, factor)) in METRES.into_iter().enumerate() {
            let shift = if state == 0 { offset } else { 0.0 };
            let shifted =
                |values: &[f64]| -> Vec<f64> { values.iter().map(|value| scale * (value - shift)).collect() };
            let si_unit = ["m", "m/s", "m/s2"][state];
            let mut add = |who: &str, values: &[f64]| -> Vec<(f64, f64)> {
                table.add(format!("{row}: {name} {who} [{si_unit}]"), shifted(values));
                let points = runs[0].time.iter().zip(values);
                points.map(|(time, value)| (*time, factor * scale * (value - shift))).collect()
            };
            let mut panel = Panel::new(format!("{name}, {row}"), TIME, format!("{name} [{unit}]"));
            panel.x_range = range;
            let legend = |text: &str| if state == 0 { text.to_owned() } else { String::new() };
            panel = panel.line(legend("true"), 6, add("true", &truth[state]));
            for (who, run) in runs.iter().enumerate() {
                panel =
                    panel.dashed(legend(NAMES[who]), who, add(NAMES[who], run.estimate(ESTIMATES[state])));
            }
            panels.push(panel);
        }
    }
    let title = "Figure 5: position, velocity and extended state by LESO and NESO, printed parameters";
    FigureWithData::new("rig_figure_5", title, table)
        .caption(
            "Above: the start from zero estimates at 8.5 mm in metres, which is all that Table 5 measures. \
             Below: sine and step of the reference, observers in sensor volts from a steady start, shown in \
             metres.",
        )
        .panels(3, panels)
}

/// Who is better: rms errors of NESO over LESO against the sensor's noise.
pub fn ranking(comparisons: &[Comparison]) -> FigureWithData {
    let mut panels = Vec::new();
    let mut table = Table::default();
    table.add("sensor noise [V]", NOISES);
    for (start, start_name) in [(Start::FromZero, "from zero"), (Start::Steady, "steady start")] {
        for (measurement, unit) in MEASUREMENTS {
            let mut panel = Panel::new(
                format!("z1 in {unit}, {start_name}"),
                "standard deviation of the sensor [V]",
                "rms e1, NESO over LESO [1]",
            )
            .x_logarithmic()
            .from_to(0.0, 2.0);
            for (reference, (_, name)) in REFERENCES.iter().enumerate() {
                let row: Vec<&Comparison> = comparisons
                    .iter()
                    .filter(|case| {
                        (case.measurement, case.start, case.reference) == (measurement, start, reference)
                    })
                    .collect();
                let label = if panels.is_empty() { *name } else { "" };
                let points = row
                    .iter()
                    .filter(|case| case.linear_wins().is_some())
                    .map(|case| (case.noise, case.ratios[0]));
                panel = panel.line(label, reference, points);
                for (state, component) in ["z1", "z2", "z3"].iter().enumerate() {
                    let header = format!("{unit}; {start_name}; {name}: NESO over LESO of {component} [1]");
                    table.add(header, row.iter().map(|case| case.ratios[state]));
                }
            }
            let ends = [(NOISES[1], 1.0), (NOISES[NOISES.len() - 1], 1.0)];
            let label = if panels.is_empty() { "equally good" } else { "" };
            panels.push(panel.dashed(label, 6, ends));
        }
    }
    FigureWithData::new("rig_ranking", "Is LESO better than NESO? Above 1 it is", table)
        .caption(
            "Root mean square error of the position estimate with the printed parameters, NESO over LESO, \
             10 s. From zero the start-up transient decides, alone and with opposite results in metres and \
             in volts; from a steady start noise and the motion do. Runs without noise are in the table.",
        )
        .panels(2, panels)
}

/// z1 of NESO with Table 4 by three discretisations at 1 ms, from zero estimates.
pub fn discretisations(runs: &[(&'static str, Run)]) -> FigureWithData {
    // Room for the legend above.
    let mut whole = Panel::new("z1 of NESO, Table 4, T = 1 ms", TIME, "estimated position [mm]")
        .between(0.0, 0.3)
        .from_to(-20.0, 70.0);
    let mut start = Panel::new("the first 60 ms", TIME, "estimated position [mm]").between(0.0, 0.06);
    let mut table = Table::default();
    table.add("time [s]", &runs[0].1.time);
    for (colour, (name, run)) in runs.iter().enumerate() {
        let points = || run.points("controller.estimate.position", 1e3);
        // The last lies on the one before.
        let stroke = if colour == 2 { Stroke::Dashed } else { Stroke::Solid };
        whole = whole.with(Series::new(*name, colour, stroke, points()));
        start = start.with(Series::new("", colour, stroke, points()));
        table.add(format!("{name}: z1 [m]"), run.estimate("position"));
    }
    let title = "NESO at the paper's sample time: how it is solved decides whether it works";
    FigureWithData::new("rig_discretisation", title, table)
        .caption(
            "The ball rests at 9 mm, observer in metres from zero. By forward Euler the printed parameters \
             are unstable above 0.67 ms and end in a limit cycle; Runge-Kutta and the frozen-gain exact \
             solution settle.",
        )
        .panels(2, [whole, start])
}
