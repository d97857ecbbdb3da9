//! One run of the bearing's control loop through the packaged units.

use super::SAMPLE_TIME;
use crate::host::Value;
use crate::study::StudyError;
use crate::study::loop_packages::LoopPackages;

/// What the law is fed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    Estimate,
    State,
}

/// Parameters of a run; everything else keeps its start value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario {
    /// x1(0) \[m\]
    pub initial_position: f64,
    /// u(0) \[V\]
    pub initial_voltage: f64,
    /// Item of the enumeration `controller.law`.
    pub law: &'static str,
    pub feedback: Feedback,
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
            feedback: Feedback::Estimate,
            bias_flux: 0.0,
            max_iterations: 10,
        }
    }

    pub fn law(self, law: &'static str) -> Self {
        Self { law, ..self }
    }

    pub fn feedback(self, feedback: Feedback) -> Self {
        Self { feedback, ..self }
    }

    pub fn bias_flux(self, bias_flux: f64) -> Self {
        Self { bias_flux, ..self }
    }

    pub fn max_iterations(self, max_iterations: i32) -> Self {
        Self { max_iterations, ..self }
    }
}

/// Samples of a run, one per tick; states in the order position \[m\], velocity \[m/s\], flux \[Wb\].
pub struct Run {
    /// \[s\]
    pub time: Vec<f64>,
    pub state: [Vec<f64>; 3],
    pub estimate: [Vec<f64>; 3],
    /// \[V\]
    pub voltage: Vec<f64>,
}

impl Run {
    /// Estimate minus truth of one state, sample by sample.
    pub fn error(&self, state: usize) -> impl Iterator<Item = f64> + '_ {
        self.estimate[state].iter().zip(&self.state[state]).map(|(estimate, truth)| estimate - truth)
    }

    /// Largest magnitude of one state.
    pub fn peak(&self, state: usize) -> f64 {
        largest(self.state[state].iter().copied())
    }

    /// Largest magnitude of one state's estimation error from `start` \[s\] on.
    pub fn largest_error_after(&self, start: f64, state: usize) -> f64 {
        largest(
            self.time
                .iter()
                .zip(self.error(state))
                .filter(|(time, _)| **time >= start)
                .map(|(_, error)| error),
        )
    }
}

/// Largest magnitude.
pub fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |peak, value| peak.max(value.abs()))
}

const RECORDED: [(&str, &str); 7] = [
    ("plant", "position"),
    ("plant", "velocity"),
    ("plant", "flux"),
    ("controller", "estimate.position"),
    ("controller", "estimate.velocity"),
    ("controller", "estimate.flux"),
    ("controller", "voltage"),
];

/// Runs a scenario for `duration` \[s\].
pub fn simulate(packages: &LoopPackages, scenario: &Scenario, duration: f64) -> Result<Run, StudyError> {
    let feedback = match scenario.feedback {
        Feedback::Estimate => "estimate",
        Feedback::State => "state",
    };
    let trace = packages.simulate(
        &[
            ("initial.position", Value::Real(scenario.initial_position)),
            ("bias_flux", Value::Real(scenario.bias_flux)),
        ],
        &[
            ("controller.initial_voltage", Value::Real(scenario.initial_voltage)),
            ("controller.law", Value::Text(scenario.law)),
            ("controller.feedback", Value::Text(feedback)),
            ("observer.max_iterations", Value::Integer(scenario.max_iterations)),
            ("bias_flux", Value::Real(scenario.bias_flux)),
        ],
        &RECORDED,
        SAMPLE_TIME,
        duration,
    )?;
    let mut columns = trace.columns.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    Ok(Run {
        time: trace.time,
        state: [next(), next(), next()],
        estimate: [next(), next(), next()],
        voltage: next(),
    })
}
