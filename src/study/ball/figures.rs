//! Figures 2 to 7, after what is left of their captions and of the text.

use super::runs::{FLUX_ERRORS, GAINS, POORLY_EXCITED_GAINS, RATES, Runs};
use super::scenario::{EXCITATION, FLUX_ERROR, REFERENCE, TRACKING_ERROR, carrying_flux};
use crate::chart::{Panel, Stroke};
use crate::study::findings::{FigureWithData, Labelled, STATES_AND_ESTIMATES, Table, labelled, lines};
use crate::study::run::Run;

const TIME: &str = "time [s]";
/// Magnitudes below this stand here on logarithmic axes, in the unit shown.
const FLOOR: f64 = 1e-5;

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

/// One line per run, until the ball is lost.
fn panel(
    title: &str,
    label: &str,
    runs: &[Labelled<'_>],
    stroke: Stroke,
    points: impl Fn(&Run) -> Vec<(f64, f64)>,
) -> Panel {
    lines(Panel::new(title, TIME, label), runs, stroke, |run| {
        let end = run.lost_at.unwrap_or(f64::INFINITY);
        points(run).into_iter().take_while(move |(time, _)| *time <= end)
    })
}

/// All panels but the first without a legend; lines keep their colours.
fn one_legend<const N: usize>(mut panels: [Panel; N]) -> [Panel; N] {
    for series in panels.iter_mut().skip(1).flat_map(|panel| &mut panel.series) {
        series.label.clear();
    }
    panels
}

/// Magnitudes on a logarithmic axis, times `factor`.
fn magnitudes(title: &str, label: &str, runs: &[Labelled<'_>], factor: f64, column: &str) -> Panel {
    let points = |run: &Run| run.magnitudes(&run[column], factor, FLOOR);
    panel(title, label, runs, Stroke::Solid, points).logarithmic()
}

/// The wanted position and the positions.
fn position_panel(title: &str, runs: &[Labelled<'_>]) -> Panel {
    let positions = |run: &Run| run.points("plant.position", 1e3);
    let panel = panel(title, "position y [mm]", runs, Stroke::Solid, positions);
    panel.dashed("wanted y*", 6, runs[0].1.points(REFERENCE, 1e3))
}

fn deviation_panel(title: &str, runs: &[Labelled<'_>]) -> Panel {
    magnitudes(title, "|y - y*| [mm]", runs, 1e3, TRACKING_ERROR)
}

fn flux_error_panel(runs: &[Labelled<'_>]) -> Panel {
    magnitudes("error of the flux estimate", "|error| / lam0 [%]", runs, 100.0, FLUX_ERROR)
}

fn excitation_panel(runs: &[Labelled<'_>]) -> Panel {
    magnitudes("excitation", "|kappa Delta| [1]", runs, 1.0, EXCITATION)
}

/// Error of the estimate of a state in mm or mm/s.
fn state_error_panel(state: &str, unit: &str, runs: &[Labelled<'_>]) -> Panel {
    let points = |run: &Run| run.magnitudes(&run.error(state), 1e3, FLOOR);
    let title = format!("error of the {state} estimate");
    panel(&title, &format!("|error| [{unit}]"), runs, Stroke::Solid, points).logarithmic()
}

/// Voltage up to `end` \[s\].
fn voltage_panel(title: &str, runs: &[Labelled<'_>], end: f64) -> Panel {
    let points = |run: &Run| run.points("controller.voltage", 1.0);
    panel(title, "voltage u [V]", runs, Stroke::Held, points).between(0.0, end)
}

/// Time and, per run, states, estimates, reference, current, voltage and excitation in SI units.
fn table(runs: &[Labelled<'_>]) -> Table {
    let others = [
        ("plant.current", "current [A]"),
        ("controller.voltage", "voltage [V]"),
        (EXCITATION, "excitation [1]"),
    ];
    let each = [&STATES_AND_ESTIMATES[..], &others].concat();
    Table::of_runs(runs, &[(REFERENCE, "reference [m]")], &each)
}

/// Figures 2 and 3.
fn flux_errors(number: u32, name: &str, runs: &[Run], full_state: &Run, shown: f64) -> FigureWithData {
    let mut runs = labelled(&FLUX_ERRORS, |error| format!("flux offset {:+.0} %", 100.0 * error), runs);
    let tracking = |run: &Run| run.points(TRACKING_ERROR, 1e3);
    let panels = one_legend([
        position_panel("position", &runs).between(0.0, shown),
        panel("deviation from the wanted position", "y - y* [mm]", &runs, Stroke::Solid, tracking)
            .between(0.0, shown),
        deviation_panel("deviation, magnitude", &runs),
        flux_error_panel(&runs),
        excitation_panel(&runs),
        voltage_panel("voltage, first 0.3 s", &runs, 0.3),
    ]);
    runs.push(("true state fed back".to_owned(), full_state));
    let title = format!("Figure {number}: initial flux offsets, {name}, DREM");
    FigureWithData::new(format!("ball_figure_{number}"), title, table(&runs))
        .caption(format!(
            "Figure {number}. Position for the {name} when the observer starts with a flux that is too \
             small or too large by 5 and 10 % of lam0, the flux that carries the ball; the estimate of the \
             offset is held for the first 0.1 s. Sampled at 0.1 ms, rows of 1 ms. Magnitudes below \
             {FLOOR:e} stand there."
        ))
        .panels(3, panels)
}

/// Figures 4 and 5.
fn gains(number: u32, name: &str, runs: &[Run]) -> FigureWithData {
    let runs = labelled(&GAINS, |gain| format!("gamma = {gain} 1/s"), runs);
    let panels = one_legend([
        flux_error_panel(&runs),
        state_error_panel("velocity", "mm/s", &runs),
        state_error_panel("position", "mm", &runs),
        position_panel("position", &runs).between(0.0, 4.0),
        deviation_panel("deviation from y*", &runs),
        excitation_panel(&runs),
    ]);
    let title = format!("Figure {number}: adaptation gains, {name}, DREM, flux offset +10 %");
    FigureWithData::new(format!("ball_figure_{number}"), title, table(&runs))
        .caption(format!(
            "Figure {number}. Effect of the adaptation gain gamma on the observation errors for the {name}. \
             The unit of gamma goes with kappa, 1e9 for the sinusoids and 1e10 for the steps."
        ))
        .panels(3, panels)
}

fn figure_6(runs: &Runs) -> FigureWithData {
    let runs = labelled(&RATES, |rate| format!("w_p = w_y = {rate} 1/s"), &runs.rates);
    let panels = one_legend([
        state_error_panel("velocity", "mm/s", &runs),
        state_error_panel("position", "mm", &runs),
        flux_error_panel(&runs),
        position_panel("position", &runs).between(0.0, 1.0),
        deviation_panel("deviation from y*", &runs),
        voltage_panel("voltage, first 0.5 s", &runs, 0.5),
    ]);
    let title = "Figure 6: gains of the speed and position observers, sinusoids, flux offset +10 %";
    FigureWithData::new("ball_figure_6", title, table(&runs))
        .caption(
            "Figure 6. The paper shows its observer for different values of a symbol that is lost; taken \
             here for the gains of the speed and position observers. With small ones the start throws the \
             ball against the magnet, where its line ends.",
        )
        .panels(3, panels)
}

fn figure_7(runs: &Runs) -> FigureWithData {
    let label = |gain: &f64| format!("gamma = {gain} 1/s");
    let poor = labelled(&POORLY_EXCITED_GAINS, label, &runs.poorly_excited);
    let well = labelled(&POORLY_EXCITED_GAINS, label, &runs.well_started);
    let percent = |title: &str, runs: &[Labelled<'_>]| {
        let points = |run: &Run| run.magnitudes(&run[FLUX_ERROR], 100.0, 0.0);
        panel(title, "|flux error| / lam0 [%]", runs, Stroke::Solid, points)
    };
    // The square of the excitation summed up is what moves the estimate.
    let energy = |title: &str, runs: &[Labelled<'_>]| {
        let points = |run: &Run| {
            let sums = run[EXCITATION].iter().scan(0.0, |sum, excitation| {
                *sum += excitation * excitation * 1e-3;
                Some(f64::max(*sum, 1e-20))
            });
            run.time.iter().copied().zip(sums).collect()
        };
        let label = "integral of (kappa Delta)^2 [s]";
        panel(title, label, &runs[..1], Stroke::Solid, points).logarithmic()
    };
    let in_the_loop = [("gamma = 1 1/s".to_owned(), &runs.poorly_excited_loop[0])];
    let panels = one_legend([
        percent("filters start from zero, no hold", &poor),
        percent("the same, first 0.1 s", &poor).between(0.0, 0.1),
        percent("filters start from a ball at rest, no hold", &well).from_to(8.0, 15.0),
        energy("energy of the excitation, filters from zero", &poor),
        energy("energy, filters from a ball at rest", &well),
        position_panel("estimates fed back, gamma = 1 1/s (dashed: y*)", &in_the_loop),
    ]);
    let starts = [("from zero", &poor), ("from rest", &well)].into_iter();
    let all: Vec<Labelled<'_>> = starts
        .flat_map(|(start, runs)| runs.iter().map(move |(label, run)| (format!("{start}: {label}"), *run)))
        .collect();
    let title = "Figure 7: a steady-state error that grows with the adaptation gain";
    FigureWithData::new("ball_figure_7", title, table(&all))
        .caption(format!(
            "Figure 7. The paper's last figure shows a steady-state error that grows with the adaptation \
             gain. A hypothesis that reproduces it: filters that start from zero, no start-up hold, and \
             little excitation (kappa = 1e4 instead of 1e10, steps, the observer only watching). The wrong \
             start then enters the estimate in proportion to the gain and nothing forgets it. lam0 = {:.3} \
             mWb.",
            1e3 * carrying_flux()
        ))
        .panels(3, panels)
}
