//! How a search went.

use super::swarm::Iteration;
use crate::chart::Panel;
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
        let column = |value: fn(&Iteration) -> f64| history.iter().map(value);
        let numbers = || column(|iteration| iteration.number as f64);
        let costs = || column(|iteration| iteration.best_cost);
        let velocities = || column(|iteration| iteration.relative_velocity);
        cost = cost.line(label, colour, numbers().zip(costs()));
        velocity = velocity.line("", colour, numbers().zip(velocities()));
        if table.columns.is_empty() {
            table.add("iteration [1]", numbers());
        }
        table.add(format!("{label}: {objective}"), costs());
        table.add(format!("{label}: rms velocity over range [1]"), velocities());
    }
    if let Some(printed) = printed {
        let end = searches.iter().map(|(_, history)| history.len()).max().unwrap_or(1) as f64 - 1.0;
        let line = [(0.0, printed), (end, printed)];
        cost = cost.dashed("printed parameters", searches.len(), line);
    }
    FigureWithData::new(name, title, table)
        .caption(
            "Smallest value of the objective found so far, and the root mean square of all velocities \
             relative to the box, which falls while a swarm settles.",
        )
        .panels(2, [cost, velocity])
}
