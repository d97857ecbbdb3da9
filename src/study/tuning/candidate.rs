//! What a particle stands for: an extended state observer's parameters, their box and their names in the controller model.

use crate::observer::extended_state::{
    ExtendedStateModel, Gains, LinearInjection, NonlinearInjection, gains_from_bandwidth,
};

use super::swarm::Range;
use crate::host::Value;
use crate::study::loop_packages::Parameter;

/// Which observer is tuned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObserverKind {
    Linear,
    Nonlinear,
}

/// Parameters of an extended state observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Candidate {
    Linear {
        /// wo \[rad/s\]
        bandwidth: f64,
        /// b
        input_gain: f64,
    },
    Nonlinear {
        /// L \[1/s, 1/s2, 1/s3\]
        gains: Gains,
        /// b
        input_gain: f64,
        /// alpha
        exponents: [f64; 3],
        /// delta, in the unit of the measurement
        linear_zones: [f64; 3],
    },
}

/// Table 3.
pub const TABLE_3: Candidate = Candidate::Linear { bandwidth: 100.0, input_gain: 1.0 };
/// Table 4.
pub const TABLE_4: Candidate = Candidate::Nonlinear {
    gains: gains_from_bandwidth(100.0),
    input_gain: 1.0,
    exponents: [1.0, 0.5, 0.25],
    linear_zones: [0.01; 3],
};

/// Positions of a particle and what they mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchSpace {
    /// (wo, b)
    BandwidthAndGain,
    /// (log10 L1, log10 L2, log10 L3, b, alpha1, alpha2, alpha3, log10 delta1, log10 delta2, log10 delta3); the box of
    /// alpha and delta is the paper's, 0 < alpha <= 1 and 0 < delta < 1.2.
    EverythingNonlinear,
    /// (log10 wo, b / 1000), for volts.
    LogarithmicBandwidthAndGain,
    /// (log10 wo, b / 1000, alpha2, alpha3, log10 delta), for volts: gains tied to wo, alpha1 = 1, one delta.
    TiedNonlinear,
}

impl SearchSpace {
    /// The box.
    pub fn bounds(self) -> &'static [Range] {
        // log10 of 1500, 7.5e5, 1.25e8: five times Table 4 in the sense of wo = 500 rad/s; and of 1.2.
        const LOG_L1: f64 = 3.176_091_259_055_681;
        const LOG_L2: f64 = 5.875_061_263_391_7;
        const LOG_L3: f64 = 8.096_910_013_008_056;
        const LOG_DELTA: f64 = 0.079_181_246_047_624_8;
        const EXPONENT: Range = (0.05, 1.0);
        match self {
            Self::BandwidthAndGain => &[(10.0, 500.0), (-50.0, 50.0)],
            Self::EverythingNonlinear => &[
                (1.0, LOG_L1),
                (2.0, LOG_L2),
                (3.0, LOG_L3),
                (-50.0, 50.0),
                EXPONENT,
                EXPONENT,
                EXPONENT,
                (-3.0, LOG_DELTA),
                (-3.0, LOG_DELTA),
                (-3.0, LOG_DELTA),
            ],
            Self::LogarithmicBandwidthAndGain => &[(1.0, 3.0), (-8.0, 2.0)],
            Self::TiedNonlinear => &[(1.0, 3.0), (-8.0, 2.0), EXPONENT, EXPONENT, (-3.0, LOG_DELTA)],
        }
    }

    /// The observer at a position in the box; `None` for another number of coordinates.
    pub fn candidate(self, position: &[f64]) -> Option<Candidate> {
        let power = |exponent: f64| libm::pow(10.0, exponent);
        match (self, position) {
            (Self::BandwidthAndGain, &[bandwidth, input_gain]) => {
                Some(Candidate::Linear { bandwidth, input_gain })
            }
            (Self::EverythingNonlinear, &[l1, l2, l3, input_gain, a1, a2, a3, d1, d2, d3]) => {
                Some(Candidate::Nonlinear {
                    gains: [l1, l2, l3].map(power),
                    input_gain,
                    exponents: [a1, a2, a3],
                    linear_zones: [d1, d2, d3].map(power),
                })
            }
            (Self::LogarithmicBandwidthAndGain, &[bandwidth, input_gain]) => {
                Some(Candidate::Linear { bandwidth: power(bandwidth), input_gain: 1e3 * input_gain })
            }
            (Self::TiedNonlinear, &[bandwidth, input_gain, a2, a3, delta]) => Some(Candidate::Nonlinear {
                gains: gains_from_bandwidth(power(bandwidth)),
                input_gain: 1e3 * input_gain,
                exponents: [1.0, a2, a3],
                linear_zones: [power(delta); 3],
            }),
            _ => None,
        }
    }
}

/// A candidate as the model that is run, so that the run is compiled for each injection.
pub enum Model {
    Linear(ExtendedStateModel<LinearInjection>),
    Nonlinear(ExtendedStateModel<NonlinearInjection>),
}

impl Candidate {
    pub fn model(&self) -> Model {
        match *self {
            Self::Linear { bandwidth, input_gain } => Model::Linear(ExtendedStateModel {
                injection: LinearInjection::from_bandwidth(bandwidth),
                input_gain,
            }),
            Self::Nonlinear { gains, input_gain, exponents, linear_zones } => {
                Model::Nonlinear(ExtendedStateModel {
                    injection: NonlinearInjection::new(gains, exponents, linear_zones),
                    input_gain,
                })
            }
        }
    }
}

impl Candidate {
    /// As parameters of the controller model.
    pub fn parameters(&self) -> Vec<Parameter<'static>> {
        const GAINS: [&str; 3] = ["observer.gain[1]", "observer.gain[2]", "observer.gain[3]"];
        const EXPONENTS: [&str; 3] = ["observer.exponent[1]", "observer.exponent[2]", "observer.exponent[3]"];
        const ZONES: [&str; 3] =
            ["observer.linear_zone[1]", "observer.linear_zone[2]", "observer.linear_zone[3]"];
        match *self {
            Self::Linear { bandwidth, input_gain } => vec![
                ("observer.kind", Value::Text("linear")),
                ("observer.tuning", Value::Text("bandwidth")),
                ("observer.bandwidth", Value::Real(bandwidth)),
                ("observer.input_gain", Value::Real(input_gain)),
            ],
            Self::Nonlinear { gains, input_gain, exponents, linear_zones } => {
                let mut parameters = vec![
                    ("observer.kind", Value::Text("nonlinear")),
                    ("observer.tuning", Value::Text("gains")),
                    ("observer.input_gain", Value::Real(input_gain)),
                ];
                for (names, values) in [(GAINS, gains), (EXPONENTS, exponents), (ZONES, linear_zones)] {
                    parameters.extend(names.into_iter().zip(values.map(Value::Real)));
                }
                parameters
            }
        }
    }
}
