//! Numbers that sum up a signal.

use std::borrow::Borrow;

/// Largest of values from 0 on, 0 if there is none.
pub fn largest(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    values.into_iter().fold(0.0, |largest, value| largest.max(*value.borrow()))
}

/// Infinite if there is none.
pub fn smallest(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    values.into_iter().fold(f64::INFINITY, |smallest, value| smallest.min(*value.borrow()))
}

/// Largest magnitude.
pub fn peak(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    largest(values.into_iter().map(|value| value.borrow().abs()))
}

/// sqrt(mean x^2), not a number if there is none.
pub fn root_mean_square(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0.0), |(sum, count), value| {
        let value = value.borrow();
        (sum + value * value, count + 1.0)
    });
    f64::sqrt(sum / count)
}

/// Not a number if there is none.
pub fn median(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().map(|value| *value.borrow()).collect();
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        count => 0.5 * (values[(count - 1) / 2] + values[count / 2]),
    }
}

/// Time \[s\] from which on a signal stays within `limit` to its end; infinite if it does not.
pub fn settling_time(time: &[f64], values: &[f64], limit: f64) -> f64 {
    match values.iter().rposition(|value| value.is_nan() || value.abs() > limit) {
        None => 0.0,
        Some(last) => time.get(last + 1).copied().unwrap_or(f64::INFINITY),
    }
}

/// Whether each value is smaller than the one before.
pub fn falls(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[1] < pair[0])
}

/// Whether each value is larger than the one before.
pub fn rises(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[1] > pair[0])
}

/// `first - second`, sample by sample.
pub fn difference(first: &[f64], second: &[f64]) -> Vec<f64> {
    first.iter().zip(second).map(|(first, second)| first - second).collect()
}

/// 1 if it is so, 0 if not.
pub fn indicator(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settling_is_for_good() {
        let time = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(settling_time(&time, &[1.0, 0.0, 1.0, 0.0], 0.5), 3.0);
        assert_eq!(settling_time(&time, &[0.0; 4], 0.5), 0.0);
        assert_eq!(settling_time(&time, &[0.0, 0.0, 0.0, 1.0], 0.5), f64::INFINITY);
        assert_eq!(settling_time(&time, &[0.0, f64::NAN, 0.0, 0.0], 0.5), 2.0);
    }

    #[test]
    fn sums_are_those_of_the_textbook() {
        assert_eq!(root_mean_square([3.0, -4.0, 0.0, 0.0]), 2.5);
        assert!(root_mean_square(&[] as &[f64]).is_nan());
        assert_eq!((peak([3.0, -4.0]), largest([3.0, -4.0]), smallest([3.0, -4.0])), (4.0, 3.0, -4.0));
        assert_eq!((median([3.0, 1.0, 2.0]), median([1.0, f64::INFINITY])), (2.0, f64::INFINITY));
        assert!(falls(&[3.0, 2.0]) && !falls(&[2.0, 2.0]) && rises(&[1.0, 2.0]));
    }
}
