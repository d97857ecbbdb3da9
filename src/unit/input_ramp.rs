//! Inputs that move along a straight line during a step.

use super::UnitError;
use super::variable::Variable;

/// Value at the end of a step over `duration` \[s\] of an input that begins with `value` and moves with `slope`; refused
/// if it leaves the range that its table gives it, since nobody could set it there.
#[inline]
pub(super) fn end_of_ramp(input: &Variable, value: f64, slope: f64, duration: f64) -> Result<f64, UnitError> {
    let end = value + slope * duration;
    if slope != 0.0 {
        input.check(end).map_err(UnitError::InputLeavesRange)?;
    }
    Ok(end)
}
