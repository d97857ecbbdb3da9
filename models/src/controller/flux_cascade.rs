//! Flux cascade for the magnetic bearing: a law that settles, beside the paper's (8).
//!
//! Outer loop: the acceleration a_d = -kp x1 - kd x2 makes (3) a damped linear oscillator. The flux that exerts it is
//! the inverse of f(x3) = eps x3 + x3 |x3|, whose slope is unbounded where f' = eps + 2 |x3| vanishes; r bounds it:
//!
//! ```text
//! x3_d = sgn(a_d) (sqrt(eps^2 / 4 + |a_d| + r^2) - sqrt(eps^2 / 4 + r^2))        f(x3_d) = a_d for r = 0
//! ```
//!
//! Inner loop: u = x3' moves the flux there. With the feed-forward x3_d' the flux error decays as exp(-k3 t) however
//! fast the set point moves:
//!
//! ```text
//! u = k3 (x3_d - x3) + x3_d'      x3_d' = a_d' / (2 sqrt(eps^2 / 4 + |a_d| + r^2)),  a_d' = -kp x2 - kd f(x3)
//! ```
//!
//! The printed laws are linear around zero flux where the force is not, so that they need minutes.

use crate::plant::magnetic_bearing::{MagneticBearing, State};
use serde::{Deserialize, Serialize};

/// Gains of the cascade. kp = 25, kd = 10, k3 = 200, r = 1e-3 settle within 2 s at T = 1 ms and stay below 90 V;
/// kp = 100, kd = 20 within 1 s, at up to 150 V.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FluxCascade {
    /// kp \[1/s2\]: square of the position loop's natural frequency.
    pub position_gain: f64,
    /// kd \[1/s\]: 2 sqrt(kp) for critical damping.
    pub velocity_gain: f64,
    /// k3 \[1/s\]: bandwidth of the flux loop, well below 1/T.
    pub flux_gain: f64,
    /// r \[Wb\]: flux below which the force is taken for linear; the smaller, the more noise moves the voltage.
    pub regularisation: f64,
}

impl FluxCascade {
    /// Voltage \[V\] before saturation.
    #[inline]
    pub fn voltage(&self, bearing: &MagneticBearing, state: State) -> f64 {
        let (kp, kd) = (self.position_gain, self.velocity_gain);
        let acceleration = -kp * state.position - kd * state.velocity;
        let jerk = -kp * state.velocity - kd * bearing.acceleration(state.flux);
        let bias = bearing.epsilon / 2.0;
        let base = bias * bias + self.regularisation * self.regularisation;
        let root = (base + acceleration.abs()).sqrt();
        // A difference of roots without cancellation. Both are zero only at rest with r = eps = 0.
        let (flux, rate) =
            if root > 0.0 { (acceleration / (root + base.sqrt()), jerk / (2.0 * root)) } else { (0.0, 0.0) };
        self.flux_gain * (flux - state.flux) + rate
    }
}

#[cfg(test)]
mod tests {
    //! Closed loops are in `tests/core/bearing/flux_cascade.rs`.

    use super::*;
    use proptest::prelude::*;

    const CASCADE: FluxCascade =
        FluxCascade { position_gain: 25.0, velocity_gain: 10.0, flux_gain: 200.0, regularisation: 1e-3 };

    /// x3_d, from the law with the flux at zero and a unit flux gain, less the feed-forward.
    fn flux_set_point(cascade: FluxCascade, bearing: &MagneticBearing, position: f64) -> f64 {
        let state = State { position, velocity: 0.0, flux: 0.0 };
        FluxCascade { flux_gain: 1.0, ..cascade }.voltage(bearing, state)
    }

    proptest! {
        #[test]
        fn set_point_exerts_the_acceleration(position in -0.1..0.1f64, epsilon in 0.0..1.0f64) {
            let bearing = MagneticBearing { epsilon };
            let cascade = FluxCascade { regularisation: 0.0, ..CASCADE };
            let flux = flux_set_point(cascade, &bearing, position);
            prop_assert!((bearing.acceleration(flux) + 25.0 * position).abs() < 1e-14);
        }

        #[test]
        fn feed_forward_is_the_set_points_rate(
            position in -0.01..0.01f64, velocity in -0.05..0.05f64, flux in -0.2..0.2f64, epsilon in 0.0..1.0f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let rate_only = FluxCascade { flux_gain: 0.0, ..CASCADE };
            let state = State { position, velocity, flux };
            let set_point = |duration: f64| {
                // The set point along the motion (3), whatever the flux does; 1 = k3 isolates it.
                let position = position + duration * velocity;
                let velocity = velocity + duration * bearing.acceleration(flux);
                let zero = State { position, velocity, flux: 0.0 };
                FluxCascade { flux_gain: 1.0, ..CASCADE }.voltage(&bearing, zero) - rate_only.voltage(&bearing, zero)
            };
            let step = 1e-7;
            let slope = (set_point(step) - set_point(-step)) / (2.0 * step);
            let rate = rate_only.voltage(&bearing, state);
            prop_assert!((slope - rate).abs() < 1e-4 * (1.0 + rate.abs()), "{slope} {rate}");
        }
    }

    #[test]
    fn law_rests_at_the_set_point() {
        for (epsilon, regularisation) in [(0.0, 0.0), (0.0, 1e-3), (0.0909, 0.0)] {
            let cascade = FluxCascade { regularisation, ..CASCADE };
            assert_eq!(cascade.voltage(&MagneticBearing { epsilon }, State::default()), 0.0);
        }
    }
}
