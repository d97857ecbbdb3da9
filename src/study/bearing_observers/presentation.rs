//! Plots, tables and advice from the comparison.

use super::candidates::CANDIDATES;
use super::comparison::{Comparison, Score};
use super::conditions::{NOISES, SAMPLE_TIMES, seeds};
use crate::chart::Panel;
use crate::study::metrics::largest;
use crate::study::report::quantity;
use crate::study::sweep::indices;
use crate::study::{FigureWithData, Summary, Table};

/// Sample time of the paper, by its index.
const PAPER: usize = 1;
/// Largest flux in the runs \[Wb\]; an error of this size says that nothing was estimated.
const SIGNAL: f64 = 0.15;
const NOISE_AXIS: &str = "sensor noise (standard deviation) [m]";
/// Colour of the bound, after those of the observers.
const BOUND: usize = CANDIDATES.len();

/// Index of the candidate called `name`.
pub fn index_of(name: &str) -> usize {
    CANDIDATES.iter().position(|candidate| candidate.name == name).unwrap_or_default()
}

pub fn figures(comparison: &Comparison) -> Vec<FigureWithData> {
    let of = |time: usize, what: &str| format!("{what}, T = {} ms", 1e3 * SAMPLE_TIMES[time]);
    let panels = (0..3)
        .map(|time| error_panel(comparison, time, true, &of(time, "flux")))
        .chain((0..3).map(|time| error_panel(comparison, time, false, &of(time, "velocity"))))
        .chain((0..3).map(|time| survival_panel(comparison, time, &of(time, "rotor remained levitated"))));
    let title = "Observers of the magnetic bearing under sensor noise";
    let figure = FigureWithData::new("bearing_observers", title, data(comparison))
        .caption(
            "Root mean square errors of flux and velocity over the sensor's noise for three sample times, \
             all observers on the same data, with the Cramer-Rao bound; and the share of runs in which the \
             rotor, held by the estimates, remained levitated. Without noise see the tables. Over few seeds an error may come out \
             below the bound, which holds for the average over all.",
        )
        .panels(3, panels);
    vec![figure]
}

fn error_panel(comparison: &Comparison, time: usize, flux: bool, title: &str) -> Panel {
    let (y_label, value): (_, fn(&Score) -> f64) = if flux {
        ("rms flux error [Wb]", |score| score.flux)
    } else {
        ("rms velocity error [m/s]", |score| score.velocity)
    };
    let panel = Panel::new(title, NOISE_AXIS, y_label).x_logarithmic().logarithmic();
    let bounds = NOISES
        .iter()
        .zip(&comparison.bounds[time])
        .map(|(noise, bound)| (*noise, if flux { bound.flux } else { bound.velocity }));
    candidates(panel, comparison, time, false, value).dashed("", BOUND, bounds)
}

/// Also carries the legend, since its lower half is empty where all rotors remained levitated.
fn survival_panel(comparison: &Comparison, time: usize, title: &str) -> Panel {
    let panel = Panel::new(title, NOISE_AXIS, "share of runs [%]").x_logarithmic().from_to(0.0, 105.0);
    let panel = candidates(panel, comparison, time, time == 0, |score| 100.0 * score.survival);
    let label = if time == 0 { "Cramer-Rao bound" } else { "" };
    // A line of the legend that has no points here.
    panel.dashed(label, BOUND, [])
}

/// A line per observer.
fn candidates(
    panel: Panel,
    comparison: &Comparison,
    time: usize,
    with_legend: bool,
    value: fn(&Score) -> f64,
) -> Panel {
    CANDIDATES.iter().enumerate().fold(panel, |panel, (who, candidate)| {
        let points =
            NOISES.iter().zip(&comparison.scores[time]).map(|(noise, row)| (*noise, value(&row[who])));
        let label = if with_legend { candidate.name } else { "" };
        panel.line(label, who, points)
    })
}

/// A row per sample time and noise, three columns per observer.
fn data(comparison: &Comparison) -> Table {
    let mut table = Table::default();
    let cases = indices([SAMPLE_TIMES.len(), NOISES.len()]);
    let mut add = |header: String, value: &dyn Fn(usize, usize) -> f64| {
        table.add(header, cases.iter().map(|&[time, noise]| value(time, noise)));
    };
    let Comparison { scores, bounds } = comparison;
    add("sample time [s]".to_owned(), &|time, _| SAMPLE_TIMES[time]);
    add("sensor noise [m]".to_owned(), &|_, noise| NOISES[noise]);
    add("Cramer-Rao bound of velocity [m/s]".to_owned(), &|time, noise| bounds[time][noise].velocity);
    add("Cramer-Rao bound of flux [Wb]".to_owned(), &|time, noise| bounds[time][noise].flux);
    for (who, candidate) in CANDIDATES.iter().enumerate() {
        let name = candidate.name.replace(',', "");
        add(format!("{name}: rms velocity error [m/s]"), &|time, noise| scores[time][noise][who].velocity);
        add(format!("{name}: rms flux error [Wb]"), &|time, noise| scores[time][noise][who].flux);
        add(format!("{name}: share of runs up [1]"), &|time, noise| scores[time][noise][who].survival);
    }
    table
}

pub fn tables(comparison: &Comparison) -> Vec<Summary> {
    SAMPLE_TIMES
        .iter()
        .enumerate()
        .map(|(time, sample_time)| {
            let noises = NOISES.map(|noise| format!("noise {}", quantity(noise, "m")));
            let mut rows: Vec<Vec<String>> = CANDIDATES
                .iter()
                .enumerate()
                .map(|(who, candidate)| {
                    let cells = comparison.scores[time].iter().map(|row| {
                        let score = row[who];
                        format!(
                            "{:.1e} Wb, {:.1e} m/s, {:.0} % up",
                            score.flux,
                            score.velocity,
                            100.0 * score.survival
                        )
                    });
                    std::iter::once(candidate.name.to_owned()).chain(cells).collect()
                })
                .collect();
            let bounds = comparison.bounds[time]
                .iter()
                .map(|bound| format!("{:.1e} Wb, {:.1e} m/s", bound.flux, bound.velocity));
            rows.push(std::iter::once("Cramer-Rao bound".to_owned()).chain(bounds).collect());
            let title = format!(
                "T = {} ms: rms errors of flux and velocity, share of runs in which the rotor remained levitated ({} seeds)",
                1e3 * sample_time,
                seeds(*sample_time)
            );
            Summary::new(title, std::iter::once("observer".to_owned()).chain(noises), rows)
        })
        .collect()
}

/// Which observer to choose when, from the numbers at the paper's sample time.
pub fn advice(comparison: &Comparison) -> Vec<String> {
    let scores = &comparison.scores[PAPER];
    // The best observer that keeps every loop up, per noise.
    let best: Vec<Option<usize>> = scores
        .iter()
        .map(|row| {
            (0..row.len())
                .filter(|who| row[*who].survival == 1.0)
                .min_by(|a, b| row[*a].flux.total_cmp(&row[*b].flux))
        })
        .collect();
    let choices: Vec<String> = NOISES
        .iter()
        .zip(&best)
        .zip(scores)
        .map(|((noise, best), row)| match best {
            Some(who) => format!(
                "at {} {} ({:.1e} Wb)",
                if *noise == 0.0 { "no noise".to_owned() } else { quantity(*noise, "m") },
                CANDIDATES[*who].name,
                row[*who].flux
            ),
            None => format!("at {} none keeps every rotor levitated", quantity(*noise, "m")),
        })
        .collect();
    let newton = index_of("Newton, printed model");
    let drowned = NOISES.iter().zip(scores).find(|(_, row)| row[newton].flux > 0.1 * SIGNAL);
    let usable = drowned.map_or_else(
        || "The three-sample Newton observer stays usable at every noise tried.".to_owned(),
        |(noise, row)| {
            format!(
                "The three-sample Newton observer is for data without noise: at {} its flux error is {:.1e} \
                 Wb, more than a tenth of the signal.",
                quantity(*noise, "m"),
                row[newton].flux
            )
        },
    );
    let kalman = index_of("Kalman, default noise");
    let worst = largest(scores.iter().map(|row| row[kalman].flux));
    vec![format!(
        "Which observer at T = 1 ms, by the smallest flux error among those that keep every rotor levitated: {}. \
         {usable} The Kalman filter with its default noise never does worse than {worst:.1e} Wb and is the \
         one to start with on a real sensor; tell it the sensor's noise, and a smaller flux noise the more \
         the model is trusted.",
        choices.join("; ")
    )]
}
