//! Times as fractions, as FMI 3.0 wants them for clocks.

/// The fraction with the smallest denominator whose quotient is exactly `value`, which is not negative: 1/1000 for
/// 0.001, although no double is a thousandth. None if 64 bits are too few.
///
/// Successive convergents of the continued fraction; each is the best approximation with its denominator.
pub(super) fn fraction(value: f64) -> Option<(u64, u64)> {
    let (mut numerators, mut denominators) = ([0u64, 1], [1u64, 0]);
    let mut rest = value;
    loop {
        let whole = libm::floor(rest);
        if !(0.0..9e15).contains(&whole) {
            return None;
        }
        let next = |[before, last]: [u64; 2]| (whole as u64).checked_mul(last)?.checked_add(before);
        numerators = [numerators[1], next(numerators)?];
        denominators = [denominators[1], next(denominators)?];
        if numerators[1] as f64 / denominators[1] as f64 == value {
            return Some((numerators[1], denominators[1]));
        }
        rest = 1.0 / (rest - whole);
    }
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
