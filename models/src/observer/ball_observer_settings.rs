//! What the levitated ball's observer is told and what it answers.

use super::drem::MixingSettings;
use crate::plant::levitated_ball::{LevitatedBall, State};
use serde::{Deserialize, Serialize};

/// What an integral term of the flux estimator blames for a wandering offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Adaptation {
    /// The resistance is not what it is believed to be.
    Resistance,
    /// A constant voltage adds to the measured one.
    VoltageOffset,
}

/// How the flux offset is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FluxEstimator {
    /// Proposition 6
    Mixing(MixingSettings),
    /// The same with a normalised gain, see [`super::drem::normalised`]; not in the paper.
    NormalisedMixing { mixing: MixingSettings, level: f64 },
    /// Beyond the paper, see [`super::polynomial_newton`].
    Newton {
        /// G \[1/s\]
        gain: f64,
        /// What to learn with the gain G_I \[1/s2\].
        adaptation: Option<(Adaptation, f64)>,
    },
}

/// What the observer knows of its plant and how fast it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallObserverSettings {
    pub ball: LevitatedBall,
    /// T \[s\]
    pub sample_time: f64,
    /// Rates of the prefilters \[1/s\], different from each other.
    pub prefilters: [f64; 2],
    /// Rates of the four filters of the mixing \[1/s\].
    pub filters: [f64; 4],
    pub estimator: FluxEstimator,
    /// w_p \[1/s\]
    pub speed_rate: f64,
    /// w_y \[1/s\]
    pub position_rate: f64,
    /// Samples the offset is frozen for until the prefilters have settled.
    pub held_samples: u32,
}

/// Where the observer starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InitialBallEstimate {
    /// chi(0) \[Wb\]
    pub flux: f64,
    /// theta^(0) \[Wb\]
    pub flux_offset: f64,
    /// \[m/s\]
    pub velocity: f64,
    /// \[m\]; without it, from the first current and the flux.
    pub position: Option<f64>,
    /// Whether all filters start from zero instead of from a ball at rest. It makes the start wrong: for studies.
    pub filters_from_zero: bool,
}

/// Result of one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BallEstimate {
    pub state: State,
    /// theta^ \[Wb\]
    pub flux_offset: f64,
    /// Delta, scaled; 0 unless the estimator is DREM.
    pub excitation: f64,
    /// f(theta^), normalised: 0 for the true offset.
    pub residual: f64,
    /// Resistance \[Ohm\] and offset of the voltage \[V\], as believed or as learnt.
    pub resistance: f64,
    pub voltage_offset: f64,
    /// Whether the start-up hold is over.
    pub active: bool,
    /// Whether the observer had to start again because its numbers had run away.
    pub restarted: bool,
}
