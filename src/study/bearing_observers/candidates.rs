//! The observers that are compared, and one run of the loop with one of them.

use super::conditions::{DURATION, INITIAL_FLUX, LOST_BEYOND, SCORED_FROM};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::loop_packages::{LoopPackages, Parameter};
use crate::study::metrics::root_mean_square;
use crate::study::run::Run;

/// An observer with its parameters of the controller model.
pub struct ObserverCandidate {
    pub name: &'static str,
    pub parameters: &'static [Parameter<'static>],
    /// Whether the filter is told the sensor's noise.
    pub knows_noise: bool,
}

const fn candidate(name: &'static str, parameters: &'static [Parameter<'static>]) -> ObserverCandidate {
    ObserverCandidate { name, parameters, knows_noise: false }
}

pub const CANDIDATES: [ObserverCandidate; 8] = [
    candidate("Newton, printed model", &[]),
    candidate("Newton, exact model", &[("observer.map", Value::Text("exact"))]),
    candidate(
        "Newton, 10 samples",
        &[("observer.map", Value::Text("exact")), ("observer.window", Value::Integer(10))],
    ),
    candidate(
        "Newton, 30 samples",
        &[("observer.map", Value::Text("exact")), ("observer.window", Value::Integer(30))],
    ),
    candidate("reduced Newton, printed", &[("observer.kind", Value::Text("reduced_newton"))]),
    candidate(
        "reduced Newton, compensated",
        &[
            ("observer.map", Value::Text("exact")),
            ("observer.kind", Value::Text("reduced_newton_compensated")),
        ],
    ),
    ObserverCandidate {
        name: "Kalman, no process noise",
        parameters: &[("observer.kind", Value::Text("kalman")), ("observer.flux_noise", Value::Real(0.0))],
        knows_noise: true,
    },
    ObserverCandidate {
        name: "Kalman, default noise",
        parameters: &[("observer.kind", Value::Text("kalman"))],
        knows_noise: false,
    },
];

/// Conditions of a run.
#[derive(Clone, Copy)]
pub struct Conditions {
    /// \[s\]
    pub sample_time: f64,
    /// Standard deviation of the sensor \[m\].
    pub noise: f64,
    pub seed: i32,
    /// `state` or `estimate`.
    pub feedback: &'static str,
}

/// A run with the sensor in the loop; `parameters` go to the controller.
pub fn simulate(
    packages: &LoopPackages,
    conditions: Conditions,
    parameters: &[Parameter<'_>],
) -> Result<Run, StudyError> {
    let Conditions { sample_time, noise, seed, feedback } = conditions;
    let mut controller = vec![
        ("controller.initial_voltage", Value::Real(0.0)),
        ("controller.feedback", Value::Text(feedback)),
    ];
    controller.extend_from_slice(parameters);
    packages.simulate(
        &[
            ("initial.flux", Value::Real(INITIAL_FLUX)),
            ("sensor.noise", Value::Real(noise)),
            ("sensor.seed", Value::Integer(seed)),
        ],
        &controller,
        &[
            ("plant", "position"),
            ("plant", "velocity"),
            ("plant", "flux"),
            ("controller", "voltage"),
            ("controller", "estimate.velocity"),
            ("controller", "estimate.flux"),
        ],
        sample_time,
        DURATION,
    )
}

impl ObserverCandidate {
    /// Parameters of this observer under some sensor noise \[m\].
    pub fn parameters(&self, noise: f64) -> Vec<Parameter<'static>> {
        let mut parameters = self.parameters.to_vec();
        if self.knows_noise {
            // A filter cannot be told that its sensor is perfect.
            parameters.push(("observer.position_noise", Value::Real(noise.max(1e-12))));
        }
        parameters
    }
}

/// Root mean square error of the estimate of a state over the scored part of a run.
pub fn rms_error(run: &Run, state: &str) -> f64 {
    root_mean_square(run.since(SCORED_FROM, &run.error(state)))
}

/// Whether the rotor stayed near the centre all the time.
pub fn remained_levitated(run: &Run) -> bool {
    run.state("position").iter().all(|position| position.abs() <= LOST_BEYOND)
}
