//! Settings of the magnetic bearing's full-order Newton observers (Mystkowski, Kotta, Kaparin 2018).

use crate::plant::magnetic_bearing::{MagneticBearing, Map};
use serde::{Deserialize, Serialize};

/// What the observer knows of its plant and how hard it tries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonSettings {
    pub bearing: MagneticBearing,
    /// Model inside H and F; the paper inverts the printed one.
    pub map: Map,
    /// T \[s\]
    pub sample_time: f64,
    /// d of (6), at least 1.
    pub max_iterations: u32,
    /// alpha of Remark 2, in (0, 1\].
    pub step_size: f64,
    /// Varying step size of Remark 5: halves a step, from alpha on, until it decreases |Y - H(w)|. It helps a poor
    /// start: from nearly zero flux a full step overshoots the more the smaller the slope.
    pub line_search: bool,
}
