//! Figures 2 to 6, laid out as their captions say.

use super::{BIAS_FLUXES, LAWS, POSITIONS, Run, Runs, VOLTAGES};
use crate::chart::{Figure, Panel, Series, Stroke};
use crate::study::{FigureWithData, Table};

/// Names, units and factors by which the three states are shown.
const STATES: [(&str, &str, f64); 3] =
    [("position x1", "mm", 1e3), ("velocity x2", "mm/s", 1e3), ("flux x3", "mWb", 1e3)];
const TIME: &str = "time [s]";
/// Errors below this, zero included, stand here on the logarithmic axis, in the unit shown.
const FLOOR: f64 = 1e-16;

pub fn all(runs: &Runs) -> Vec<FigureWithData> {
    vec![figure_2(runs), figure_3(runs), figure_4(runs), figure_5(runs), figure_6(runs)]
}

/// A run with its legend entry.
type Labelled<'a> = (String, &'a Run);

/// One state of several runs over time.
fn state_panel(letter: &str, runs: &[Labelled<'_>], state: usize) -> Panel {
    let (name, unit, factor) = STATES[state];
    runs.iter().enumerate().fold(
        Panel::new(format!("{letter} {name}"), TIME, format!("{name} [{unit}]")),
        |panel, (colour, (label, run))| {
            let points = run.time.iter().zip(&run.state[state]).map(|(t, x)| (*t, factor * x));
            panel.with(Series::new(label, colour, Stroke::Solid, points))
        },
    )
}

/// One state's estimation error of several runs over the first `end` seconds.
fn error_panel(letter: &str, runs: &[Labelled<'_>], state: usize, end: f64) -> Panel {
    let (name, unit, factor) = STATES[state];
    let panel = Panel::new(
        format!("{letter} error of the {name} estimate"),
        TIME,
        format!("|error| [{unit}], zero at {FLOOR:e}"),
    );
    runs.iter().enumerate().fold(panel.between(0.0, end).logarithmic(), |panel, (colour, (label, run))| {
        let points = run.time.iter().zip(run.error(state)).map(|(t, e)| (*t, (factor * e.abs()).max(FLOOR)));
        panel.with(Series::new(label, colour, Stroke::Dots, points))
    })
}

/// Voltage of several runs; the first sample u(0) is left out when `start` is later.
fn voltage_panel(letter: &str, runs: &[Labelled<'_>], start: f64, end: f64) -> Panel {
    let title = format!("{letter} voltage u, {start} s to {end} s");
    runs.iter().enumerate().fold(
        Panel::new(title, TIME, "voltage u [V]").between(start, end),
        |panel, (colour, (label, run))| {
            let points = run.time.iter().zip(&run.voltage).map(|(t, u)| (*t, *u));
            panel.with(Series::new(label, colour, Stroke::Held, points))
        },
    )
}

/// Truth and estimate of one state of one run.
fn comparison_panel(title: String, run: &Run, state: usize, range: Option<(f64, f64)>) -> Panel {
    let (name, unit, factor) = STATES[state];
    let line = |values: &[f64]| -> Vec<(f64, f64)> {
        run.time.iter().zip(values).map(|(t, x)| (*t, factor * x)).collect()
    };
    let mut panel = Panel::new(title, TIME, format!("{name} [{unit}]"));
    panel.x_range = range;
    panel.with(Series::new("true", 0, Stroke::Solid, line(&run.state[state]))).with(Series::new(
        "estimate",
        1,
        Stroke::Dashed,
        line(&run.estimate[state]),
    ))
}

/// Time and, per run, states, estimates and voltage in SI units.
fn table(runs: &[Labelled<'_>]) -> Table {
    let mut table = Table::default();
    let mut add = |header: String, column: &[f64]| {
        table.headers.push(header);
        table.columns.push(column.to_vec());
    };
    if let Some((_, run)) = runs.first() {
        add("time [s]".to_owned(), &run.time);
    }
    for (label, run) in runs {
        for (state, (name, unit)) in
            [("position", "m"), ("velocity", "m/s"), ("flux", "Wb")].iter().enumerate()
        {
            add(format!("{label}: {name} [{unit}]"), &run.state[state]);
            add(format!("{label}: estimate of {name} [{unit}]"), &run.estimate[state]);
        }
        add(format!("{label}: voltage [V]"), &run.voltage);
    }
    table
}

fn with_table(name: &str, figure: Figure, runs: &[Labelled<'_>]) -> FigureWithData {
    FigureWithData { name: name.to_owned(), figure, table: table(runs) }
}

fn figure_2(runs: &Runs) -> FigureWithData {
    let runs: Vec<Labelled<'_>> = POSITIONS
        .iter()
        .enumerate()
        .map(|(k, position)| (format!("x1(0) = {} mm", 1e3 * position), runs.of(0, k, 2)))
        .collect();
    let mut panels: Vec<Panel> = (0..3).map(|state| state_panel("(a)", &runs, state)).collect();
    panels.push(voltage_panel("(b)", &runs, 0.0, 0.005));
    panels.push(voltage_panel("(b)", &runs, 0.003, 0.5));
    panels.push(voltage_panel("(b)", &runs, 0.003, 10.0));
    panels.extend((0..3).map(|state| error_panel("(c)", &runs, state, 0.5)));
    let figure = Figure {
        title: "Figure 2: initial rotor positions, law (8a)".to_owned(),
        caption: "Figure 2. Observer-based feedback responses to changes of the initial rotor position with the \
                  control law (8a): (a) states, (b) voltage, (c) estimation errors in the first 0.5 s. Isolated \
                  errors of the flux stand where it crosses zero and the printed model is not exact."
            .to_owned(),
        columns: 3,
        panels,
    };
    with_table("bearing_figure_2", figure, &runs)
}

fn figure_3(runs: &Runs) -> FigureWithData {
    let run = runs.of(0, 2, 2);
    let mut panels: Vec<Panel> =
        (0..3).map(|state| comparison_panel(format!("x{}, 10 s", state + 1), run, state, None)).collect();
    panels.extend((0..3).map(|state| {
        comparison_panel(format!("x{}, first 20 ms", state + 1), run, state, Some((0.0, 0.02)))
    }));
    let figure = Figure {
        title: "Figure 3: true states and estimates, x1(0) = 10 mm, law (8a)".to_owned(),
        caption:
            "Figure 3. True states and their estimates for the initial position 0.01 m with the control law \
                  (8a), over the whole run and over the first samples."
                .to_owned(),
        columns: 3,
        panels,
    };
    with_table("bearing_figure_3", figure, &[("x1(0) = 10 mm".to_owned(), run)])
}

fn figure_4(runs: &Runs) -> FigureWithData {
    let with = |name: &str, voltage: f64| format!("u(0) = {voltage} V{name}");
    let observed: Vec<Labelled<'_>> =
        VOLTAGES.iter().enumerate().map(|(k, u)| (with("", *u), runs.of(0, 2, k))).collect();
    let fed_back: Vec<Labelled<'_>> = VOLTAGES
        .iter()
        .enumerate()
        .map(|(k, u)| (with(", state feedback", *u), runs.with_state(2, k)))
        .collect();
    let mut panels: Vec<Panel> = (0..3)
        .map(|state| {
            let dashed = state_panel("", &fed_back, state).series.into_iter().map(|series| Series {
                stroke: Stroke::Dashed,
                label: String::new(),
                colour: 6,
                ..series
            });
            let mut panel = state_panel("", &observed, state);
            panel.series.extend(dashed);
            panel.title = format!("{} (dashed: state feedback)", panel.title.trim());
            panel
        })
        .collect();
    panels.push(voltage_panel("", &observed, 0.0, 0.005));
    panels.push(voltage_panel("", &observed, 0.003, 10.0));
    panels.push(error_panel("", &observed, 2, 0.05));
    let figure = Figure {
        title: "Figure 4: initial voltages, law (8a), x1(0) = 10 mm".to_owned(),
        caption:
            "Figure 4. Responses of the observer-based closed loop (3), (8a) for different initial values of \
                  the controller output, compared with state feedback without an observer."
                .to_owned(),
        columns: 3,
        panels,
    };
    let all: Vec<Labelled<'_>> = observed.into_iter().chain(fed_back).collect();
    with_table("bearing_figure_4", figure, &all)
}

fn figure_5(runs: &Runs) -> FigureWithData {
    let labelled: Vec<Labelled<'_>> =
        LAWS.iter().enumerate().map(|(k, law)| (format!("law (8{law})"), runs.of(k, 2, 2))).collect();
    let mut panels: Vec<Panel> = labelled
        .iter()
        .flat_map(|(label, run)| {
            (0..3)
                .map(move |state| comparison_panel(format!("{label}: {}", STATES[state].0), run, state, None))
        })
        .collect();
    panels.extend((0..3).map(|state| error_panel("", &labelled, state, 0.5)));
    let figure = Figure {
        title: "Figure 5: control laws (8a), (8b), (8c), x1(0) = 10 mm".to_owned(),
        caption:
            "Figure 5. Observer-based feedback responses to the different control laws, true states and \
                  estimates, and the estimation errors."
                .to_owned(),
        columns: 3,
        panels,
    };
    with_table("bearing_figure_5", figure, &labelled)
}

fn figure_6(runs: &Runs) -> FigureWithData {
    let labelled: Vec<Labelled<'_>> = BIAS_FLUXES
        .iter()
        .zip(&runs.biased)
        .map(|(bias, run)| (format!("Φ0 = {} µWb", (1e6 * bias).round()), run))
        .collect();
    let mut panels: Vec<Panel> = (0..3).map(|state| state_panel("", &labelled, state)).collect();
    panels.push(voltage_panel("", &labelled, 0.003, 10.0));
    panels.push({
        let (name, unit, factor) = STATES[2];
        labelled.iter().enumerate().fold(
            Panel::new("estimate of the flux", TIME, format!("estimated {name} [{unit}]")),
            |panel, (colour, (label, run))| {
                let points = run.time.iter().zip(&run.estimate[2]).map(|(t, x)| (*t, factor * x));
                panel.with(Series::new(label, colour, Stroke::Solid, points))
            },
        )
    });
    panels.push(error_panel("", &labelled, 2, 0.5));
    let figure = Figure {
        title: "Figure 6: zero and low bias flux, law (8a), x1(0) = 10 mm".to_owned(),
        caption:
            "Figure 6. Observer-based feedback responses with zero bias flux and with bias fluxes of 100 and \
                  1000 µWb, control law (8a)."
                .to_owned(),
        columns: 3,
        panels,
    };
    with_table("bearing_figure_6", figure, &labelled)
}
