//! All experiments by their names.

use std::path::Path;

use super::{Findings, StudyError, ball, ball_monte_carlo, bearing, bearing_observers, rig, rig_observers};

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
        summary: "maglev rig: loops with a disturbance step, noise against peaking, the observers of all papers on one plant",
        run: rig_observers::run,
    },
];
