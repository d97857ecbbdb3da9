//! All runs that figures and claims look at, and the conditions of the paper's Table 1.

use super::scenario::{Scenario, simulate};
use crate::study::loop_packages::LoopPackages;
use crate::study::run::Run;
use crate::study::sweep::{indices, sweep};
use crate::study::{Progress, StudyError};

/// Simulation time of Table 1 \[s\].
pub(super) const SIMULATION_TIME: f64 = 10.0;
/// Options of Table 1 for x1(0) \[m\].
pub(super) const POSITIONS: [f64; 3] = [0.0, 0.001, 0.01];
/// Options of Table 1 for u(0) \[V\].
pub(super) const VOLTAGES: [f64; 3] = [-50.0, -100.0, -150.0];
pub(super) const LAWS: [&str; 3] = ["a", "b", "c"];
/// Bias fluxes of figure 6 \[Wb\].
pub(super) const BIAS_FLUXES: [f64; 3] = [0.0, 100e-6, 1000e-6];

/// All runs that figures and claims look at.
pub struct Runs {
    /// Laws, positions and voltages of Table 1 without bias: `[law][position][voltage]`, observer in the loop.
    pub grid: Vec<Run>,
    /// Law (8a) with state feedback: `[position][voltage]`.
    pub state_feedback: Vec<Run>,
    /// Law (8a) for the bias fluxes of figure 6.
    pub biased: Vec<Run>,
    /// Law (8a) with d = 100.
    pub many_iterations: Run,
}

impl Runs {
    pub fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
        let start = |[position, voltage]: [usize; 2]| Scenario::new(POSITIONS[position], VOLTAGES[voltage]);
        let from_afar = Scenario::new(0.01, -150.0);
        let grid = indices([LAWS.len(), POSITIONS.len(), VOLTAGES.len()]);
        let mut scenarios: Vec<Scenario> = grid
            .into_iter()
            .map(|[law, position, voltage]| Scenario { law: LAWS[law], ..start([position, voltage]) })
            .collect();
        let starts = indices([POSITIONS.len(), VOLTAGES.len()]);
        scenarios.extend(starts.into_iter().map(|indices| Scenario { feedback: "state", ..start(indices) }));
        scenarios.extend(BIAS_FLUXES.map(|bias_flux| Scenario { bias_flux, ..from_afar }));
        scenarios.push(Scenario { max_iterations: 100, ..from_afar });

        let mut runs = sweep(&scenarios, progress, "bearing: simulating", |scenario| {
            simulate(packages, scenario, SIMULATION_TIME)
        })?;
        let many_iterations = runs.split_off(39).remove(0);
        let biased = runs.split_off(36);
        let state_feedback = runs.split_off(27);
        Ok(Self { grid: runs, state_feedback, biased, many_iterations })
    }

    /// Run of the grid by indices into [`LAWS`], [`POSITIONS`] and [`VOLTAGES`].
    pub fn of(&self, law: usize, position: usize, voltage: usize) -> &Run {
        &self.grid[9 * law + 3 * position + voltage]
    }

    /// State feedback by indices into [`POSITIONS`] and [`VOLTAGES`], law (8a).
    pub fn with_state(&self, position: usize, voltage: usize) -> &Run {
        &self.state_feedback[3 * position + voltage]
    }
}
