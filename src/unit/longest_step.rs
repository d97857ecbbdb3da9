//! The longest communication step that a controller accepts.
//!
//! A controller sees its inputs held over a step and its output is held over the next one, so a loop bears steps up to
//! some multiple of its sample time only. Beyond, refusing tells the user more than a loop that is lost.

use super::UnitError;
use super::quantity::DURATION;
use super::variable::{Kind, Variable};

/// Share of the limit that rounding may add to a step.
const ROUNDING: f64 = 1e-9;

/// Row of the tables of all controllers; without another start value it refuses nothing.
pub const fn longest_step() -> Variable {
    Variable::parameter("longest_step", Kind::Real(&DURATION), 1e9).range(1e-6, 1e9).describe(
        "Longest communication step that is accepted, of effect in co-simulation; inputs and output are held over a \
         step, which loses a loop if it is too long",
    )
}

/// Refuses a step of `duration` \[s\] beyond `limit` \[s\].
#[inline]
pub fn check_step(duration: f64, limit: f64) -> Result<(), UnitError> {
    if duration <= limit * (1.0 + ROUNDING) {
        Ok(())
    } else {
        Err(UnitError::BeyondLongestStep { duration, limit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_steps_are_refused_with_the_limit() {
        assert_eq!(check_step(1e-3, 1e-3), Ok(()));
        assert_eq!(check_step(1e-3 + 1e-15, 1e-3), Ok(()), "rounded");
        let refused = check_step(0.01, 1e-3).unwrap_err();
        assert_eq!(refused.to_string(), "a step of 0.01 s: expected at most longest_step = 0.001 s");
    }
}
