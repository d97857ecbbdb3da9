//! Figures 2 to 7, after what is left of their captions and of the text.

use super::runs::{FLUX_ERRORS, GAINS, POORLY_EXCITED_GAINS, RATES, Runs};
use super::scenario::{FLUX, POSITION, Run, VELOCITY, carrying_flux};
use crate::chart::{Figure, Panel, Series, Stroke};
use crate::study::{FigureWithData, Table};

const TIME: &str = "time [s]";
/// Magnitudes below this stand here on logarithmic axes, in the unit shown.
const FLOOR: f64 = 1e-5;

/// A run with its legend entry.
type Labelled<'a> = (String, &'a Run);

pub fn all(runs: &Runs) -> Vec<FigureWithData> {
    vec![
        flux_errors(2, "sinusoids", &runs.flux_errors[0], &runs.state_feedback[0], 1.5),
        flux_errors(3, "steps", &runs.flux_errors[1], &runs.state_feedback[1], 6.0),
        gains(4, "sinusoids", &runs.gains[0]),
        gains(5, "steps", &runs.gains[1]),
        figure_6(runs),
        figure_7(runs),
    ]
}

/// One line per run.
fn panel(
    title: &str,
    label: &str,
    runs: &[Labelled<'_>],
    stroke: Stroke,
    column: impl Fn(&Run) -> Vec<f64>,
) -> Panel {
    runs.iter().enumerate().fold(Panel::new(title, TIME, label), |panel, (colour, (name, run))| {
        let end = run.lost_at.unwrap_or(f64::INFINITY);
        let points = run.time.iter().copied().zip(column(run)).take_while(|(time, _)| *time <= end);
        panel.with(Series::new(name, colour, stroke, points))
    })
}

/// All panels but the first without a legend; lines keep their colours.
fn one_legend(mut panels: Vec<Panel>) -> Vec<Panel> {
    for series in panels.iter_mut().skip(1).flat_map(|panel| &mut panel.series) {
        series.label.clear();
    }
    panels
}

/// Magnitudes on a logarithmic axis, times `factor`.
fn magnitudes(
    title: &str,
    label: &str,
    runs: &[Labelled<'_>],
    factor: f64,
    column: impl Fn(&Run) -> Vec<f64>,
) -> Panel {
    let column = |run: &Run| column(run).iter().map(|value| (factor * value.abs()).max(FLOOR)).collect();
    panel(title, label, runs, Stroke::Solid, column).logarithmic()
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

/// The wanted position and the positions.
fn position_panel(title: &str, runs: &[Labelled<'_>]) -> Panel {
    let mut panel =
        panel(title, "position y [mm]", runs, Stroke::Solid, |run| scaled(&run.state[POSITION], 1e3));
    if let Some((_, run)) = runs.first() {
        let points = run.time.iter().copied().zip(scaled(&run.reference, 1e3));
        panel.series.push(Series::new("wanted y*", 6, Stroke::Dashed, points));
    }
    panel
}

fn flux_error_panel(runs: &[Labelled<'_>]) -> Panel {
    magnitudes("error of the flux estimate", "|error| / lam0 [%]", runs, 100.0, Run::flux_error)
}

fn excitation_panel(runs: &[Labelled<'_>]) -> Panel {
    let (title, label) = ("excitation", "|kappa Delta| [1]");
    magnitudes(title, label, runs, 1.0, |run| run.excitation.clone())
}

fn mechanical_panels(runs: &[Labelled<'_>]) -> [Panel; 2] {
    [
        magnitudes("error of the velocity estimate", "|error| [mm/s]", runs, 1e3, |run| run.error(VELOCITY)),
        magnitudes("error of the position estimate", "|error| [mm]", runs, 1e3, |run| run.error(POSITION)),
    ]
}

/// Time and, per run, states, estimates, reference, current, voltage and excitation in SI units.
fn table(runs: &[Labelled<'_>]) -> Table {
    let mut table = Table::default();
    let mut add = |header: String, column: &[f64]| {
        table.headers.push(header);
        table.columns.push(column.to_vec());
    };
    if let Some((_, run)) = runs.first() {
        add("time [s]".to_owned(), &run.time);
        add("reference [m]".to_owned(), &run.reference);
    }
    for (label, run) in runs {
        for (state, (name, unit)) in
            [("position", "m"), ("velocity", "m/s"), ("flux", "Wb")].iter().enumerate()
        {
            add(format!("{label}: {name} [{unit}]"), &run.state[state]);
            add(format!("{label}: estimate of {name} [{unit}]"), &run.estimate[state]);
        }
        add(format!("{label}: current [A]"), &run.current);
        add(format!("{label}: voltage [V]"), &run.voltage);
        add(format!("{label}: excitation [1]"), &run.excitation);
    }
    table
}

fn with_table(number: u32, figure: Figure, runs: &[Labelled<'_>]) -> FigureWithData {
    FigureWithData { name: format!("ball_figure_{number}"), figure, table: table(runs) }
}

/// Figures 2 and 3.
fn flux_errors(number: u32, name: &str, runs: &[Run], full_state: &Run, shown: f64) -> FigureWithData {
    let labels = FLUX_ERRORS.iter().map(|error| format!("flux offset {:+.0} %", 100.0 * error));
    let mut runs: Vec<Labelled<'_>> = labels.zip(runs).collect();
    let tracking = |title: &str, runs: &[Labelled<'_>]| {
        panel(title, "y - y* [mm]", runs, Stroke::Solid, |run| scaled(&run.tracking_error(), 1e3))
    };
    let panels = vec![
        position_panel("position", &runs).between(0.0, shown),
        tracking("deviation from the wanted position", &runs).between(0.0, shown),
        magnitudes("deviation, magnitude", "|y - y*| [mm]", &runs, 1e3, Run::tracking_error),
        flux_error_panel(&runs),
        excitation_panel(&runs),
        panel("voltage, first 0.3 s", "voltage u [V]", &runs, Stroke::Held, |run| run.voltage.clone())
            .between(0.0, 0.3),
    ];
    let figure = Figure {
        title: format!("Figure {number}: initial flux offsets, {name}, DREM"),
        caption: format!(
            "Figure {number}. Position for the {name} when the observer starts with a flux that is too small \
             or too large by 5 and 10 % of lam0, the flux that carries the ball; the estimate of the offset is held for the first 0.1 s. Sampled at 0.1 ms, rows of \
             1 ms. Magnitudes below {FLOOR:e} stand there."
        ),
        columns: 3,
        panels: one_legend(panels),
    };
    runs.push(("true state fed back".to_owned(), full_state));
    with_table(number, figure, &runs)
}

/// Figures 4 and 5.
fn gains(number: u32, name: &str, runs: &[Run]) -> FigureWithData {
    let labels = GAINS.iter().map(|gain| format!("gamma = {gain} 1/s"));
    let runs: Vec<Labelled<'_>> = labels.zip(runs).collect();
    let mut panels = vec![flux_error_panel(&runs)];
    panels.extend(mechanical_panels(&runs));
    panels.push(position_panel("position", &runs).between(0.0, 4.0));
    panels.push(magnitudes("deviation from y*", "|y - y*| [mm]", &runs, 1e3, Run::tracking_error));
    panels.push(excitation_panel(&runs));
    let figure = Figure {
        title: format!("Figure {number}: adaptation gains, {name}, DREM, flux offset +10 %"),
        caption: format!(
            "Figure {number}. Effect of the adaptation gain gamma on the observation errors for the {name}. The unit of \
             gamma goes with kappa, 1e9 for the sinusoids and 1e10 for the steps."
        ),
        columns: 3,
        panels: one_legend(panels),
    };
    with_table(number, figure, &runs)
}

fn figure_6(runs: &Runs) -> FigureWithData {
    let labels = RATES.iter().map(|rate| format!("w_p = w_y = {rate} 1/s"));
    let runs: Vec<Labelled<'_>> = labels.zip(&runs.rates).collect();
    let mut panels = mechanical_panels(&runs).to_vec();
    panels.push(flux_error_panel(&runs));
    panels.push(position_panel("position", &runs).between(0.0, 1.0));
    panels.push(magnitudes("deviation from y*", "|y - y*| [mm]", &runs, 1e3, Run::tracking_error));
    panels.push(
        panel("voltage, first 0.5 s", "voltage u [V]", &runs, Stroke::Held, |run| run.voltage.clone())
            .between(0.0, 0.5),
    );
    let figure = Figure {
        title: "Figure 6: gains of the speed and position observers, sinusoids, flux offset +10 %".to_owned(),
        caption:
            "Figure 6. The paper shows its observer for different values of a symbol that is lost; taken here \
                  for the gains of the speed and position observers. With small ones the start throws the ball \
                  against the magnet, where its line ends."
                .to_owned(),
        columns: 3,
        panels: one_legend(panels),
    };
    with_table(6, figure, &runs)
}

fn figure_7(runs: &Runs) -> FigureWithData {
    let label = |gain: &f64| format!("gamma = {gain} 1/s");
    let poor: Vec<Labelled<'_>> = POORLY_EXCITED_GAINS.iter().map(label).zip(&runs.poorly_excited).collect();
    let well: Vec<Labelled<'_>> = POORLY_EXCITED_GAINS.iter().map(label).zip(&runs.well_started).collect();
    let percent = |title: &str, runs: &[Labelled<'_>]| {
        panel(title, "|flux error| / lam0 [%]", runs, Stroke::Solid, |run| {
            run.flux_error().iter().map(|error| 100.0 * error.abs()).collect()
        })
    };
    // The square of the excitation summed up is what moves the estimate.
    let energy = |run: &Run| {
        run.excitation
            .iter()
            .scan(0.0, |sum, excitation| {
                *sum += excitation * excitation * 1e-3;
                Some(f64::max(*sum, 1e-20))
            })
            .collect::<Vec<f64>>()
    };
    let panels = vec![
        percent("filters start from zero, no hold", &poor),
        percent("the same, first 0.1 s", &poor).between(0.0, 0.1),
        percent("filters start from a ball at rest, no hold", &well).from_to(8.0, 15.0),
        panel(
            "energy of the excitation, filters from zero",
            "integral of (kappa Delta)^2 [s]",
            &poor[..1],
            Stroke::Solid,
            energy,
        )
        .logarithmic(),
        panel(
            "energy, filters from a ball at rest",
            "integral of (kappa Delta)^2 [s]",
            &well[..1],
            Stroke::Solid,
            energy,
        )
        .logarithmic(),
        position_panel(
            "estimates fed back, gamma = 1 1/s (dashed: y*)",
            &[("gamma = 1 1/s".to_owned(), &runs.poorly_excited_loop[0])],
        ),
    ];
    let figure = Figure {
        title: "Figure 7: a steady-state error that grows with the adaptation gain".to_owned(),
        caption: format!(
            "Figure 7. The paper's last figure shows a steady-state error that grows with the adaptation gain. A \
             hypothesis that reproduces it: filters that start from zero, no start-up hold, and little excitation \
             (kappa = 1e4 instead of 1e10, steps, the observer only watching). The wrong start then enters the estimate in \
             proportion to the gain and nothing forgets it. lam0 = {:.3} mWb.",
            1e3 * carrying_flux()
        ),
        columns: 3,
        panels: one_legend(panels),
    };
    let named = |prefix: &str, runs: &[Labelled<'_>]| -> Vec<(String, usize)> {
        runs.iter().enumerate().map(|(k, (label, _))| (format!("{prefix}: {label}"), k)).collect()
    };
    let mut all: Vec<Labelled<'_>> =
        named("from zero", &poor).into_iter().map(|(name, k)| (name, poor[k].1)).collect();
    all.extend(named("from rest", &well).into_iter().map(|(name, k)| (name, well[k].1)));
    debug_assert!(all.iter().all(|(_, run)| run.state[FLUX].len() == all[0].1.state[FLUX].len()));
    with_table(7, figure, &all)
}
