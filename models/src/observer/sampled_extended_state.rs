//! An extended state observer as a sampled system: which injection, which discretisation, and what happens when it
//! diverges.
//!
//! At each sample it takes the measurement y\[k\] and the input that acted since the sample before, u\[k-1\]:
//!
//! | | predictor: z\[k\] from y\[0\] .. y\[k-1\] | current: z\[k\] from y\[0\] .. y\[k\] |
//! |-|-|-|
//! | exact | zero-order hold of y and u | plain model to k, corrected with y\[k\], same poles |
//! | Runge-Kutta | y held | y straight from y\[k-1\] to y\[k\] |
//! | Euler | forward Euler | Euler of the plain model to k, corrected with T L phi(y\[k\] - z1) |
//!
//! Of the nonlinear observer, exact takes the gains L phi(e) / e of a sample for constant over it.

use super::extended_state::{
    ExtendedState, ExtendedStateModel, Injection, LinearInjection, NonlinearInjection,
};
use super::extended_state_exact::{ExactCorrector, ExactPredictor, correct, predict};
use serde::{Deserialize, Serialize};

/// Linear (LESO) or nonlinear (NESO).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum InjectionChoice {
    Linear(LinearInjection),
    Nonlinear(NonlinearInjection),
}

/// How the differential equation becomes a difference equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Discretisation {
    Exact,
    /// With so many sub-steps per sample, at least 1.
    RungeKutta(u32),
    Euler,
}

/// Which samples an estimate uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    Predictor,
    Current,
}

/// Everything the observer is told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExtendedStateSettings {
    pub injection: InjectionChoice,
    /// b \[y/(s2 V)\]
    pub input_gain: f64,
    pub discretisation: Discretisation,
    pub form: Form,
    /// T \[s\]
    pub sample_time: f64,
}

/// Magnitude of a component of z beyond which the observer counts as diverged, far beyond any signal.
pub const DIVERGED: f64 = 1e15;

/// Result of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedStateEstimate {
    pub state: ExtendedState,
    /// y\[k\] less what the observer expected of it from the samples before.
    pub innovation: f64,
    /// Whether this sample left the range of [`DIVERGED`], so that the observer started anew from the measurement.
    pub restarted: bool,
}

/// What is computed once per set of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Step {
    Predictor(ExactPredictor),
    Corrector(ExactCorrector),
    /// Nothing.
    Direct,
}

/// The observer with its settings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExtendedStateObserver {
    settings: ExtendedStateSettings,
    step: Step,
    state: ExtendedState,
    /// y\[k-1\], none before the first sample.
    previous: Option<f64>,
}

impl ExtendedStateObserver {
    /// An observer that starts from `initial`: its estimate at the first sample.
    pub fn new(settings: ExtendedStateSettings, initial: ExtendedState) -> Self {
        Self { settings, step: prepare(&settings), state: initial, previous: None }
    }

    /// What it was set up with.
    pub fn settings(&self) -> ExtendedStateSettings {
        self.settings
    }

    /// Goes on with other settings.
    pub fn apply_settings(&mut self, settings: ExtendedStateSettings) {
        if self.settings != settings {
            self.settings = settings;
            self.step = prepare(&settings);
        }
    }

    /// Takes the sample y\[k\] and the input u\[k-1\] \[V\] that acted since the sample before.
    #[inline]
    pub fn update(&mut self, measurement: f64, input: f64) -> ExtendedStateEstimate {
        let Some(previous) = self.previous.replace(measurement) else {
            let innovation = finite(measurement - self.state.position);
            return ExtendedStateEstimate { state: self.state, innovation, restarted: false };
        };
        let b = self.settings.input_gain;
        let (state, innovation) = match (&self.step, self.settings.injection) {
            (Step::Predictor(predictor), _) => {
                let next = predictor.step(self.state, previous, input);
                (next, measurement - next.position)
            }
            (Step::Corrector(corrector), _) => {
                let predicted = predict(self.state, b * input, self.settings.sample_time);
                let error = measurement - predicted.position;
                (correct(predicted, corrector.gains, error), error)
            }
            (Step::Direct, InjectionChoice::Linear(injection)) => {
                self.direct(ExtendedStateModel { injection, input_gain: b }, previous, measurement, input)
            }
            (Step::Direct, InjectionChoice::Nonlinear(injection)) => {
                self.direct(ExtendedStateModel { injection, input_gain: b }, previous, measurement, input)
            }
        };
        // False, too, if a component is not a number.
        let within = state.largest_magnitude() <= DIVERGED;
        self.state = if within {
            state
        } else {
            ExtendedState { position: measurement, velocity: 0.0, extended: 0.0 }
        };
        ExtendedStateEstimate { state: self.state, innovation: finite(innovation), restarted: !within }
    }

    /// A sample with nothing prepared.
    #[inline]
    fn direct(
        &self,
        model: ExtendedStateModel<impl Injection>,
        previous: f64,
        measurement: f64,
        input: f64,
    ) -> (ExtendedState, f64) {
        let ExtendedStateSettings { discretisation, form, sample_time, .. } = self.settings;
        let (z, b) = (self.state, model.input_gain);
        let is_current = form == Form::Current;
        match discretisation {
            Discretisation::RungeKutta(substeps) => {
                let end = if is_current { measurement } else { previous };
                let next = model.runge_kutta(z, (previous, end), input, sample_time, substeps);
                (next, measurement - next.position)
            }
            Discretisation::Euler if is_current => {
                let driven =
                    ExtendedState { position: z.velocity, velocity: z.extended + b * input, extended: 0.0 };
                let predicted = z.plus(sample_time, driven);
                let error = measurement - predicted.position;
                (correct(predicted, model.injection.at(error), sample_time), error)
            }
            Discretisation::Euler => {
                let next = model.euler_step(z, previous, input, sample_time);
                (next, measurement - next.position)
            }
            Discretisation::Exact if is_current => {
                let predicted = predict(z, b * input, sample_time);
                let error = measurement - predicted.position;
                let gains = model.injection.frozen(error);
                (correct(predicted, ExactCorrector::new(gains, b, sample_time).gains, error), error)
            }
            Discretisation::Exact => {
                let gains = model.injection.frozen(previous - z.position);
                let next = ExactPredictor::new(gains, b, sample_time).step(z, previous, input);
                (next, measurement - next.position)
            }
        }
    }
}

fn prepare(settings: &ExtendedStateSettings) -> Step {
    let ExtendedStateSettings { injection, input_gain, discretisation, form, sample_time } = *settings;
    match (injection, discretisation, form) {
        (InjectionChoice::Linear(LinearInjection { gains }), Discretisation::Exact, Form::Predictor) => {
            Step::Predictor(ExactPredictor::new(gains, input_gain, sample_time))
        }
        (InjectionChoice::Linear(LinearInjection { gains }), Discretisation::Exact, Form::Current) => {
            Step::Corrector(ExactCorrector::new(gains, input_gain, sample_time))
        }
        _ => Step::Direct,
    }
}

/// A difference that overflows, or one to an expectation that is not a number, is as large as can be.
#[inline]
pub(super) fn finite(difference: f64) -> f64 {
    if difference.is_nan() { f64::MAX } else { difference.clamp(f64::MIN, f64::MAX) }
}
