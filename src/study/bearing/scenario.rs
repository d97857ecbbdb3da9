//! One run of the bearing's control loop through the packaged models.

use crate::host::Value;
use crate::study::StudyError;
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::peak;
use crate::study::run::Run;

/// T of Table 1 \[s\].
pub(super) const SAMPLE_TIME: f64 = 1e-3;

/// Parameters of a run; everything else keeps its start value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario {
    /// x1(0) \[m\]
    pub initial_position: f64,
    /// u(0) \[V\]
    pub initial_voltage: f64,
    /// Item of `controller.law`.
    pub law: &'static str,
    /// Item of `controller.feedback`.
    pub feedback: &'static str,
    /// Phi0 \[Wb\] of plant and controller.
    pub bias_flux: f64,
    /// d
    pub max_iterations: i32,
}

impl Scenario {
    /// Law (8a) on estimates, no bias, d = 10.
    pub fn new(initial_position: f64, initial_voltage: f64) -> Self {
        Self {
            initial_position,
            initial_voltage,
            law: "a",
            feedback: "estimate",
            bias_flux: 0.0,
            max_iterations: 10,
        }
    }
}

/// Position \[m\], velocity \[m/s\], flux \[Wb\]: columns `plant.<state>` and `controller.estimate.<state>`.
pub const STATES: [&str; 3] = ["position", "velocity", "flux"];

/// Largest magnitude of a state's estimation error from `start` \[s\] on.
pub fn largest_error(run: &Run, start: f64, state: &str) -> f64 {
    peak(run.since(start, &run.error(state)))
}

/// Runs a scenario for `duration` \[s\].
pub fn simulate(packages: &LoopPackages, scenario: &Scenario, duration: f64) -> Result<Run, StudyError> {
    packages.simulate(
        &[
            ("initial.position", Value::Real(scenario.initial_position)),
            ("bias_flux", Value::Real(scenario.bias_flux)),
        ],
        &[
            ("controller.initial_voltage", Value::Real(scenario.initial_voltage)),
            ("controller.law", Value::Text(scenario.law)),
            ("controller.feedback", Value::Text(scenario.feedback)),
            ("observer.max_iterations", Value::Integer(scenario.max_iterations)),
            ("bias_flux", Value::Real(scenario.bias_flux)),
        ],
        &[
            ("plant", "position"),
            ("plant", "velocity"),
            ("plant", "flux"),
            ("controller", "estimate.position"),
            ("controller", "estimate.velocity"),
            ("controller", "estimate.flux"),
            ("controller", "voltage"),
        ],
        SAMPLE_TIME,
        duration,
    )
}
