//! Figures 2 to 6, laid out as their captions say.

use super::runs::{BIAS_FLUXES, LAWS, POSITIONS, Runs, VOLTAGES};
use crate::chart::{Panel, Stroke};
use crate::study::findings::{FigureWithData, Labelled, STATES_AND_ESTIMATES, Table, labelled, lines};
use crate::study::run::Run;

/// States, and by which names, units and factors they are shown.
const STATES: [(&str, &str, &str, f64); 3] = [
    ("position", "position x1", "mm", 1e3),
    ("velocity", "velocity x2", "mm/s", 1e3),
    ("flux", "flux x3", "mWb", 1e3),
];
const TIME: &str = "time [s]";
/// Errors below this, zero included, stand here on the logarithmic axis, in the unit shown.
const FLOOR: f64 = 1e-16;

pub fn all(runs: &Runs) -> Vec<FigureWithData> {
    vec![figure_2(runs), figure_3(runs), figure_4(runs), figure_5(runs), figure_6(runs)]
}

/// One state of several runs over time.
fn state_panel(letter: &str, runs: &[Labelled<'_>], state: usize) -> Panel {
    let (state, name, unit, factor) = STATES[state];
    let panel = Panel::new(format!("{letter} {name}"), TIME, format!("{name} [{unit}]"));
    lines(panel, runs, Stroke::Solid, |run| run.over_time(run.state(state), factor))
}

/// One state's estimation error of several runs over the first `end` seconds.
fn error_panel(letter: &str, runs: &[Labelled<'_>], state: usize, end: f64) -> Panel {
    let (state, name, unit, factor) = STATES[state];
    let title = format!("{letter} error of the {name} estimate");
    let panel = Panel::new(title, TIME, format!("|error| [{unit}], zero at {FLOOR:e}"));
    lines(panel.between(0.0, end).logarithmic(), runs, Stroke::Dots, |run| {
        run.magnitudes(&run.error(state), factor, FLOOR)
    })
}

/// Voltage of several runs; the first sample u(0) is left out when `start` is later.
fn voltage_panel(letter: &str, runs: &[Labelled<'_>], start: f64, end: f64) -> Panel {
    let panel = Panel::new(format!("{letter} voltage u, {start} s to {end} s"), TIME, "voltage u [V]");
    lines(panel.between(start, end), runs, Stroke::Held, |run| run.points("controller.voltage", 1.0))
}

/// Truth and estimate of one state of one run.
fn comparison_panel(title: String, run: &Run, state: usize, range: Option<(f64, f64)>) -> Panel {
    let (state, name, unit, factor) = STATES[state];
    let mut panel = Panel::new(title, TIME, format!("{name} [{unit}]"));
    panel.x_range = range;
    panel.line("true", 0, run.over_time(run.state(state), factor)).dashed(
        "estimate",
        1,
        run.over_time(run.estimate(state), factor),
    )
}

/// Time and, per run, states, estimates and voltage in SI units.
fn table(runs: &[Labelled<'_>]) -> Table {
    let voltage = [("controller.voltage", "voltage [V]")];
    Table::of_runs(runs, &[], &[&STATES_AND_ESTIMATES[..], &voltage].concat())
}

fn figure_2(runs: &Runs) -> FigureWithData {
    let name = |position: &f64| format!("x1(0) = {} mm", 1e3 * position);
    let runs = labelled(&POSITIONS, name, (0..3).map(|k| runs.of(0, k, 2)));
    let mut panels: Vec<Panel> = (0..3).map(|state| state_panel("(a)", &runs, state)).collect();
    panels.push(voltage_panel("(b)", &runs, 0.0, 0.005));
    panels.push(voltage_panel("(b)", &runs, 0.003, 0.5));
    panels.push(voltage_panel("(b)", &runs, 0.003, 10.0));
    panels.extend((0..3).map(|state| error_panel("(c)", &runs, state, 0.5)));
    FigureWithData::new("bearing_figure_2", "Figure 2: initial rotor positions, law (8a)", table(&runs))
        .caption(
            "Figure 2. Observer-based feedback responses to changes of the initial rotor position with the \
             control law (8a): (a) states, (b) voltage, (c) estimation errors in the first 0.5 s. Isolated \
             errors of the flux stand where it crosses zero and the printed model is not exact.",
        )
        .panels(3, panels)
}

fn figure_3(runs: &Runs) -> FigureWithData {
    let run = runs.of(0, 2, 2);
    let whole = |state| comparison_panel(format!("x{}, 10 s", state + 1), run, state, None);
    let start =
        |state| comparison_panel(format!("x{}, first 20 ms", state + 1), run, state, Some((0.0, 0.02)));
    let title = "Figure 3: true states and estimates, x1(0) = 10 mm, law (8a)";
    FigureWithData::new("bearing_figure_3", title, table(&[("x1(0) = 10 mm".to_owned(), run)]))
        .caption(
            "Figure 3. True states and their estimates for the initial position 0.01 m with the control law \
             (8a), over the whole run and over the first samples.",
        )
        .panels(3, (0..3).map(whole).chain((0..3).map(start)))
}

fn figure_4(runs: &Runs) -> FigureWithData {
    let name = |voltage: &f64| format!("u(0) = {voltage} V");
    let observed = labelled(&VOLTAGES, name, (0..3).map(|k| runs.of(0, 2, k)));
    let name = |voltage: &f64| format!("u(0) = {voltage} V, state feedback");
    let fed_back = labelled(&VOLTAGES, name, (0..3).map(|k| runs.with_state(2, k)));
    let both = |state| {
        let mut panel = state_panel("", &observed, state);
        for (_, run) in &fed_back {
            let (state, _, _, factor) = STATES[state];
            panel = panel.dashed("", 6, run.over_time(run.state(state), factor));
        }
        panel.title = format!("{} (dashed: state feedback)", panel.title.trim());
        panel
    };
    let others = [
        voltage_panel("", &observed, 0.0, 0.005),
        voltage_panel("", &observed, 0.003, 10.0),
        error_panel("", &observed, 2, 0.05),
    ];
    let title = "Figure 4: initial voltages, law (8a), x1(0) = 10 mm";
    let panels: Vec<Panel> = (0..3).map(both).chain(others).collect();
    let all: Vec<Labelled<'_>> = observed.into_iter().chain(fed_back).collect();
    FigureWithData::new("bearing_figure_4", title, table(&all))
        .caption(
            "Figure 4. Responses of the observer-based closed loop (3), (8a) for different initial values \
             of the controller output, compared with state feedback without an observer.",
        )
        .panels(3, panels)
}

fn figure_5(runs: &Runs) -> FigureWithData {
    let runs = labelled(&LAWS, |law| format!("law (8{law})"), (0..3).map(|k| runs.of(k, 2, 2)));
    let of_law = |(label, run): &Labelled<'_>| {
        [0, 1, 2].map(|state| comparison_panel(format!("{label}: {}", STATES[state].1), run, state, None))
    };
    let errors = (0..3).map(|state| error_panel("", &runs, state, 0.5));
    let title = "Figure 5: control laws (8a), (8b), (8c), x1(0) = 10 mm";
    FigureWithData::new("bearing_figure_5", title, table(&runs))
        .caption(
            "Figure 5. Observer-based feedback responses to the different control laws, true states and \
             estimates, and the estimation errors.",
        )
        .panels(3, runs.iter().flat_map(of_law).chain(errors))
}

fn figure_6(runs: &Runs) -> FigureWithData {
    let name = |bias: &f64| format!("Φ0 = {} µWb", (1e6 * bias).round());
    let runs = labelled(&BIAS_FLUXES, name, &runs.biased);
    let estimate = Panel::new("estimate of the flux", TIME, "estimated flux x3 [mWb]");
    let others = [
        voltage_panel("", &runs, 0.003, 10.0),
        lines(estimate, &runs, Stroke::Solid, |run| run.points("controller.estimate.flux", 1e3)),
        error_panel("", &runs, 2, 0.5),
    ];
    let title = "Figure 6: zero and low bias flux, law (8a), x1(0) = 10 mm";
    FigureWithData::new("bearing_figure_6", title, table(&runs))
        .caption(
            "Figure 6. Observer-based feedback responses with zero bias flux and with bias fluxes of 100 \
             and 1000 µWb, control law (8a).",
        )
        .panels(3, (0..3).map(|state| state_panel("", &runs, state)).chain(others))
}
