//! First-order relaxation solved exactly for inputs that are straight lines between samples (ramp-invariant).

use serde::{Deserialize, Serialize};

/// One sample of x' = -a x + g with a straight g: x(T) = `decay` x(0) + `past` g(0) + `present` g(T).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FirstOrderHold {
    decay: f64,
    past: f64,
    present: f64,
}

impl FirstOrderHold {
    /// x' = -`rate` x + g over `duration`, with `rate` in 1/s at least 0.
    ///
    /// With q = a T and m = (1 - e^-q) / q the weights are past = T (m - e^-q) / q and present = T P, P = (1 - m) / q;
    /// in terms of P, which has a series, e^-q = 1 - q + q^2 P and past = T (1 - P - q P).
    #[inline]
    pub fn relaxation(rate: f64, duration: f64) -> Self {
        let q = rate * duration;
        let (decay, past, present) = if q.abs() < SERIES_BELOW {
            let present = series(q);
            (1.0 - q + q * q * present, 1.0 - present - q * present, present)
        } else {
            let decay = libm::exp(-q);
            let mean = (1.0 - decay) / q;
            (decay, (mean - decay) / q, (1.0 - mean) / q)
        };
        Self { decay, past: duration * past, present: duration * present }
    }

    /// Low-pass a / (p + a): x' = a (g - x).
    pub fn low_pass(rate: f64, duration: f64) -> Self {
        let Self { decay, past, present } = Self::relaxation(rate, duration);
        Self { decay, past: rate * past, present: rate * present }
    }

    /// The same low-pass by forward Euler, for comparison: the levitated ball is lost with it.
    pub fn low_pass_by_euler(rate: f64, duration: f64) -> Self {
        Self { decay: 1.0 - rate * duration, past: rate * duration, present: 0.0 }
    }

    /// x at the end of the sample.
    #[inline(always)]
    pub fn after(&self, state: f64, past_input: f64, present_input: f64) -> f64 {
        self.decay * state + self.past * past_input + self.present * present_input
    }
}

/// Below this the closed form of P loses digits to cancellation, and the series is cheaper than an exponential.
const SERIES_BELOW: f64 = 0.03;

/// P = 1/2 - q/6 + q^2/24 - ... up to q^6 / 8!; the rest is below 1e-16.
#[inline(always)]
fn series(q: f64) -> f64 {
    let tail = 1.0 / 120.0 - q * (1.0 / 720.0 - q * (1.0 / 5040.0 - q * (1.0 / 40320.0)));
    0.5 - q * (1.0 / 6.0 - q * (1.0 / 24.0 - q * tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ramps_are_exact(
            rate in 1e-3..2e3f64, duration in 1e-5..1e-1f64, start in -1.0..1.0f64, offset in -1.0..1.0f64,
            slope in -50.0..50.0f64,
        ) {
            // x' = a (r - x), r = r0 + s t: x = r - s/a + (x0 - r0 + s/a) e^-at.
            let lag = slope / rate;
            let end = offset + slope * duration;
            let expected = end - lag + (start - offset + lag) * f64::exp(-rate * duration);
            let found = FirstOrderHold::low_pass(rate, duration).after(start, offset, end);
            prop_assert!((found - expected).abs() < 1e-14 * (2.0 + lag.abs()), "{found} {expected}");
        }
    }

    #[test]
    fn weights_join_where_the_series_takes_over() {
        let below = FirstOrderHold::relaxation(SERIES_BELOW * (1.0 - 1e-15), 1.0);
        let above = FirstOrderHold::relaxation(SERIES_BELOW, 1.0);
        for (a, b) in [(below.decay, above.decay), (below.past, above.past), (below.present, above.present)] {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn without_relaxation_it_is_the_trapezoidal_rule() {
        assert_eq!(FirstOrderHold::relaxation(0.0, 2.0).after(3.0, 5.0, 7.0), 15.0);
    }

    #[test]
    fn a_constant_passes_a_low_pass() {
        for duration in [1e-6, 1e-4, 1e-2, 10.0] {
            let held = FirstOrderHold::low_pass(100.0, duration).after(0.7, 0.7, 0.7);
            assert!((held - 0.7).abs() < 4e-16, "{held}");
        }
    }
}
