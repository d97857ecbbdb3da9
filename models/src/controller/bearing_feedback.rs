//! The three nonlinear laws (8) of the magnetic bearing paper (Mystkowski, Kotta, Kaparin 2018).

use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};

/// Which of the laws (8a), (8b), (8c).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Law {
    A,
    B,
    C,
}

/// Gains of the linear part u0 = -k1 x1 - k2 x2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// k1 \[V/m\], printed 0.92
    pub position: f64,
    /// k2 \[V s/m\], printed 9.94
    pub velocity: f64,
}

/// Voltage \[V\] before saturation.
///
/// ```text
/// u = -3 x1^2 x3 - 2 x2 |x3| - 3 x1 x2 x3 - x3 + u0               (8a)
/// u = (3 x1^2 + 2 x2 x3 |x3| + 3 x1 x2 - x3) / 2 + u0             (8b)
/// u = -x2 |x3| - x3 - x1 x2 x3 + u0                               (8c)
/// ```
///
/// All three are linear in the velocity and are evaluated as such, because the velocity is known last.
#[inline]
pub fn voltage(law: Law, gains: Gains, state: State) -> f64 {
    let State { position: x1, velocity: x2, flux: x3 } = state;
    let (k1, k2) = (gains.position, gains.velocity);
    let (at_rest, damping) = match law {
        Law::A => (-3.0 * x1 * x1 * x3 - x3, 2.0 * x3.abs() + 3.0 * x1 * x3 + k2),
        Law::B => ((3.0 * x1 * x1 - x3) / 2.0, k2 - x3 * x3.abs() - 1.5 * x1),
        Law::C => (-x3, x3.abs() + x1 * x3 + k2),
    };
    at_rest - k1 * x1 - damping * x2
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: Gains = Gains { position: 0.92, velocity: 9.94 };

    #[test]
    fn laws_at_hand_worked_points() {
        // x = (0.5, -2, -0.25): |x3| = 0.25, u0 = -0.46 + 19.88 = 19.42.
        let state = State { position: 0.5, velocity: -2.0, flux: -0.25 };
        let near = |law, expected: f64| {
            let u = voltage(law, GAINS, state);
            assert!((u - expected).abs() < 1e-14, "{law:?}: {u}");
        };
        near(Law::A, 0.1875 + 1.0 - 0.75 + 0.25 + 19.42);
        near(Law::B, (0.75 + 0.25 - 3.0 + 0.25) / 2.0 + 19.42);
        near(Law::C, 0.5 + 0.25 - 0.25 + 19.42);
    }

    #[test]
    fn laws_vanish_at_the_set_point() {
        for law in [Law::A, Law::B, Law::C] {
            assert_eq!(voltage(law, GAINS, State::default()), 0.0);
        }
    }
}
