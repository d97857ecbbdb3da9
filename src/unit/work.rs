//! How much a step may compute: about a second, known before it begins.
//!
//! Each unit knows what a second of its own time costs with its present parameters, as the number of integration
//! steps, ticks or readings in it times what one of them was measured to take in a release build on one core of an
//! ordinary machine. A longer step is refused with the longest that would be accepted; the importer then makes several,
//! between which it can be stopped.

use super::UnitError;

/// Computing in one step, by the units' own account \[s\].
pub const LARGEST_WORK: f64 = 1.0;

/// Refuses a step over `duration` \[s\] of a unit that computes `load` seconds per second of its own time, if that would
/// take too long.
#[inline]
pub fn require_affordable(duration: f64, load: f64) -> Result<(), UnitError> {
    // Far from the limit without a division.
    if duration * load < 0.5 * LARGEST_WORK {
        return Ok(());
    }
    let limit = rounded_down(LARGEST_WORK / load);
    if duration <= limit { Ok(()) } else { Err(UnitError::StepTooLong { duration, limit }) }
}

/// The largest number of two digits that is not larger than `value`: one that people can take over.
fn rounded_down(value: f64) -> f64 {
    let exponent = libm::floor(libm::log10(value)) - 1.0;
    let power = libm::pow(10.0, exponent.abs());
    let digits = |value: f64| libm::floor(value * (1.0 + 1e-12));
    if exponent < 0.0 { digits(value * power) / power } else { digits(value / power) * power }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_limit_that_is_named_is_accepted_and_short(load in -15.0..15.0f64, beyond in 1e-9..1e9f64) {
            let load = libm::pow(10.0, load);
            let named = require_affordable(1e300, load).unwrap_err();
            let UnitError::StepTooLong { limit, .. } = named else { unreachable!() };
            prop_assert!(limit * load <= 1.0 + 1e-9 && limit * load > 0.9, "{} {}", limit, load);
            prop_assert_eq!(require_affordable(limit, load), Ok(()));
            let duration = limit * (1.0 + beyond);
            prop_assert_eq!(require_affordable(duration, load), Err(UnitError::StepTooLong { duration, limit }));
            prop_assert!(format!("{limit:e}").len() <= "1.2e-15".len(), "{:e}", limit);
        }
    }
}
