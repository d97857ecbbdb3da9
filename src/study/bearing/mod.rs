//! Figures 2 to 6 and the claims of the magnetic bearing paper (Mystkowski, Kotta, Kaparin 2018).

mod claims;
mod figures;
mod scenario;

use std::path::Path;

use super::loop_packages::LoopPackages;
use super::run::Run;
use super::sweep::{indices, part, sweep};
use super::{Findings, Progress, StudyError};
use crate::model::system::BEARING;
use scenario::{Scenario, simulate};

/// Simulation time of Table 1 \[s\].
const SIMULATION_TIME: f64 = 10.0;
/// T of Table 1 \[s\].
const SAMPLE_TIME: f64 = 1e-3;
/// Options of Table 1 for x1(0) \[m\].
const POSITIONS: [f64; 3] = [0.0, 0.001, 0.01];
/// Options of Table 1 for u(0) \[V\].
const VOLTAGES: [f64; 3] = [-50.0, -100.0, -150.0];
const LAWS: [&str; 3] = ["a", "b", "c"];
/// Bias fluxes of figure 6 \[Wb\].
const BIAS_FLUXES: [f64; 3] = [0.0, 100e-6, 1000e-6];

const PROVENANCE: &[&str] = &[
    "Source: A. Mystkowski, Ü. Kotta, V. Kaparin, Newton observer for a nonlinear flux-controlled \
             AMB system, Proc. Estonian Acad. Sci. 67(1), 61-72, 2018. Printed there: the plant (3), its \
             discrete-time model (4), the observer, the laws (8) and Table 1. The paper's pictures were \
             not at hand; the figures here follow its captions and its text.",
    "Chosen here where the paper is silent: figures 4 to 6 start from x1(0) = 0.01 m, and figures \
             2, 3, 5 and 6 from u(0) = -150 V; until two past samples exist the estimate is the measured \
             position with the observer's initial velocity and flux. The plant is solved exactly; the \
             observer inverts the model (4a) as printed, d = 10.",
];

/// Runs everything through the packages in `packages`.
pub fn run(packages: &Path, progress: Progress<'_>) -> Result<Findings, StudyError> {
    progress(0.0, "bearing: opening the packages");
    let packages = LoopPackages::open(packages, &BEARING)?;
    let runs = Runs::simulate(&packages, &part(progress, 0.0, 0.9))?;
    Ok(Findings {
        name: "bearing",
        title: "Newton observer for a flux-controlled magnetic bearing",
        provenance: PROVENANCE,
        figures: figures::all(&runs),
        claims: claims::all(&packages, &runs)?,
        summaries: Vec::new(),
        advice: Vec::new(),
    })
}

/// All runs that figures and claims look at.
struct Runs {
    /// Laws, positions and voltages of Table 1 without bias: `[law][position][voltage]`, observer in the loop.
    grid: Vec<Run>,
    /// Law (8a) with state feedback: `[position][voltage]`.
    state_feedback: Vec<Run>,
    /// Law (8a) for the bias fluxes of figure 6.
    biased: Vec<Run>,
    /// Law (8a) with d = 100.
    many_iterations: Run,
}

impl Runs {
    fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
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
    fn of(&self, law: usize, position: usize, voltage: usize) -> &Run {
        &self.grid[9 * law + 3 * position + voltage]
    }

    /// State feedback by indices into [`POSITIONS`] and [`VOLTAGES`], law (8a).
    fn with_state(&self, position: usize, voltage: usize) -> &Run {
        &self.state_feedback[3 * position + voltage]
    }
}
