//! Times as fractions, as FMI 3.0 wants them for clocks.

/// The first convergent of the continued fraction of `value` whose quotient is exactly `value`, which is not negative:
/// 1/1000 for 0.001, although no double is a thousandth. None if 64 bits are too few.
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

#[cfg(test)]
mod tests {
    use super::fraction;
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

    proptest! {
        #[test]
        fn every_sample_time_has_one(value in 1e-6..10.0f64) {
            let (counter, resolution) = fraction(value).unwrap();
            prop_assert_eq!(counter as f64 / resolution as f64, value);
        }
    }
}
