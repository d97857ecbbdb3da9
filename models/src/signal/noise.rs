//! Reproducible white Gaussian noise.

use rand_core::Rng;
use rand_pcg::Pcg32;
use serde::{Deserialize, Serialize};

/// Sequence of independent standard normal numbers, the same on every platform for the same seed and stream.
///
/// PCG-XSH-RR 64/32 (O'Neill 2014) through the crate `rand_pcg`, turned normal by Box and Muller (1958) with `libm`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaussianNoise {
    generator: Pcg32,
}

impl GaussianNoise {
    /// Different streams of one seed are independent.
    pub fn new(seed: u64, stream: u64) -> Self {
        Self { generator: Pcg32::new(seed, stream) }
    }

    /// Next number, mean 0, standard deviation 1.
    pub fn sample(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(self.uniform()));
        radius * libm::cos(core::f64::consts::TAU * self.uniform())
    }

    /// Uniform in (0, 1): the middle of one of 2^52 cells, so that the logarithm stays finite.
    fn uniform(&mut self) -> f64 {
        const CELLS: f64 = (1u64 << 52) as f64;
        ((self.generator.next_u64() >> 12) as f64 + 0.5) / CELLS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_independence() {
        let count = 200_000;
        let mut noise = GaussianNoise::new(1, 0);
        let samples: Vec<f64> = (0..count).map(|_| noise.sample()).collect();
        let moment = |power: i32| samples.iter().map(|x| x.powi(power)).sum::<f64>() / f64::from(count);
        // Five standard errors of each moment: sqrt(var / n).
        let tolerance = |variance: f64| 5.0 * (variance / f64::from(count)).sqrt();
        assert!(moment(1).abs() < tolerance(1.0));
        assert!((moment(2) - 1.0).abs() < tolerance(2.0));
        assert!(moment(3).abs() < tolerance(15.0));
        assert!((moment(4) - 3.0).abs() < tolerance(96.0));
        let lagged = samples.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / f64::from(count);
        assert!(lagged.abs() < tolerance(1.0));
    }

    #[test]
    fn seeds_and_streams_differ_and_repeat() {
        let first = |seed, stream| GaussianNoise::new(seed, stream).sample();
        assert_eq!(first(1, 0), first(1, 0));
        assert_ne!(first(1, 0), first(2, 0));
        assert_ne!(first(1, 0), first(1, 1));
    }
}
