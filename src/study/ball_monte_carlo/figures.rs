//! Distributions of the errors, what was lost, and DREM's tuning.

use super::campaign::{Campaign, Errors, Median, REFERENCES};
use super::candidate::{ADAPTIVE_OFFSET, ADAPTIVE_RESISTANCE, NEWTON, ObserverCandidate};
use super::spread::{Draw, SPREADS};
use super::trial::Outcome;
use super::tuning::{GAINS, NOISES, NORMALISATIONS, Score, Tuning};
use crate::chart::{Panel, Series, Stroke};
use crate::study::metrics::indicator;
use crate::study::sweep::indices;
use crate::study::{FigureWithData, Table};

/// Noiseless runs stand here on the axis of the noise \[A\].
const NO_NOISE: f64 = 1e-6;

pub fn all(tuning: &Tuning, candidates: &[ObserverCandidate], campaign: &Campaign) -> Vec<FigureWithData> {
    let position = distributions(
        FigureWithData::new(
            "ball_monte_carlo_position",
            "Monte-Carlo: deviation from the wanted position",
            data(candidates, campaign),
        ),
        "Share of all runs whose rms |y - y*| from 2 to 4 s is below the value on the axis. A curve ends at \
         the share of runs that survive.",
        candidates,
        campaign,
        ("rms |y - y*| [mm]", 1e3, Outcome::position),
    );
    let flux = distributions(
        FigureWithData::new(
            "ball_monte_carlo_flux",
            "Monte-Carlo: error of the flux estimate",
            medians(candidates, campaign),
        ),
        "The same for the error of the flux estimate: who survives without estimating the flux is not \
         better off.",
        candidates,
        campaign,
        ("rms flux error / lam0 [%]", 100.0, Outcome::flux),
    );
    vec![position, flux, losses(campaign), tuning_figure(tuning)]
}

/// A panel per spread and reference with a cumulative distribution per candidate.
fn distributions(
    figure: FigureWithData,
    caption: &str,
    candidates: &[ObserverCandidate],
    campaign: &Campaign,
    (label, factor, value): (&str, f64, fn(&Outcome) -> f64),
) -> FigureWithData {
    let mut panels = Vec::new();
    for (reference, signal) in REFERENCES.iter().enumerate() {
        for (spread, widths) in SPREADS.iter().enumerate() {
            let name = format!("{}, {signal:?}, {} runs", widths.name, campaign.runs(spread)).to_lowercase();
            let panel = Panel::new(format!("spread {}", capitalised(&name)), label, "share of runs [%]");
            let panel = panel.x_logarithmic().from_to(0.0, 104.0);
            panels.push(candidates.iter().enumerate().fold(panel, |panel, (who, candidate)| {
                let outcomes = campaign.of(spread, reference, who);
                let mut values: Vec<f64> =
                    outcomes.iter().map(value).filter(|value| value.is_finite()).collect();
                values.sort_by(f64::total_cmp);
                let share = |rank: usize| 100.0 * (rank + 1) as f64 / outcomes.len() as f64;
                let points = values.iter().enumerate().map(|(rank, value)| (factor * value, share(rank)));
                // Where there is room for it.
                let legend = if (spread, reference) == (2, 1) { candidate.name } else { "" };
                panel.held(legend, who, points)
            }));
        }
    }
    let spreads: Vec<String> =
        SPREADS.iter().map(|spread| format!("{}: {}", spread.name, spread.text())).collect();
    figure.caption(format!("{caption} Spreads: {}.", spreads.join("; "))).panels(SPREADS.len(), panels)
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// What one run's draw says of one parameter.
type Part = fn(&Draw) -> f64;

/// A row per run.
fn data(candidates: &[ObserverCandidate], campaign: &Campaign) -> Table {
    let cases: Vec<(usize, usize, u32)> = indices([SPREADS.len(), REFERENCES.len()])
        .into_iter()
        .flat_map(|[spread, reference]| (0..campaign.runs(spread)).map(move |run| (spread, reference, run)))
        .collect();
    let mut table = Table::default();
    let mut add = |header: String, value: &dyn Fn(usize, usize, u32) -> f64| {
        table.add(header, cases.iter().map(|&(spread, reference, run)| value(spread, reference, run)));
    };
    add("spread [1 = A]".to_owned(), &|spread, _, _| (spread + 1) as f64);
    add("reference [1 = sinusoids; 2 = steps]".to_owned(), &|_, reference, _| (reference + 1) as f64);
    add("run [1]".to_owned(), &|_, _, run| f64::from(run));
    let parts: [(&str, Part); 5] = [
        ("resistance error [1]", |draw| draw.resistance),
        ("inductance constant error [1]", |draw| draw.inductance_constant),
        ("mass error [1]", |draw| draw.mass),
        ("voltage offset [V]", |draw| draw.voltage_offset),
        ("flux offset [1]", |draw| draw.flux),
    ];
    for (header, part) in parts {
        add(header.to_owned(), &|spread, _, run| part(&SPREADS[spread].draw(run)));
    }
    for (who, candidate) in candidates.iter().enumerate() {
        let name = candidate.name.replace(',', "");
        let outcome =
            |spread: usize, reference: usize, run: u32| campaign.of(spread, reference, who)[run as usize];
        add(format!("{name}: rms position error; inf if lost [m]"), &|spread, reference, run| {
            outcome(spread, reference, run).position()
        });
        add(format!("{name}: rms flux error; inf if lost [1]"), &|spread, reference, run| {
            outcome(spread, reference, run).flux()
        });
        add(format!("{name}: time of the loss; inf if none [s]"), &|spread, reference, run| match outcome(
            spread, reference, run,
        ) {
            Outcome::Lost { time } => time,
            Outcome::Survived { .. } => f64::INFINITY,
        });
    }
    table
}

/// A row per spread and reference.
fn medians(candidates: &[ObserverCandidate], campaign: &Campaign) -> Table {
    let cases = indices([SPREADS.len(), REFERENCES.len()]);
    let mut table = Table::default();
    let mut add = |header: String, value: &dyn Fn(usize, usize) -> f64| {
        table.add(header, cases.iter().map(|&[spread, reference]| value(spread, reference)));
    };
    add("spread [1 = A]".to_owned(), &|spread, _| (spread + 1) as f64);
    add("reference [1 = sinusoids; 2 = steps]".to_owned(), &|_, reference| (reference + 1) as f64);
    add("runs [1]".to_owned(), &|spread, _| f64::from(campaign.runs(spread)));
    for (who, candidate) in candidates.iter().enumerate() {
        let name = candidate.name.replace(',', "");
        add(format!("{name}: survivors [1]"), &|spread, reference| {
            campaign.survivors(spread, reference, who) as f64
        });
        let of_position: fn(&Errors) -> &Median = |errors| &errors.position;
        for (what, unit, of) in [("position", "m", of_position), ("flux", "1", |errors| &errors.flux)] {
            let header = |part: &str| format!("{name}: {part}median rms {what} error [{unit}]");
            let median = |spread, reference| of(campaign.errors(spread, reference, who));
            add(header(""), &|spread, reference| median(spread, reference).value);
            add(header("low end of the "), &|spread, reference| median(spread, reference).interval.low);
            add(header("high end of the "), &|spread, reference| median(spread, reference).interval.high);
        }
    }
    table
}

/// Which runs the Newton variants lose, over the two errors that matter most.
fn losses(campaign: &Campaign) -> FigureWithData {
    let spread = 1;
    let mut panels = Vec::new();
    let mut table = Table::default();
    let draws: Vec<Draw> = (0..campaign.runs(spread)).map(|run| SPREADS[spread].draw(run)).collect();
    table.add("resistance error [1]", draws.iter().map(|draw| draw.resistance));
    table.add("flux offset [1]", draws.iter().map(|draw| draw.flux));
    for (who, name) in [
        (NEWTON, "Newton"),
        (ADAPTIVE_RESISTANCE, "adaptive, resistance"),
        (ADAPTIVE_OFFSET, "adaptive, offset"),
    ] {
        for (reference, signal) in REFERENCES.iter().enumerate() {
            let outcomes = campaign.of(spread, reference, who);
            let title = format!("{name}, {}", format!("{signal:?}").to_lowercase());
            let lost = outcomes.iter().map(|outcome| indicator(!outcome.survived()));
            table.add(format!("{}: lost [1]", title.replace(',', "")), lost);
            let points = |survived: bool| {
                let chosen =
                    draws.iter().zip(outcomes).filter(move |(_, outcome)| outcome.survived() == survived);
                chosen.map(|(draw, _)| (100.0 * draw.flux, 100.0 * draw.resistance))
            };
            let legend = |text: &str| if panels.is_empty() { text.to_owned() } else { String::new() };
            let panel = Panel::new(title, "initial flux offset [% of lam0]", "error of the resistance [%]")
                .between(-10.5, 10.5)
                .from_to(-3.2, 3.2)
                .dots(legend("survived"), 8, points(true))
                .dots(legend("lost"), 1, points(false));
            panels.push(panel);
        }
    }
    FigureWithData::new("ball_monte_carlo_losses", "Which runs of spread B are lost", table)
        .caption("Runs of spread B over the initial flux offset and the error of the resistance.")
        .panels(2, panels)
}

/// Best DREM per gain and noise, and Newton beside it.
fn tuning_figure(tuning: &Tuning) -> FigureWithData {
    let mut panels = Vec::new();
    let mut table = Table::default();
    table.add("noise [A]", NOISES);
    for (reference, signal) in REFERENCES.iter().enumerate() {
        let signal = format!("{signal:?}").to_lowercase();
        let newton: Vec<Option<Score>> = tuning.newton[reference].iter().copied().map(Some).collect();
        let mut lines = vec![("Newton".to_owned(), 6, Stroke::Solid, newton)];
        for normalisation in NORMALISATIONS {
            for (colour, gain) in GAINS.into_iter().enumerate() {
                let best = |noise| tuning.best_with(reference, noise, gain, normalisation);
                let scores = (0..NOISES.len()).map(best).collect();
                let (kind, stroke) =
                    if normalisation > 0.0 { ("normalised ", Stroke::Dashed) } else { ("", Stroke::Solid) };
                lines.push((format!("DREM {kind}gamma = {gain}"), colour, stroke, scores));
            }
        }
        type Measure = fn(&Score) -> f64;
        let measures: [(&str, &str, f64, Measure); 3] = [
            ("runs that are not lost", "share of runs [%]", 100.0, |score| score.survival),
            ("flux error", "rms flux error / lam0 [%]", 100.0, |score| score.flux),
            ("deviation", "rms |y - y*| [mm]", 1e3, |score| score.position),
        ];
        for (title, label, factor, value) in measures {
            let panel = Panel::new(
                format!("{title}, {signal}"),
                format!("current noise [A], {NO_NOISE:e} stands for none"),
                label,
            );
            let panel = panel.x_logarithmic();
            let panel = if factor == 100.0 && label.starts_with("share") {
                panel.from_to(0.0, 104.0)
            } else {
                panel.logarithmic()
            };
            let shows_legend = panels.len() == 1;
            panels.push(lines.iter().fold(panel, |panel, (name, colour, stroke, scores)| {
                let points = NOISES.iter().zip(scores).filter_map(|(noise, score)| {
                    let value = factor * value(score.as_ref()?);
                    value.is_finite().then_some((noise.max(NO_NOISE), value))
                });
                let legend = if shows_legend && *stroke == Stroke::Solid { name.as_str() } else { "" };
                panel.with(Series::new(legend, *colour, *stroke, points))
            }));
        }
        for (name, _, _, scores) in &lines {
            let mut add = |what: &str, value: fn(&Score) -> f64| {
                let values = scores.iter().map(|score| score.as_ref().map_or(f64::NAN, value));
                table.add(format!("{signal}: {name}: {what}"), values);
            };
            add("share of runs up [1]", |score| score.survival);
            add("rms flux error [1]", |score| score.flux);
            add("rms position error [m]", |score| score.position);
        }
    }
    FigureWithData::new("ball_drem_tuning", "DREM at its best under noise, exact parameters", table)
        .caption(format!(
            "For every gain the best of six sets of filters at T = 0.1 ms, without (solid) and with \
             normalisation (dashed): {} settings for each noise and reference, flux offsets of +-5 and +-10 \
             %. Errors are those of the runs that are not lost; an rms flux error of 8 % is what not \
             adapting leaves.",
            tuning.settings.len()
        ))
        .panels(3, panels)
}
