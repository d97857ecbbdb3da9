//! How much a step may compute: about a second, known before it begins.
//!
//! Each model knows what a second of its own time costs with its present parameters, as the number of integration
//! steps, ticks or readings in it times what one of them was measured to take in a release build on one core of an
//! ordinary machine. A longer step is refused with the longest that would be accepted; the importer then makes several,
//! between which it can be stopped.

use super::ModelError;

/// Computing in one step, by the models' own account \[s\].
pub const LARGEST_WORK: f64 = 1.0;

/// Share by which a step may be longer than the limit that is named: importers compute steps as differences of times,
/// which are rounded by their own size, and the cost is not known any better.
const ROUNDING: f64 = 0.01;

/// Work that comes again and again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Computing each time \[s\].
    pub cost: f64,
    /// The model's own time from one time to the next \[s\].
    pub interval: f64,
}

impl Load {
    pub const NONE: Self = Self { cost: 0.0, interval: 1.0 };
}

/// Refuses a step over `duration` \[s\] of a model with this work, if that would take too long.
#[inline]
pub fn require_affordable<const N: usize>(duration: f64, loads: [Load; N]) -> Result<(), ModelError> {
    // Far from the limit without a division.
    let share = 0.5 * LARGEST_WORK / N as f64;
    if loads.iter().all(|load| duration * load.cost < share * load.interval) {
        return Ok(());
    }
    require_affordable_in_total(duration, loads.iter().map(|load| load.cost / load.interval).sum())
}

/// As [`require_affordable`] for a model that computes `load` seconds per second of its own time.
#[cold]
fn require_affordable_in_total(duration: f64, load: f64) -> Result<(), ModelError> {
    let limit = rounded_down(LARGEST_WORK / load);
    if duration <= limit * (1.0 + ROUNDING) {
        Ok(())
    } else {
        Err(ModelError::StepTooLong { duration, limit })
    }
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
        fn the_limit_that_is_named_is_accepted_and_short(
            cost in -12.0..3.0f64, interval in -6.0..9.0f64, beyond in 0.011..1e9f64, other in 0.0..2.0f64,
            periods in 0.0..1e6f64,
        ) {
            let load = Load { cost: libm::pow(10.0, cost), interval: libm::pow(10.0, interval) };
            let loads = [load, Load { cost: other * load.cost, ..load }];
            let named = require_affordable(1e300, loads).unwrap_err();
            let ModelError::StepTooLong { limit, .. } = named else { unreachable!() };
            let work = limit * load.cost / load.interval * (1.0 + other);
            prop_assert!(work <= 1.0 + 1e-9 && work > 0.9, "{} {}", limit, work);
            prop_assert_eq!(require_affordable(limit, loads), Ok(()));
            // Guards: a step that an importer computes as the difference of its times.
            let (time, end) = (periods * limit, (periods + 1.0) * limit);
            prop_assert_eq!(require_affordable(end - time, loads), Ok(()));
            let duration = limit * (1.0 + beyond);
            prop_assert_eq!(require_affordable(duration, loads), Err(ModelError::StepTooLong { duration, limit }));
            prop_assert!(format!("{limit:e}").len() <= "1.2e-15".len(), "{:e}", limit);
        }
    }

    #[test]
    fn what_costs_nothing_is_never_refused() {
        assert_eq!(require_affordable(1e300, [Load::NONE; 2]), Ok(()));
    }
}
