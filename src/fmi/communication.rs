//! Communication points: whether a step follows the one before, and how much time really passes.

use super::CallError;
use serde::{Deserialize, Serialize};

/// Rounding that importers accumulate between two communication points, in units in the last place.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Share of a step by which the next communication point may miss the end of the last step.
const TOLERANCE: f64 = 1e-3;

/// The point the simulation has reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommunicationPoint {
    /// \[s\]
    now: f64,
}

impl CommunicationPoint {
    pub fn new(start_time: f64) -> Self {
        Self { now: start_time }
    }

    /// Time reached \[s\].
    pub fn now(&self) -> f64 {
        self.now
    }

    /// Time \[s\] that passes in a step from `point` over `step_size`, both in s.
    ///
    /// A difference between `point` and the end of the last step is taken for rounding and ignored up to a few
    /// units in the last place, passes in addition up to a thousandth of the step, and is an error beyond.
    pub fn duration(&self, point: f64, step_size: f64) -> Result<f64, CallError> {
        if !(step_size.is_finite() && step_size > 0.0) {
            let expected = "a finite step greater than 0 s";
            return Err(CallError::WrongTime {
                argument: "communicationStepSize",
                value: step_size,
                expected,
            });
        }
        if !point.is_finite() {
            let expected = "a finite time";
            return Err(CallError::WrongTime {
                argument: "currentCommunicationPoint",
                value: point,
                expected,
            });
        }
        if !(point + step_size).is_finite() {
            let expected = "a step that ends at a finite time";
            return Err(CallError::WrongTime {
                argument: "communicationStepSize",
                value: step_size,
                expected,
            });
        }
        let gap = point - self.now;
        if gap.abs() <= ROUNDING * point.abs().max(self.now.abs()).max(step_size) {
            Ok(step_size)
        } else if gap.abs() <= TOLERANCE * step_size {
            Ok(step_size + gap)
        } else {
            Err(CallError::TimeDoesNotFollow { got: point, expected: self.now })
        }
    }

    /// The step from `point` over `step_size` is done.
    pub fn advance(&mut self, point: f64, step_size: f64) {
        self.now = point + step_size;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_ignored_and_small_gaps_pass() {
        let mut point = CommunicationPoint::new(0.0);
        assert_eq!(point.duration(0.0, 0.1), Ok(0.1));
        point.advance(0.0, 0.1);
        assert_eq!(point.duration(0.100_000_000_000_000_03, 0.1), Ok(0.1));
        assert_eq!(point.duration(0.100_01, 0.1), Ok(0.100_01));
        assert_eq!(point.now(), 0.1);
    }

    #[test]
    fn times_that_make_no_sense_are_named() {
        let point = CommunicationPoint::new(1.0);
        let message = |t, h| point.duration(t, h).unwrap_err().to_string();
        assert_eq!(
            message(0.9, 0.1),
            "currentCommunicationPoint = 0.9 s does not follow the last one: expected 1 s"
        );
        assert_eq!(
            message(1.0, -0.5),
            "communicationStepSize = -0.5 s: expected a finite step greater than 0 s"
        );
        for step_size in [0.0, f64::NAN, f64::INFINITY] {
            assert!(message(1.0, step_size).starts_with("communicationStepSize"));
        }
        assert!(message(f64::NAN, 0.1).starts_with("currentCommunicationPoint = NaN s"));
        let late = CommunicationPoint::new(1e308);
        assert!(late.duration(1e308, 1e308).unwrap_err().to_string().ends_with("ends at a finite time"));
    }
}
