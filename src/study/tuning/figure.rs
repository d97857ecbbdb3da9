//! How a search went.

use super::swarm::Iteration;
use crate::chart::{Figure, Panel, Series, Stroke};
use crate::study::{FigureWithData, Table};

const ITERATION: &str = "iteration";

/// Best cost and velocities over the iterations of searches with a name each. `printed` is the cost of the printed
/// parameters.
pub fn convergence(
    name: &str,
    title: String,
    objective: &str,
    searches: &[(String, &[Iteration])],
    printed: Option<f64>,
) -> FigureWithData {
    let mut cost = Panel::new("best of the swarm", ITERATION, objective).logarithmic();
    let mut velocity = Panel::new(
        "is the swarm settling? velocity over range",
        ITERATION,
        "rms velocity [share of range per iteration]",
    )
    .logarithmic();
    let mut table = Table::default();
    for (colour, (label, history)) in searches.iter().enumerate() {
        let line = |value: fn(&Iteration) -> f64| -> Vec<(f64, f64)> {
            history.iter().map(|iteration| (iteration.number as f64, value(iteration))).collect()
        };
        cost = cost.with(Series::new(label, colour, Stroke::Solid, line(|iteration| iteration.best_cost)));
        velocity = velocity.with(Series::new(
            "",
            colour,
            Stroke::Solid,
            line(|iteration| iteration.relative_velocity),
        ));
        if table.columns.is_empty() {
            table.headers.push("iteration [1]".to_owned());
            table.columns.push(history.iter().map(|iteration| iteration.number as f64).collect());
        }
        table
            .headers
            .extend([format!("{label}: {objective}"), format!("{label}: rms velocity over range [1]")]);
        table.columns.push(history.iter().map(|iteration| iteration.best_cost).collect());
        table.columns.push(history.iter().map(|iteration| iteration.relative_velocity).collect());
    }
    if let Some(printed) = printed {
        let end = searches.iter().map(|(_, history)| history.len()).max().unwrap_or(1) as f64 - 1.0;
        let line = [(0.0, printed), (end, printed)];
        cost = cost.with(Series::new("printed parameters", searches.len(), Stroke::Dashed, line));
    }
    let figure = Figure {
        title,
        caption: "Smallest value of the objective found so far, and the root mean square of all velocities relative to \
                  the box, which falls while a swarm settles."
            .to_owned(),
        columns: 2,
        panels: vec![cost, velocity],
    };
    FigureWithData { name: name.to_owned(), figure, table }
}
