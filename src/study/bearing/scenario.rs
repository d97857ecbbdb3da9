//! One run of the bearing's control loop through the packaged units.

use std::path::Path;

use super::SAMPLE_TIME;
use crate::host::{ExchangeOrder, Fmu, HostError, Logging, TwoUnitLoop};
use crate::study::StudyError;

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

/// The two packages of the bearing.
pub struct Bearing {
    plant: Fmu,
    controller: Fmu,
}

impl Bearing {
    /// Opens the FMI 3.0 packages below `packages`.
    pub fn open(packages: &Path) -> Result<Self, HostError> {
        Ok(Self {
            plant: Fmu::open(&packages.join("fmi3/MagneticBearingPlant.fmu"))?,
            controller: Fmu::open(&packages.join("fmi3/MagneticBearingController.fmu"))?,
        })
    }

    /// The plant's package.
    pub fn plant(&self) -> &Fmu {
        &self.plant
    }

    /// Runs a scenario for `duration` \[s\], controller first.
    pub fn simulate(&self, scenario: &Scenario, duration: f64) -> Result<Run, StudyError> {
        let mut plant = self.plant.instantiate("plant", Logging::Off)?;
        plant.set_by_name("initial.position", scenario.initial_position)?;
        plant.set_by_name("bias_flux", scenario.bias_flux)?;
        let mut controller = self.controller.instantiate("controller", Logging::Off)?;
        controller.set_by_name("controller.initial_voltage", scenario.initial_voltage)?;
        controller.set_by_name("controller.law", scenario.law)?;
        let feedback = match scenario.feedback {
            Feedback::Estimate => "estimate",
            Feedback::State => "state",
        };
        controller.set_by_name("controller.feedback", feedback)?;
        controller.set_by_name("observer.max_iterations", scenario.max_iterations)?;
        controller.set_by_name("bias_flux", scenario.bias_flux)?;

        let mut control_loop = TwoUnitLoop::connect(
            controller,
            plant,
            ExchangeOrder::ControllerFirst,
            &[("position", "position"), ("velocity", "state.velocity"), ("flux", "state.flux")],
            &[("voltage", "voltage")],
        )?;
        control_loop.record(&RECORDED)?;
        control_loop.initialise(0.0, Some(duration), SAMPLE_TIME)?;
        // One more step than fits, so that the last sample is the one at `duration`.
        let trace = control_loop.run((duration / SAMPLE_TIME).round() as usize + 1)?;
        let mut columns = trace.columns.into_iter();
        let mut next = || columns.next().unwrap_or_default();
        Ok(Run {
            time: trace.time,
            state: [next(), next(), next()],
            estimate: [next(), next(), next()],
            voltage: next(),
        })
    }
}
