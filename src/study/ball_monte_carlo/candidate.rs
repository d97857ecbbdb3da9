//! The estimators that are compared.

use crate::host::Value;
use crate::study::loop_packages::Parameter;

/// Settings of DREM that the tuning tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DremSetting {
    /// alpha and beta \[1/s\]
    pub prefilters: [f64; 2],
    pub filters: [f64; 4],
    /// gamma \[1/s\]; 0 does not adapt
    pub gain: f64,
    /// mu; 0 for the paper's gradient
    pub normalisation: f64,
}

impl DremSetting {
    /// The start values of the model, without adaptation.
    pub const FROZEN: Self = Self {
        prefilters: [100.0, 300.0],
        filters: [10.0, 25.0, 60.0, 150.0],
        gain: 0.0,
        normalisation: 0.0,
    };

    pub fn text(&self) -> String {
        let list = |rates: &[f64]| rates.iter().map(f64::to_string).collect::<Vec<_>>().join("/");
        let normalised = if self.normalisation > 0.0 {
            format!(", normalised with mu = {}", self.normalisation)
        } else {
            String::new()
        };
        format!(
            "gamma = {} 1/s, alpha {}, beta {} 1/s{normalised}",
            self.gain,
            list(&self.prefilters),
            list(&self.filters)
        )
    }
}

/// An estimator with the sample time it gets.
#[derive(Clone, Debug)]
pub struct ObserverCandidate {
    pub name: &'static str,
    /// T \[s\]
    pub sample_time: f64,
    pub parameters: Vec<Parameter<'static>>,
}

impl ObserverCandidate {
    /// DREM at the sample time it needs. kappa does not depend on the reference here: it is the same unit for both.
    pub fn drem(name: &'static str, setting: &DremSetting) -> Self {
        let DremSetting { prefilters, filters, gain, normalisation } = *setting;
        Self {
            name,
            sample_time: 1e-4,
            parameters: vec![
                ("observer.kind", Value::Text("drem")),
                ("observer.excitation_scale", Value::Real(3e9)),
                ("observer.gain", Value::Real(gain)),
                ("observer.normalisation", Value::Real(normalisation)),
                ("observer.prefilter[1]", Value::Real(prefilters[0])),
                ("observer.prefilter[2]", Value::Real(prefilters[1])),
                ("observer.filter[1]", Value::Real(filters[0])),
                ("observer.filter[2]", Value::Real(filters[1])),
                ("observer.filter[3]", Value::Real(filters[2])),
                ("observer.filter[4]", Value::Real(filters[3])),
            ],
        }
    }

    /// A Newton variant with the model's start values.
    pub fn newton(name: &'static str, parameters: &[Parameter<'static>]) -> Self {
        let mut all = vec![("observer.startup_hold", Value::Real(0.02))];
        all.extend_from_slice(parameters);
        Self { name, sample_time: 2e-4, parameters: all }
    }
}

pub const DREM: usize = 0;
pub const FROZEN: usize = 1;
pub const NEWTON: usize = 2;
pub const ADAPTIVE_RESISTANCE: usize = 3;
pub const ADAPTIVE_OFFSET: usize = 4;
pub const CANDIDATES: usize = 5;

/// The Newton variant without adaptation.
pub fn newton() -> ObserverCandidate {
    ObserverCandidate::newton("Newton", &[("observer.kind", Value::Text("polynomial_newton"))])
}

/// All candidates in the order of the constants above, DREM with its best setting.
pub fn all(tuned: &DremSetting) -> [ObserverCandidate; CANDIDATES] {
    let adaptive = Value::Text("polynomial_newton_adaptive");
    [
        ObserverCandidate::drem("DREM, retuned", tuned),
        ObserverCandidate::drem("no adaptation", &DremSetting::FROZEN),
        newton(),
        ObserverCandidate::newton(
            "adaptive Newton, resistance",
            &[("observer.kind", adaptive), ("observer.adaptation", Value::Text("resistance"))],
        ),
        ObserverCandidate::newton(
            "adaptive Newton, voltage offset",
            &[("observer.kind", adaptive), ("observer.adaptation", Value::Text("voltage_offset"))],
        ),
    ]
}
