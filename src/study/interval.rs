//! How far a number that sums up a sample may be from that of all there could be.

use rand_core::Rng;
use rand_pcg::Pcg32;
use rayon::prelude::*;

/// Probability with which an interval is meant to hold the true number.
pub const LEVEL: f64 = 0.95;

/// Samples that are drawn anew.
const RESAMPLES: u64 = 1000;

/// A range of values; an end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

/// Percentile bootstrap (B. Efron, "Bootstrap methods: another look at the jackknife", 1979) of `statistic` at
/// [`LEVEL`]: values are drawn from `values` with replacement, as many as there are, and the interval is what is left of
/// the statistics of such samples without the outer ones on either side. The same draws for samples of the same size,
/// on any number of threads. Not numbers if there is no value.
pub fn bootstrap(values: &[f64], statistic: impl Fn(&[f64]) -> f64 + Sync) -> Interval {
    if values.is_empty() {
        return Interval { low: f64::NAN, high: f64::NAN };
    }
    let mut statistics: Vec<f64> = (0..RESAMPLES)
        .into_par_iter()
        .map(|resample| {
            let mut generator = Pcg32::new(resample, 1979);
            let sample: Vec<f64> =
                values.iter().map(|_| values[below(&mut generator, values.len())]).collect();
            statistic(&sample)
        })
        .collect();
    statistics.sort_by(f64::total_cmp);
    let rank = |share: f64| (share * (statistics.len() - 1) as f64).round() as usize;
    let outside = 0.5 * (1.0 - LEVEL);
    Interval { low: statistics[rank(outside)], high: statistics[rank(1.0 - outside)] }
}

/// A number from 0 on and below `bound`; its bias of `bound` / 2^32 does not matter to a sample of some thousands.
fn below(generator: &mut Pcg32, bound: usize) -> usize {
    ((u64::from(generator.next_u32()) * bound as u64) >> 32) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::metrics::median;

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Of means of many samples of a uniform distribution some 95 % have the true mean in their interval; by the normal
    /// distribution a share outside of 90 to 98.5 % has less than 1 chance in 10 000.
    #[test]
    fn holds_the_true_mean_as_often_as_promised() {
        let samples = 400;
        let held = (0..samples).filter(|sample| {
            let mut generator = Pcg32::new(*sample, 7);
            let values: Vec<f64> =
                (0..100).map(|_| f64::from(generator.next_u32()) / 2f64.powi(32)).collect();
            let Interval { low, high } = bootstrap(&values, mean);
            low <= 0.5 && 0.5 <= high
        });
        let share = held.count() as f64 / samples as f64;
        assert!((0.90..=0.985).contains(&share), "{share}");
    }

    /// Width of the interval of a mean: 2 * 1.96 * sigma / sqrt(n).
    #[test]
    fn is_as_wide_as_the_normal_distribution_says() {
        let values: Vec<f64> = (0..900).map(|index| f64::from(index % 2)).collect();
        let Interval { low, high } = bootstrap(&values, mean);
        let expected = 2.0 * 1.96 * 0.5 / 30.0;
        assert!(((high - low) / expected - 1.0).abs() < 0.1, "{low} to {high}, expected width {expected}");
    }

    /// Lost runs count as infinite: a median is not known from above if nearly half of all are lost.
    #[test]
    fn ends_may_be_infinite() {
        let mut values = vec![1.0; 52];
        values.extend([f64::INFINITY; 48]);
        assert_eq!(bootstrap(&values, |sample| median(sample)), Interval { low: 1.0, high: f64::INFINITY });
        assert_eq!(bootstrap(&[2.0; 5], |sample| median(sample)), Interval { low: 2.0, high: 2.0 });
        assert!(bootstrap(&[], mean).low.is_nan());
    }
}
