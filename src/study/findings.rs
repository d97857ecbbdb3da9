//! What an experiment hands back: figures with their data, tables, claims.

use std::borrow::Borrow;

use super::claim::Claim;
use super::run::Run;
use crate::chart::{Figure, Panel, Points, Series, Stroke};

/// What an experiment yields.
pub struct Findings {
    /// Short name, as on the command line.
    pub name: &'static str,
    pub title: &'static str,
    /// The source, and what about it is printed, reconstructed or assumed.
    pub provenance: &'static [&'static str],
    pub figures: Vec<FigureWithData>,
    pub claims: Vec<Claim>,
    pub summaries: Vec<Summary>,
    /// Paragraphs that tell a user what follows, written from the numbers.
    pub advice: Vec<String>,
}

/// A table for people: cells are formatted with their units.
pub struct Summary {
    pub title: String,
    pub headers: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Summary {
    pub fn new<H: Into<String>>(
        title: impl Into<String>,
        headers: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let headers = headers.into_iter().map(Into::into).collect();
        Self { title: title.into(), headers, rows: rows.into_iter().collect() }
    }
}

/// A figure and the numbers behind it.
pub struct FigureWithData {
    /// File name without extension.
    pub name: String,
    pub figure: Figure,
    pub table: Table,
}

impl FigureWithData {
    pub fn new(name: impl Into<String>, title: impl Into<String>, table: Table) -> Self {
        let (title, caption) = (title.into(), String::new());
        Self { name: name.into(), figure: Figure { title, caption, columns: 1, panels: Vec::new() }, table }
    }

    /// What the figure shows, for the report.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.figure.caption = caption.into();
        self
    }

    /// Panels in so many columns.
    pub fn panels(mut self, columns: usize, panels: impl IntoIterator<Item = Panel>) -> Self {
        (self.figure.columns, self.figure.panels) = (columns, panels.into_iter().collect());
        self
    }
}

/// Columns of equal length with a header each, `name [unit]`.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub headers: Vec<String>,
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    pub fn add(&mut self, header: impl Into<String>, column: impl IntoIterator<Item: Borrow<f64>>) {
        self.headers.push(header.into());
        self.columns.push(column.into_iter().map(|value| *value.borrow()).collect());
    }

    /// Time and the `common` columns of the first run, then the columns of each run after its legend entry; columns come
    /// by name, with their header.
    pub fn of_runs(runs: &[Labelled<'_>], common: &[(&str, &str)], each: &[(&str, &str)]) -> Self {
        let mut table = Self::default();
        if let Some((_, run)) = runs.first() {
            table.add("time [s]", &run.time);
            common.iter().for_each(|(name, header)| table.add(*header, &run[*name]));
        }
        for (label, run) in runs {
            each.iter().for_each(|(name, header)| table.add(format!("{label}: {header}"), &run[*name]));
        }
        table
    }
}

/// Columns of a run with true and estimated states of a magnet's flux dynamics, and their headers.
pub const STATES_AND_ESTIMATES: [(&str, &str); 6] = [
    ("plant.position", "position [m]"),
    ("controller.estimate.position", "estimate of position [m]"),
    ("plant.velocity", "velocity [m/s]"),
    ("controller.estimate.velocity", "estimate of velocity [m/s]"),
    ("plant.flux", "flux [Wb]"),
    ("controller.estimate.flux", "estimate of flux [Wb]"),
];

/// A run with its legend entry.
pub type Labelled<'a> = (String, &'a Run);

/// A line per run.
pub fn lines<P: Points>(
    panel: Panel,
    runs: &[Labelled<'_>],
    stroke: Stroke,
    points: impl Fn(&Run) -> P,
) -> Panel {
    runs.iter().enumerate().fold(panel, |panel, (colour, (label, run))| {
        panel.with(Series::new(label, colour, stroke, points(run)))
    })
}

/// Legend entries for runs.
pub fn labelled<'a, T>(
    cases: &[T],
    label: impl Fn(&T) -> String,
    runs: impl IntoIterator<Item = &'a Run>,
) -> Vec<Labelled<'a>> {
    cases.iter().map(label).zip(runs).collect()
}
