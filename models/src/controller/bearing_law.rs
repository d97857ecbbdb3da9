//! Any of the magnetic bearing's laws, which may be exchanged while a loop runs.

use super::bearing_feedback::{self, Gains, Law};
use super::flux_cascade::FluxCascade;
use crate::plant::magnetic_bearing::{MagneticBearing, State};
use serde::{Deserialize, Serialize};

/// A law with its gains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum BearingLaw {
    /// (8a), (8b), (8c)
    Printed(Law, Gains),
    FluxCascade(FluxCascade, MagneticBearing),
}

impl BearingLaw {
    /// Voltage \[V\] before saturation.
    #[inline]
    pub fn voltage(&self, state: State) -> f64 {
        match self {
            Self::Printed(law, gains) => bearing_feedback::voltage(*law, *gains, state),
            Self::FluxCascade(cascade, bearing) => cascade.voltage(bearing, state),
        }
    }
}
