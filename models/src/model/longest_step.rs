//! The longest communication step that a controller accepts.
//!
//! A controller sees its inputs held over a step and its output is held over the next one, so a loop bears steps up to
//! some multiple of its sample time only. Beyond, refusing tells the user more than a loop that is lost.

use super::ModelError;
use super::quantity::DURATION;
use super::variable::{Kind, Variable};

/// Share of the limit that an importer's arithmetic may add to a step; gaps between communication points are up to a
/// billionth of it.
const ROUNDING: f64 = 1e-8;

/// Units in the last place of a time by which a step may be off that is the difference of two times, or that makes up for
/// gaps between steps which were ignored as rounding.
const ROUNDING_OF_TIMES: f64 = 4.0;

/// Name of the row.
pub const NAME: &str = "longest_step";

/// Row of the tables of all controllers; without another start value it refuses nothing.
pub const fn longest_step() -> Variable {
    Variable::parameter(NAME, Kind::Real(&DURATION), 1e9).range(1e-6, 1e9).describe(
        "Longest communication step that is accepted, of effect in co-simulation; inputs and output are held over a \
         step; one that is too long makes the loop unstable",
    )
}

/// Refuses a step of `duration` \[s\] from `time` \[s\] on that is beyond `limit` \[s\] by more than rounding.
#[inline]
pub fn check_step(time: f64, duration: f64, limit: f64) -> Result<(), ModelError> {
    if duration <= limit * (1.0 + ROUNDING) { Ok(()) } else { check_difference(time, duration, limit) }
}

/// As [`check_step`] for a step that is perhaps the difference of two times, which are rounded by their own size.
#[cold]
fn check_difference(time: f64, duration: f64, limit: f64) -> Result<(), ModelError> {
    let rounding = ROUNDING_OF_TIMES * f64::EPSILON * (time.abs() + limit);
    if duration <= limit * (1.0 + ROUNDING) + rounding {
        Ok(())
    } else {
        Err(ModelError::BeyondLongestStep { duration, limit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use proptest::prelude::*;

    proptest! {
        /// Guards: steps that an importer computes as differences of its times.
        #[test]
        fn differences_of_times_are_steps(
            exponent in -6.0..1.0f64, start in -1e6..1e6f64, place in 0..1_000_000u32,
        ) {
            let limit = libm::pow(10.0, exponent);
            let time = start + f64::from(place) * limit;
            let end = start + (f64::from(place) + 1.0) * limit;
            prop_assert_eq!(check_step(time, end - time, limit), Ok(()));
            prop_assert_eq!(check_step(time, (time + limit) - time, limit), Ok(()));
            let duration = 1.001 * limit;
            prop_assert_eq!(check_step(time, duration, limit), Err(ModelError::BeyondLongestStep { duration, limit }));
        }
    }

    #[test]
    fn longer_steps_are_refused_with_the_limit() {
        assert_eq!(check_step(0.0, 1e-3, 1e-3), Ok(()));
        let refused = check_step(0.0, 0.01, 1e-3).unwrap_err();
        assert_eq!(refused.to_string(), "a step of 0.01 s: expected at most longest_step = 0.001 s");
        let refused = check_step(0.0, 1.0000001e-3, 1e-3).unwrap_err();
        assert_eq!(refused.to_string(), "a step of 0.0010000001 s: expected at most longest_step = 0.001 s");
    }
}
