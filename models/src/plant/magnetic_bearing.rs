//! One-degree-of-freedom active magnetic bearing with flux control.
//!
//! Paper: Mystkowski, Kotta, Kaparin, "Newton observer for a nonlinear flux-controlled AMB system",
//! Proc. Estonian Acad. Sci. 67(1), 2018. Its equation (3), with x1 the position \[m\], x2 the velocity
//! \[m/s\], x3 the flux \[Wb\] and u the voltage \[V\] (the paper's variables are normalised; these are the units
//! of its Table 1):
//!
//! ```text
//! x1' = x2        x2' = eps x3 + x3 |x3|        x3' = u        y = x1                                  (3)
//! ```
//!
//! Under a held voltage the flux is a straight line, so the solution is a polynomial as long as the flux keeps
//! its sign. The paper prints that polynomial as (4a) and calls it exact; it is so only without a sign change.
//! [`Map::Exact`] splits the step where the flux crosses zero.

use crate::scalar::Scalar;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// State of the bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// x1 \[m\]
    pub position: f64,
    /// x2 \[m/s\]
    pub velocity: f64,
    /// x3 \[Wb\]
    pub flux: f64,
}

impl State {
    /// The state after `duration` \[s\] under a held `voltage` \[V\], given what the force adds over it.
    #[inline]
    pub fn after(self, effect: ForceEffect, voltage: f64, duration: f64) -> Self {
        Self {
            position: self.position + duration * self.velocity + effect.position,
            velocity: self.velocity + effect.velocity,
            flux: self.flux + voltage * duration,
        }
    }

    /// Whether no component is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.velocity.is_finite() && self.flux.is_finite()
    }
}

/// Which closed form advances the state over a step with held voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Map {
    /// (4a) as printed, sgn(0) = 0: wrong when the flux changes its sign inside the step.
    Printed,
    /// (4a) up to the zero crossing and again after it: the solution of (3).
    Exact,
}

/// What the magnetic force adds to velocity \[m/s\] and position \[m\] over one step, beyond free flight; or the
/// derivative of both with respect to the flux at the step's start \[1/Wb\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceEffect {
    pub velocity: f64,
    pub position: f64,
}

/// The bearing of (3).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MagneticBearing<S = f64> {
    /// eps = 2 Phi0 / Phi_sat \[1\]; 0 is operation without bias flux.
    pub epsilon: S,
}

impl<S: Scalar> MagneticBearing<S> {
    /// The bearing with a given bias flux Phi0 and saturation flux Phi_sat, both in Wb.
    pub fn with_bias(bias_flux: S, saturation_flux: S) -> Self {
        Self { epsilon: S::from(2.0) * bias_flux / saturation_flux }
    }

    /// x2' of (3) \[m/s2\].
    pub fn acceleration(&self, flux: S) -> S {
        self.epsilon * flux + flux * flux.abs()
    }
}

impl MagneticBearing {
    /// The state after `duration` \[s\] under a held `voltage` \[V\].
    #[inline]
    pub fn advance(&self, map: Map, state: State, voltage: f64, duration: f64) -> State {
        state.after(self.force_effect(map, state.flux, voltage, duration), voltage, duration)
    }

    /// Force effect over a step that starts with `flux` \[Wb\].
    #[inline(always)]
    pub fn force_effect(&self, map: Map, flux: f64, voltage: f64, duration: f64) -> ForceEffect {
        let flux_after = flux + voltage * duration;
        if map == Map::Exact && flux * flux_after < 0.0 {
            return self.effect_across_zero(flux, voltage, duration);
        }
        self.effect_with_sign(flux_sign(map, flux, voltage), flux, voltage, duration)
    }

    /// Terms of (4a) that stem from the force, with sgn(x3) replaced by `sign`. With z = x3 + u T they are
    ///
    /// ```text
    /// velocity:  T (eps (x3 + z) / 2 + s (x3^2 + z (x3 + z)) / 3)
    /// position:  T^2 (eps (2 x3 + z) / 6 + s (3 x3^2 + z (2 x3 + z)) / 12)
    /// ```
    #[inline(always)]
    fn effect_with_sign(&self, sign: f64, flux: f64, voltage: f64, duration: f64) -> ForceEffect {
        let flux_after = flux + voltage * duration;
        let (once, twice) = (flux + flux_after, 2.0 * flux + flux_after);
        let square = flux * flux;
        let (third, twelfth) = (sign * duration * (1.0 / 3.0), sign * duration * duration * (1.0 / 12.0));
        let (half, sixth) = (self.epsilon * duration * 0.5, self.epsilon * duration * duration * (1.0 / 6.0));
        ForceEffect {
            velocity: half * once + third * (square + flux_after * once),
            position: sixth * twice + twelfth * (3.0 * square + flux_after * twice),
        }
    }

    /// (4a) to the zero crossing at t1 = -x3/u, then from zero flux with the sign of the voltage.
    #[cold]
    fn effect_across_zero(&self, flux: f64, voltage: f64, duration: f64) -> ForceEffect {
        let crossing = -flux / voltage;
        let rest = duration - crossing;
        let before = self.effect_with_sign(flux.signum(), flux, voltage, crossing);
        let after = self.effect_with_sign(voltage.signum(), 0.0, voltage, rest);
        ForceEffect {
            velocity: before.velocity + after.velocity,
            position: before.position + rest * before.velocity + after.position,
        }
    }

    /// Derivative of [`Self::force_effect`] with respect to the flux at the start; all forms are free of
    /// cancellation, also for a vanishing voltage. For the printed map d|x3|/dx3 = sgn(x3) and d sgn(x3)/dx3 = 0,
    /// as the paper assumes.
    #[inline(always)]
    pub fn force_effect_slope(&self, map: Map, flux: f64, voltage: f64, duration: f64) -> ForceEffect {
        let flux_after = flux + voltage * duration;
        if map == Map::Exact && flux * flux_after < 0.0 {
            return self.slope_across_zero(flux.abs(), flux_after.abs(), voltage, duration);
        }
        self.slope_with_sign(flux_sign(map, flux, voltage), flux, voltage, duration)
    }

    /// [`Self::force_effect`] and [`Self::force_effect_slope`] at once.
    #[inline(always)]
    pub fn linearised_force_effect(
        &self,
        map: Map,
        flux: f64,
        voltage: f64,
        duration: f64,
    ) -> (ForceEffect, ForceEffect) {
        let flux_after = flux + voltage * duration;
        if map == Map::Exact && flux * flux_after < 0.0 {
            return (
                self.effect_across_zero(flux, voltage, duration),
                self.slope_across_zero(flux.abs(), flux_after.abs(), voltage, duration),
            );
        }
        let sign = flux_sign(map, flux, voltage);
        (
            self.effect_with_sign(sign, flux, voltage, duration),
            self.slope_with_sign(sign, flux, voltage, duration),
        )
    }

    /// Slope while the flux keeps its `sign`.
    #[inline(always)]
    fn slope_with_sign(&self, sign: f64, flux: f64, voltage: f64, duration: f64) -> ForceEffect {
        let flux_after = flux + voltage * duration;
        ForceEffect {
            velocity: duration * (self.epsilon + sign * (flux + flux_after)),
            position: duration
                * duration
                * (0.5 * self.epsilon + sign * ((2.0 * flux + flux_after) * (1.0 / 3.0))),
        }
    }

    /// Slope when the flux crosses zero, with a = |x3| before and b = |x3 + u T| after.
    #[cold]
    fn slope_across_zero(&self, a: f64, b: f64, voltage: f64, duration: f64) -> ForceEffect {
        let bias = self.epsilon * duration;
        ForceEffect {
            velocity: bias + (a * a + b * b) / voltage.abs(),
            position: bias * duration / 2.0
                + (b * b * b + a * a * (3.0 * b + 2.0 * a)) / (3.0 * voltage * voltage),
        }
    }

    /// Jacobian of [`Self::advance`] with respect to (position, velocity, flux).
    pub fn jacobian(&self, map: Map, flux: f64, voltage: f64, duration: f64) -> Matrix3<f64> {
        let slope = self.force_effect_slope(map, flux, voltage, duration);
        Matrix3::new(1.0, duration, slope.position, 0.0, 1.0, slope.velocity, 0.0, 0.0, 1.0)
    }
}

/// sgn(x3) of (4a). The printed map knows sgn(0) = 0; from zero flux the true motion follows the voltage's sign.
#[inline(always)]
fn flux_sign(map: Map, flux: f64, voltage: f64) -> f64 {
    if flux != 0.0 {
        1f64.copysign(flux)
    } else if map == Map::Exact && voltage != 0.0 {
        voltage.signum()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Classical Runge-Kutta on (3) with many sub-steps, the crossing resolved by step size alone.
    fn integrate(bearing: &MagneticBearing, mut state: State, voltage: f64, duration: f64) -> State {
        let steps = 20_000;
        let h = duration / f64::from(steps);
        for _ in 0..steps {
            let middle = bearing.acceleration(state.flux + voltage * h / 2.0);
            let (start, end) =
                (bearing.acceleration(state.flux), bearing.acceleration(state.flux + voltage * h));
            state.position += h * state.velocity + h * h / 6.0 * (start + 2.0 * middle);
            state.velocity += h / 6.0 * (start + 4.0 * middle + end);
            state.flux += voltage * h;
        }
        state
    }

    proptest! {
        #[test]
        fn exact_map_solves_the_differential_equation(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, epsilon in 0.0..1.0f64, duration in 1e-4..5e-3f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let start = State { position: 0.01, velocity: -0.02, flux };
            let exact = bearing.advance(Map::Exact, start, voltage, duration);
            let reference = integrate(&bearing, start, voltage, duration);
            prop_assert!((exact.position - reference.position).abs() < 1e-11);
            prop_assert!((exact.velocity - reference.velocity).abs() < 1e-9);
        }

        #[test]
        fn exact_map_composes(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, epsilon in 0.0..1.0f64, share in 0.0..1.0f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let start = State { position: 0.01, velocity: -0.02, flux };
            let whole = bearing.advance(Map::Exact, start, voltage, 2e-3);
            let part = bearing.advance(Map::Exact, start, voltage, 2e-3 * share);
            let composed = bearing.advance(Map::Exact, part, voltage, 2e-3 * (1.0 - share));
            prop_assert!((whole.position - composed.position).abs() < 1e-16);
            prop_assert!((whole.velocity - composed.velocity).abs() < 1e-16);
        }

        #[test]
        fn maps_agree_without_a_sign_change(
            flux in 0.1..0.2f64, voltage in -80.0..80.0f64, epsilon in 0.0..1.0f64, mirrored: bool,
        ) {
            let bearing = MagneticBearing { epsilon };
            let flux = if mirrored { -flux } else { flux };
            prop_assert_eq!(
                bearing.force_effect(Map::Exact, flux, voltage, 1e-3),
                bearing.force_effect(Map::Printed, flux, voltage, 1e-3)
            );
        }

        #[test]
        fn effect_and_slope_at_once_are_the_same(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, epsilon in 0.0..1.0f64, no_flux: bool,
        ) {
            let bearing = MagneticBearing { epsilon };
            let flux = if no_flux { 0.0 } else { flux };
            for map in [Map::Exact, Map::Printed] {
                let (effect, slope) = bearing.linearised_force_effect(map, flux, voltage, 1e-3);
                prop_assert_eq!(effect, bearing.force_effect(map, flux, voltage, 1e-3));
                prop_assert_eq!(slope, bearing.force_effect_slope(map, flux, voltage, 1e-3));
            }
        }

        #[test]
        fn slopes_are_the_derivatives(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, epsilon in 0.0..1.0f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let (t, delta) = (1e-3, 1e-6);
            for map in [Map::Exact, Map::Printed] {
                // (4a) is not differentiable at zero flux, and neither map where the end is zero.
                prop_assume!(flux.abs() > 2.0 * delta && (flux + voltage * t).abs() > 2.0 * delta);
                let slope = bearing.force_effect_slope(map, flux, voltage, t);
                let up = bearing.force_effect(map, flux + delta, voltage, t);
                let down = bearing.force_effect(map, flux - delta, voltage, t);
                prop_assert!((slope.velocity - (up.velocity - down.velocity) / (2.0 * delta)).abs() < 1e-10);
                prop_assert!((slope.position - (up.position - down.position) / (2.0 * delta)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn printed_map_misses_the_zero_crossing() {
        let bearing = MagneticBearing { epsilon: 0.0 };
        let start = State { position: 0.0, velocity: 0.0, flux: 0.05 };
        let exact = bearing.advance(Map::Exact, start, -100.0, 1e-3);
        let printed = bearing.advance(Map::Printed, start, -100.0, 1e-3);
        // Symmetric about the crossing, so the true force leaves no velocity.
        assert!(exact.velocity.abs() < 1e-20);
        assert!((printed.velocity - 8.333e-7).abs() < 1e-9, "{}", printed.velocity);
    }

    #[test]
    fn step_from_zero_flux_follows_the_voltage() {
        let bearing = MagneticBearing { epsilon: 0.0 };
        let exact = bearing.advance(Map::Exact, State::default(), -150.0, 1e-3);
        assert!((exact.velocity + 1e-9 / 3.0 * 150.0 * 150.0).abs() < 1e-18);
        assert_eq!(bearing.advance(Map::Printed, State::default(), -150.0, 1e-3).velocity, 0.0);
    }
}
