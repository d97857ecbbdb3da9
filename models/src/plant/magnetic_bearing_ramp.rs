//! The magnetic bearing under a voltage that moves along a straight line.
//!
//! Not in the paper, whose closed form (4a) is for a held voltage. With u = u0 + u1 t the flux of (3) is a parabola and
//! the acceleration eps x3 + s x3^2 a polynomial of degree 4 as long as the flux keeps its sign s. Three Gauss-Legendre
//! points integrate polynomials up to degree 5 without error (Abramowitz and Stegun, 25.4.30), so that both
//! x2+ = x2 + int a(t) dt and x1+ = x1 + T x2 + int (T - t) a(t) dt are exact but for rounding.

use super::magnetic_bearing::{ForceEffect, MagneticBearing, State};

/// Abscissae and weights of Gauss-Legendre quadrature with three points on \[-1, 1\]: sqrt(3/5), 5/9, 8/9.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

impl MagneticBearing {
    /// The state after `duration` \[s\] under `voltage` + `slope` t, in V and V/s: the solution of (3).
    pub fn advance_under_ramp(&self, state: State, voltage: f64, slope: f64, duration: f64) -> State {
        let flux = |time: f64| state.flux + time * (voltage + 0.5 * slope * time);
        let crossings = zeros(state.flux, voltage, 0.5 * slope, duration);
        let mut effect = ForceEffect { velocity: 0.0, position: 0.0 };
        let mut begin = 0.0;
        for end in [crossings[0], crossings[1], duration] {
            let half = 0.5 * (end - begin);
            for (abscissa, weight) in GAUSS {
                let time = begin + half * (1.0 + abscissa);
                let gain = half * weight * self.acceleration(flux(time));
                effect.velocity += gain;
                effect.position += gain * (duration - time);
            }
            begin = end;
        }
        state.after(effect, voltage + 0.5 * slope * duration, duration)
    }
}

/// Zeros of c + b t + a t^2 inside (0, `duration`) in ascending order; what is missing is `duration`.
fn zeros(c: f64, b: f64, a: f64, duration: f64) -> [f64; 2] {
    let inside = |time: f64| if time > 0.0 && time < duration { time } else { duration };
    // A negative or non-finite discriminant has no zero to offer.
    let discriminant = b * b - 4.0 * a * c;
    if !(discriminant > 0.0 && discriminant.is_finite()) {
        return [duration; 2];
    }
    // Without cancellation; b = 0 gives -+ sqrt(-c / a).
    let q = -0.5 * (b + libm::sqrt(discriminant).copysign(b));
    let (first, second) = (inside(q / a), inside(c / q));
    [first.min(second), first.max(second)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::magnetic_bearing::Map;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn without_a_slope_it_is_the_exact_map(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, epsilon in 0.0..1.0f64, duration in 1e-4..5e-3f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let start = State { position: 0.01, velocity: -0.02, flux };
            let exact = bearing.advance(Map::Exact, start, voltage, duration);
            // A slope that adds nothing but is not zero.
            let ramp = bearing.advance_under_ramp(start, voltage, 1e-12, duration);
            prop_assert!((exact.position - ramp.position).abs() < 1e-16);
            prop_assert!((exact.velocity - ramp.velocity).abs() < 1e-15);
            prop_assert!((exact.flux - ramp.flux).abs() < 1e-15);
        }

        #[test]
        fn steps_compose(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, slope in -2e5..2e5f64, epsilon in 0.0..1.0f64,
            share in 0.0..1.0f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let start = State { position: 0.01, velocity: -0.02, flux };
            let (duration, part) = (5e-3, 5e-3 * share);
            let whole = bearing.advance_under_ramp(start, voltage, slope, duration);
            let middle = bearing.advance_under_ramp(start, voltage, slope, part);
            let composed = bearing.advance_under_ramp(middle, voltage + slope * part, slope, duration - part);
            prop_assert!((whole.position - composed.position).abs() < 1e-14);
            prop_assert!((whole.velocity - composed.velocity).abs() < 1e-13);
            prop_assert!((whole.flux - composed.flux).abs() < 1e-14);
        }

        #[test]
        fn it_is_the_limit_of_short_held_steps(
            flux in -0.2..0.2f64, voltage in -150.0..150.0f64, slope in -1e5..1e5f64, epsilon in 0.0..1.0f64,
        ) {
            let bearing = MagneticBearing { epsilon };
            let mut held = State { position: 0.01, velocity: -0.02, flux };
            let ramp = bearing.advance_under_ramp(held, voltage, slope, 2e-3);
            let steps = 4000;
            let h = 2e-3 / f64::from(steps);
            for k in 0..steps {
                // The value at the middle of the step makes the flux exact and the rest right to h^2.
                let middle = voltage + slope * h * (f64::from(k) + 0.5);
                held = bearing.advance(Map::Exact, held, middle, h);
            }
            prop_assert!((ramp.flux - held.flux).abs() < 1e-12);
            prop_assert!((ramp.velocity - held.velocity).abs() < 1e-9);
            prop_assert!((ramp.position - held.position).abs() < 1e-12);
        }
    }

    #[test]
    fn two_crossings_in_one_step_are_met() {
        // x3 = (t - 1)(t - 3) = 3 - 4 t + t^2 is positive, negative and positive again; `square` is the antiderivative
        // of x3^2.
        let bearing = MagneticBearing { epsilon: 0.0 };
        let end = bearing.advance_under_ramp(State { flux: 3.0, ..State::default() }, -4.0, 2.0, 4.0);
        let square =
            |t: f64| t.powi(5) / 5.0 - 2.0 * t.powi(4) + 22.0 * t.powi(3) / 3.0 - 12.0 * t * t + 9.0 * t;
        let expected =
            (square(1.0) - square(0.0)) - (square(3.0) - square(1.0)) + (square(4.0) - square(3.0));
        assert!((end.velocity - expected).abs() < 1e-13, "{} {expected}", end.velocity);
        assert_eq!(end.flux, 3.0);
    }
}
