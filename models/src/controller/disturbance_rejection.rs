//! Linear active disturbance rejection (Gao 2003): a law that closes the loop through an extended state observer.
//!
//! With x'' = f + b u and z3 the estimate of f the input cancels f, and what is left is a double integrator with
//! both poles at -wc:
//!
//! ```text
//! u = (r'' + wc^2 (r - z1) + 2 wc (r' - z2) - z3) / b0
//! ```
//!
//! The maglev rig's paper stops at watching; this is what its observers are good for. The observer must assume the same
//! b0. It needs no operating voltage: z3 finds it.

use crate::observer::extended_state::ExtendedState;
use crate::signal::reference_filter::Reference;
use serde::{Deserialize, Serialize};

/// The law with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisturbanceRejection {
    /// wc \[rad/s\]: a fifth of the observer's bandwidth or less.
    pub bandwidth: f64,
    /// b0 \[y/(s2 V)\], not 0; a wrong sign loses the ball.
    pub input_gain: f64,
}

impl DisturbanceRejection {
    /// u \[V\] before saturation.
    #[inline]
    pub fn voltage(&self, reference: Reference, z: ExtendedState) -> f64 {
        let wc = self.bandwidth;
        let acceleration = reference.acceleration
            + wc * wc * (reference.position - z.position)
            + 2.0 * wc * (reference.velocity - z.velocity);
        (acceleration - z.extended) / self.input_gain
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn known_disturbance_leaves_a_critically_damped_error(
            position in -1.0..1.0f64, velocity in -10.0..10.0f64, extended in -1e4..1e4f64,
            r in -1.0..1.0f64, rate in -10.0..10.0f64, curvature in -1e3..1e3f64,
        ) {
            let law = DisturbanceRejection { bandwidth: 60.0, input_gain: -3705.0 };
            let reference = Reference { position: r, velocity: rate, acceleration: curvature };
            let voltage = law.voltage(reference, ExtendedState { position, velocity, extended });
            // x'' = f + b u; e'' + 2 wc e' + wc^2 e = 0 with e = x - r.
            let acceleration = extended + law.input_gain * voltage;
            let error_dynamics =
                (acceleration - curvature) + 120.0 * (velocity - rate) + 3600.0 * (position - r);
            prop_assert!(error_dynamics.abs() < 1e-10 * (1e4 + extended.abs()));
        }
    }
}
