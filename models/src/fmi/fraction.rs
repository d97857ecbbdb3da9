//! Times as fractions, as FMI 3.0 wants them for clocks.

use core::fmt::{self, Write};

/// The first convergent of the continued fraction of `value` whose quotient is exactly `value`, which is not negative:
/// 1/1000 for 0.001, although no double is a thousandth; for a decimal number of many digits a shorter fraction that is
/// the same double. None if 64 bits are too few.
///
/// Euclid's algorithm on the double itself, a whole number over a power of two.
pub(super) fn fraction(value: f64) -> Option<(u64, u64)> {
    /// Digits of a double's fraction in 1, and of the power of two that fits beside it.
    const DIGITS: i32 = 52;
    const LARGEST_POWER: i32 = 126;
    if value == 0.0 {
        return Some((0, 1));
    }
    if !value.is_finite() || value < 0.0 {
        return None;
    }
    let (mantissa, exponent) = libm::frexp(value);
    let power = DIGITS + 1 - exponent;
    if !(0..=LARGEST_POWER).contains(&power) {
        return None;
    }
    let mut dividend = libm::ldexp(mantissa, DIGITS + 1) as u128;
    let mut divisor = 1u128 << power;
    let (mut numerators, mut denominators) = ([0u64, 1], [1u64, 0]);
    while divisor != 0 {
        let whole = u64::try_from(dividend / divisor).ok()?;
        let next = |[before, last]: [u64; 2]| whole.checked_mul(last)?.checked_add(before);
        numerators = [numerators[1], next(numerators)?];
        denominators = [denominators[1], next(denominators)?];
        if numerators[1] as f64 / denominators[1] as f64 == value {
            return Some((numerators[1], denominators[1]));
        }
        (dividend, divisor) = (divisor, dividend % divisor);
    }
    None
}

/// The decimal number of at most 15 digits whose double is exactly `value`, which is not negative, as a fraction in lowest
/// terms: what somebody has typed, if it was that. None if there is no such number, or if 64 bits are too few.
fn decimal_fraction(value: f64) -> Option<(u64, u64)> {
    const DIGITS: usize = 15;
    let mut text = ShortText::default();
    // The fewest digits that tell the double from all others.
    write!(text, "{value:e}").ok()?;
    let (digits, exponent) = text.as_str()?.split_once('e')?;
    let (whole, decimals) = digits.split_once('.').unwrap_or((digits, ""));
    if whole.len() + decimals.len() > DIGITS {
        return None;
    }
    let exponent = exponent.parse::<i32>().ok()? - decimals.len() as i32;
    let power = 10u64.checked_pow(exponent.unsigned_abs())?;
    let decimals_value = if decimals.is_empty() { 0 } else { decimals.parse::<u64>().ok()? };
    let counter = whole.parse::<u64>().ok()? * 10u64.pow(decimals.len() as u32) + decimals_value;
    if exponent >= 0 {
        return Some((counter.checked_mul(power)?, 1));
    }
    let divisor = greatest_common_divisor(counter.into(), power.into()) as u64;
    Some((counter / divisor, power / divisor))
}

/// A double in decimals, without the heap.
#[derive(Default)]
struct ShortText {
    bytes: [u8; 32],
    length: usize,
}

impl ShortText {
    fn as_str(&self) -> Option<&str> {
        core::str::from_utf8(&self.bytes[..self.length]).ok()
    }
}

impl fmt::Write for ShortText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length + text.len();
        self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

/// Time from `start` to `number * period`, all in s, as a fraction of whole numbers in lowest terms: exact for the decimal
/// numbers that `start` and `period` stand for, 0 if it is negative. None if 64 bits are too few.
pub(super) fn time_from(start: f64, number: i64, period: f64) -> Option<(u64, u64)> {
    let exactly = |value| decimal_fraction(value).or_else(|| fraction(value));
    // Less than what a multiple of the period is rounded by.
    let start = if start.abs() < f64::EPSILON * period { 0.0 } else { start };
    let (period_counter, period_resolution) = exactly(period)?;
    let (start_counter, start_resolution) = exactly(start.abs())?;
    let signed = |counter: u64| i128::from(counter) * if start < 0.0 { -1 } else { 1 };
    let tick = i128::from(number).checked_mul(period_counter.into())?.checked_mul(start_resolution.into())?;
    let start = signed(start_counter).checked_mul(period_resolution.into())?;
    let counter = tick.checked_sub(start)?.max(0).unsigned_abs();
    let resolution = u128::from(period_resolution) * u128::from(start_resolution);
    let divisor = greatest_common_divisor(counter, resolution);
    Some((u64::try_from(counter / divisor).ok()?, u64::try_from(resolution / divisor).ok()?))
}

/// As [`time_from`], of a time that is about `shift` \[s\]: where 64 bits are too few for the numbers that `start` and `period`
/// stand for, a fraction whose quotient is `shift`; 0 for one that is smaller than any fraction.
pub(super) fn shift_from(start: f64, number: i64, period: f64, shift: f64) -> (u64, u64) {
    time_from(start, number, period).or_else(|| fraction(shift)).unwrap_or((0, 1))
}

/// Of two numbers of which the second is not 0.
fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while a != 0 {
        (a, b) = (b % a, a);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::{fraction, shift_from, time_from};
    use proptest::prelude::*;

    #[test]
    fn decimal_and_other_fractions() {
        for (value, expected) in [
            (1e-3, (1, 1000)),
            (1e-4, (1, 10_000)),
            (2.5e-4, (1, 4000)),
            (1.0 / 60.0, (1, 60)),
            (0.0, (0, 1)),
            (3.0, (3, 1)),
            (0.3, (3, 10)),
            (1e-6, (1, 1_000_000)),
        ] {
            assert_eq!(fraction(value), Some(expected), "{value}");
        }
        assert_eq!(fraction(f64::NAN), None);
        assert_eq!(fraction(-1.0), None);
        assert_eq!(fraction(5e-324), None);
    }

    #[test]
    fn times_between_decimal_numbers_are_exact() {
        for (start, number, period, expected) in [
            (0.00025, 3, 1e-4, (1, 20_000)),
            (0.0025, 3, 1e-3, (1, 2000)),
            (0.0025, 9, 0.3e-3, (1, 5000)),
            (-0.00025, -2, 1e-4, (1, 20_000)),
            (0.0, 0, 1e-3, (0, 1)),
            (2e-3, 2, 1e-3, (0, 1)),
            (0.001_000_000_01, 1, 1e-3, (0, 1)),
            (123_456.789_123_4, 123_456_790, 1e-3, (4383, 5_000_000)),
            (0.123_456_789_1, 123_457, 1e-6, (2109, 10_000_000_000)),
            (1e-300, 0, 1e-3, (0, 1)),
            (-5e-324, 1, 1e-3, (1, 1000)),
            (100.0, 100_001, 1e-3, (1, 1000)),
            // No decimal number of few digits.
            (0.0, 1, 1.0 / 60.0, (1, 60)),
            (0.0, 7, 1.0 / 3.0, (7, 3)),
        ] {
            assert_eq!(time_from(start, number, period), Some(expected), "{start} {number} {period}");
        }
        assert_eq!(time_from(f64::MAX, i64::MAX, 1e-4), None);
    }

    /// Guards: an error for a start time that an importer has added up.
    #[test]
    fn a_shift_of_any_doubles_has_a_fraction() {
        let (start, period) = (0.1 + 0.2, 7e-4);
        let shift = 429.0 * period - start;
        assert_eq!(time_from(start, 429, period), None);
        let (counter, resolution) = shift_from(start, 429, period, shift);
        assert_eq!(counter as f64 / resolution as f64, shift);
        assert_eq!(shift_from(1e-6 * (1.0 - f64::EPSILON), 1, 1e-6, 1e-22), (0, 1));
    }

    proptest! {
        #[test]
        fn every_shift_has_one(start in -1e3..1e3f64, period in 1e-6..1.0f64) {
            let number = (start / period).ceil() as i64;
            let shift = (number as f64 * period - start).max(0.0);
            let (counter, resolution) = shift_from(start, number, period, shift);
            let rounding = 4.0 * f64::EPSILON * (start.abs() + period);
            prop_assert!((counter as f64 / resolution as f64 - shift).abs() <= rounding);
        }

        #[test]
        fn times_are_those_of_the_doubles(start in 0.0..1e3f64, steps in 0i64..10_000, period in 1e-6..10.0f64) {
            let number = (start / period) as i64 + 1 + steps;
            if let Some((counter, resolution)) = time_from(start, number, period) {
                let expected = number as f64 * period - start;
                let rounding = 4.0 * f64::EPSILON * (number as f64 * period + start);
                prop_assert!((counter as f64 / resolution as f64 - expected).abs() <= rounding);
            }
        }

        #[test]
        fn decimal_numbers_are_themselves(counter in 1u64..1_000_000_000_000_000, decimals in 0u32..15) {
            let value: f64 = format!("{counter}e-{decimals}").parse().unwrap();
            let (found, resolution) = super::decimal_fraction(value).unwrap();
            prop_assert_eq!(
                u128::from(found) * 10u128.pow(decimals),
                u128::from(counter) * u128::from(resolution)
            );
        }

        #[test]
        fn every_sample_time_has_one(value in 1e-6..10.0f64) {
            let (counter, resolution) = fraction(value).unwrap();
            prop_assert_eq!(counter as f64 / resolution as f64, value);
        }
    }
}
