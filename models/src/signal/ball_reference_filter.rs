//! Reference of the levitated ball: (24), (25) of its paper smooth a reference "filtered" by an unprinted filter. Here it is
//! y* = (w / (p + w))^3 r, the lowest order whose derivatives up to the third, which the law needs, are known.

use serde::{Deserialize, Serialize};

/// Reference position and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmoothReference {
    /// y* \[m\]
    pub position: f64,
    /// \[m/s\]
    pub velocity: f64,
    /// \[m/s2\]
    pub acceleration: f64,
    /// \[m/s3\]
    pub jerk: f64,
}

/// Three equal low-passes in a chain, exact for a reference that is a straight line between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallReferenceFilter {
    /// Outputs of the three low-passes \[m\].
    stages: [f64; 3],
    /// r at the last sample \[m\].
    input: f64,
    /// q = w T and e^-q of the last update, which the next one most likely needs again.
    exponent: f64,
    decay: f64,
}

impl BallReferenceFilter {
    /// A filter at rest at `position` \[m\].
    pub fn new(position: f64) -> Self {
        Self { stages: [position; 3], input: position, exponent: 0.0, decay: 1.0 }
    }

    /// Whether its parts belong together; false for bytes that no filter ever wrote.
    pub fn is_consistent(&self) -> bool {
        self.decay == libm::exp(-self.exponent)
    }

    /// Takes the present sample of r \[m\] without letting time pass: what a jump at the start is.
    pub fn present(&mut self, input: f64) {
        self.input = input;
    }

    /// Goes on to the next sample `input` = r \[m\], with w = `rate` \[1/s\].
    ///
    /// For r = r0 + s t a chain that has settled lags by s/w per stage; what is left of each stage decays as
    /// (1, w t, (w t)^2 / 2) e^-wt, handed down the chain.
    #[inline]
    pub fn update(&mut self, input: f64, rate: f64, sample_time: f64) {
        let q = rate * sample_time;
        let lag = (input - self.input) / q;
        if q != self.exponent {
            (self.exponent, self.decay) = (q, libm::exp(-q));
        }
        let decay = self.decay;
        let past = self.input;
        let [first, second, third] = self.stages;
        let (first, second, third) =
            (first - past + lag, second - past + 2.0 * lag, third - past + 3.0 * lag);
        self.stages = [
            input - lag + decay * first,
            input - 2.0 * lag + decay * (second + q * first),
            input - 3.0 * lag + decay * (third + q * second + 0.5 * q * q * first),
        ];
        self.input = input;
    }

    /// y* and its derivatives at the last sample.
    #[inline]
    pub fn output(&self, rate: f64) -> SmoothReference {
        let [first, second, third] = self.stages;
        SmoothReference {
            position: third,
            velocity: rate * (second - third),
            acceleration: rate * rate * (first - 2.0 * second + third),
            jerk: rate * rate * rate * (self.input - 3.0 * (first - second) - third),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 80.0;

    #[test]
    fn step_response_is_that_of_a_triple_pole() {
        let mut filter = BallReferenceFilter::new(0.0);
        filter.present(1.0);
        for sample in 1..=200 {
            filter.update(1.0, RATE, 1e-3);
            let q = RATE * 1e-3 * f64::from(sample);
            let (decay, output) = (f64::exp(-q), filter.output(RATE));
            assert!((output.position - (1.0 - decay * (1.0 + q + q * q / 2.0))).abs() < 1e-14);
            assert!((output.velocity / RATE - decay * q * q / 2.0).abs() < 1e-13);
            assert!((output.acceleration / RATE.powi(2) - decay * (q - q * q / 2.0)).abs() < 1e-13);
            assert!((output.jerk / RATE.powi(3) - decay * (1.0 - 2.0 * q + q * q / 2.0)).abs() < 1e-13);
        }
    }

    #[test]
    fn another_rate_counts_from_the_next_sample() {
        let mut changing = BallReferenceFilter::new(0.0);
        for rate in [RATE, RATE, 3.0 * RATE, RATE] {
            let mut fresh = BallReferenceFilter::new(0.0);
            (fresh.stages, fresh.input) = (changing.stages, changing.input);
            changing.update(1.0, rate, 1e-3);
            fresh.update(1.0, rate, 1e-3);
            assert_eq!(changing, fresh);
            assert!(changing.is_consistent());
        }
    }

    #[test]
    fn ramp_is_followed_with_the_lag_of_three_stages() {
        let mut filter = BallReferenceFilter::new(0.0);
        for sample in 1..=1000 {
            filter.update(2e-3 * f64::from(sample), RATE, 1e-3);
        }
        let output = filter.output(RATE);
        assert!((output.position - (2.0 - 3.0 * 2.0 / RATE)).abs() < 1e-13);
        assert!((output.velocity - 2.0).abs() < 1e-11);
        assert!(output.acceleration.abs() < 1e-9 && output.jerk.abs() < 1e-6);
    }
}
