//! Experiments: what the papers show, reproduced through the packaged units, with claims, tables and pictures.
//!
//! An experiment opens packages with the [`crate::host`], runs them, and hands back figures and claims; everything
//! that is written to disk goes through [`output`].

pub mod ball;
pub mod ball_monte_carlo;
pub mod bearing;
pub mod bearing_observers;
pub mod claim;
mod error;
mod loop_packages;
pub mod output;
pub mod report;
pub mod rig;
mod rig_observers;
pub mod tuning;

use std::path::Path;

pub use error::StudyError;

use crate::chart::Figure;
use claim::Claim;

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

/// A figure and the numbers behind it.
pub struct FigureWithData {
    /// File name without extension.
    pub name: String,
    pub figure: Figure,
    pub table: Table,
}

/// Columns of equal length with a header each, `name [unit]`.
#[derive(Default)]
pub struct Table {
    pub headers: Vec<String>,
    pub columns: Vec<Vec<f64>>,
}

/// Called with the share of work done and what is being done.
pub type Progress<'a> = &'a (dyn Fn(f64, &str) + Sync);

/// A reproduction that can be asked for by name.
pub struct Experiment {
    pub name: &'static str,
    pub summary: &'static str,
    /// Runs on the packages in a directory made by [`crate::package::build`].
    pub run: fn(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError>,
}

/// All experiments, in the order they run.
pub static EXPERIMENTS: &[Experiment] = &[
    Experiment {
        name: "bearing",
        summary: "Newton observer and three laws for a magnetic bearing: figures 2 to 6 and the claims",
        run: bearing::run,
    },
    Experiment {
        name: "bearing-observers",
        summary: "all observers of the magnetic bearing under noise, next to the Cramer-Rao bound",
        run: bearing_observers::run,
    },
    Experiment {
        name: "ball",
        summary: "sensorless control of a levitated ball: figures 2 to 7 and the claims",
        run: ball::run,
    },
    Experiment {
        name: "ball-monte-carlo",
        summary: "the levitated ball's estimators under wrong parameters and noise, 1000 runs each",
        run: ball_monte_carlo::run,
    },
    Experiment {
        name: "rig",
        summary: "extended state observers of the maglev rig: Table 5, figures 3 and 5, the particle swarm and the claims",
        run: rig::run,
    },
    Experiment {
        name: "rig-observers",
        summary: "maglev rig: pushed loops, noise against peaking, the observers of all papers on one plant",
        run: rig_observers::run,
    },
];
