//! Figure of a reference run as SVG: a small chart for each real input and output, drawn from the same numbers as the
//! tables that travel with the model.

use quick_xml::escape::escape;

use super::reference_run::{ReferenceRun, Table};
use crate::chart::thin;
use crate::model::variable::{Kind, Variable};

/// File name of the figure of the reference run, beside the documentation's first page.
pub const RUN_FIGURE: &str = "reference-run.svg";

/// Lengths in the picture \[pixel\].
const WIDTH: f64 = 290.0;
const HEIGHT: f64 = 70.0;
const HEAD: f64 = 36.0;
const GAP: f64 = 18.0;
const COLUMNS: usize = 3;
/// Most points of a line; a point per pixel shows all there is to see.
const POINTS: usize = 250;

const STYLE: &str = "text{font:11px sans-serif;fill:#1d2733}.name{font-weight:bold}.bound{fill:#6b7a88}\
    .frame{fill:#f7f9fb;stroke:#d5dde5}.input{fill:none;stroke:#c0392b}.output{fill:none;stroke:#1f4e79}";

/// Inputs first, then outputs.
pub fn run_figure(run: &ReferenceRun) -> String {
    let panels: Vec<String> = panels(&run.inputs, "input").chain(panels(&run.outputs, "output")).collect();
    let rows = panels.len().div_ceil(COLUMNS) as f64;
    let width = COLUMNS as f64 * (WIDTH + GAP) + GAP;
    let height = rows * (HEAD + HEIGHT + GAP) + GAP;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<style>{STYLE}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for (place, panel) in panels.iter().enumerate() {
        let x = GAP + (place % COLUMNS) as f64 * (WIDTH + GAP);
        let y = GAP + (place / COLUMNS) as f64 * (HEAD + HEIGHT + GAP);
        text += &format!("<g transform=\"translate({x} {y})\">\n{panel}</g>\n");
    }
    text + "</svg>\n"
}

/// A chart for each real variable of a table.
fn panels(table: &Table, class: &'static str) -> impl Iterator<Item = String> {
    table.variables.iter().enumerate().filter(|(_, variable)| matches!(variable.kind, Kind::Real(_))).map(
        move |(column, variable)| {
            let points: Vec<(f64, f64)> =
                table.rows.iter().map(|(time, values)| (*time, values[column])).collect();
            panel(variable, points, class)
        },
    )
}

fn panel(variable: &Variable, points: Vec<(f64, f64)>, class: &str) -> String {
    let bounds = |pick: fn(&(f64, f64)) -> f64| {
        let numbers = points.iter().map(pick);
        numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), number| {
            (low.min(number), high.max(number))
        })
    };
    let ((start, end), (low, high)) = (bounds(|point| point.0), bounds(|point| point.1));
    // A line that stands still runs through the middle.
    let (bottom, span) = if high > low { (low, high - low) } else { (low - 0.5, 1.0) };
    let line: Vec<String> = thin(points, POINTS)
        .iter()
        .map(|(time, value)| {
            let x = WIDTH * (time - start) / (end - start);
            let y = HEAD + HEIGHT * (1.0 - (value - bottom) / span);
            format!("{x:.1} {y:.1}")
        })
        .collect();
    let title = format!("{} [{}]", variable.name, variable.unit());
    let range = format!("{low:.3e} to {high:.3e}; {start:?} s to {end:?} s");
    format!(
        "<text class=\"name\" y=\"14\">{}</text>\n<text class=\"bound\" y=\"29\">{range}</text>\n<rect class=\"frame\" y=\"{HEAD}\" width=\"{WIDTH}\" \
         height=\"{HEIGHT}\"/>\n<polyline class=\"{class}\" points=\"{}\"/>\n",
        escape(title.as_str()),
        line.join(" ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::models;

    #[test]
    fn figures_show_every_real_variable() {
        for model in models() {
            let run = ReferenceRun::of(model.description, crate::model::StartValues::TABLE).unwrap();
            let text = run_figure(&run);
            resvg::usvg::Tree::from_str(&text, &resvg::usvg::Options::default()).unwrap();
            let variables = run.inputs.variables.iter().chain(&run.outputs.variables);
            let real = variables.filter(|variable| matches!(variable.kind, Kind::Real(_)));
            let mut count = 0;
            for variable in real {
                assert!(text.contains(&format!(">{} [", variable.name)));
                count += 1;
            }
            assert_eq!(text.matches("<polyline").count(), count);
            assert!(!text.contains("NaN") && !text.contains("inf"), "{}", model.description.name);
        }
    }
}
