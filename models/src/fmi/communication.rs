//! Communication points: whether a step follows the one before, how much time really passes, and where time ends.

use super::CallError;
use super::time_rounding::{IGNORED, TimeRounding};
use serde::{Deserialize, Serialize};

/// The point the simulation has reached, and the one it must not pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommunicationPoint {
    /// \[s\]
    now: f64,
    /// \[s\], infinite if none is defined: a number, so that saved states have a fixed size.
    stop_time: f64,
    pub(super) rounding: TimeRounding,
}

impl CommunicationPoint {
    /// Stands at `start_time`; `stop_time` is `None` if the importer defines none, both in s.
    pub fn new(start_time: f64, stop_time: Option<f64>) -> Self {
        let stop_time = stop_time.unwrap_or(f64::INFINITY);
        Self { now: start_time, stop_time, rounding: TimeRounding::default() }
    }

    /// Time reached \[s\].
    pub fn now(&self) -> f64 {
        self.now
    }

    /// Whether a simulation that began at `start_time` \[s\] can stand here.
    pub fn is_possible_after(&self, start_time: f64) -> bool {
        let is_time = self.now.is_finite() && start_time.is_finite() && self.stop_time >= start_time;
        is_time && self.rounding.is_possible()
    }

    /// Time \[s\] that passes in a step from `point` over `step_size`, both in s.
    ///
    /// A difference between `point` and the end of the last step that is no rounding is an error, see
    /// `TimeRounding::duration`. A step that ends after the stop time is an error, too, unless rounding alone carries it
    /// there, its own and that of the steps before (FMI 2.0.5, section 2.1.6; FMI 3.0.2, section 2.3.2).
    #[inline(always)]
    pub fn duration(&self, point: f64, step_size: f64) -> Result<f64, CallError> {
        let end = point + step_size;
        // Nearly every step. An end that is finite was reached from finite numbers, and no comparison holds of what is none.
        let is_ordinary = step_size > 0.0 && end <= self.stop_time && end < f64::INFINITY;
        if is_ordinary && self.rounding.is_ignored(point - self.now, IGNORED * self.now.abs()) {
            return Ok(step_size);
        }
        self.duration_in_full(point, step_size)
    }

    /// As [`Self::duration`], for every step and with the reasons of refusals.
    #[cold]
    fn duration_in_full(&self, point: f64, step_size: f64) -> Result<f64, CallError> {
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
        let largest_time = point.abs().max(self.now.abs());
        let passes = self.rounding.duration(point - self.now, step_size, largest_time);
        let passes = passes.ok_or(CallError::TimeDoesNotFollow { got: point, expected: self.now })?;
        let argument = "currentCommunicationPoint + communicationStepSize";
        if point >= self.stop_time {
            // All of the step is past it, be it as short as rounding.
            let (time, stop_time) = (point + step_size, self.stop_time);
            return Err(CallError::PastStopTime { argument, time, stop_time });
        }
        self.require_before_stop_time(argument, point + step_size, step_size)?;
        Ok(passes)
    }

    /// Refuses a `time` \[s\] after the stop time; rounding is measured by `step`, the way that leads there \[s\].
    #[inline]
    pub fn require_before_stop_time(
        &self,
        argument: &'static str,
        time: f64,
        step: f64,
    ) -> Result<(), CallError> {
        if time <= self.stop_time {
            return Ok(());
        }
        if time - self.stop_time <= self.rounding.tolerance_of_end(time, step) {
            Ok(())
        } else {
            Err(CallError::PastStopTime { argument, time, stop_time: self.stop_time })
        }
    }

    /// A step from `point` over `step_size` is taken, for which `duration` passes in the model, all in s.
    #[inline]
    pub fn take_step(&mut self, point: f64, step_size: f64, duration: f64) {
        self.begin_step(point, step_size, duration);
        self.move_to(point + step_size);
    }

    /// The begin of [`Self::take_step`]; its end is told by [`Self::move_to`].
    #[inline]
    pub fn begin_step(&mut self, point: f64, step_size: f64, duration: f64) {
        self.rounding.begin_step(point - self.now, point, step_size, duration);
    }

    /// Time has come to `time` \[s\].
    #[inline]
    pub fn move_to(&mut self, time: f64) {
        self.now = time;
        self.rounding.reach(time);
    }

    /// A step has ended at `time`, where the model's clock says `clock_time`, both in s.
    pub fn move_to_time_of_clock(&mut self, time: f64, clock_time: f64) {
        self.rounding.agree(time - self.now, time - clock_time);
        self.move_to(time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_ignored_and_small_gaps_pass() {
        let mut point = CommunicationPoint::new(0.0, None);
        assert_eq!(point.duration(0.0, 0.1), Ok(0.1));
        point.take_step(0.0, 0.1, 0.1);
        assert_eq!(point.duration(0.100_000_000_000_000_03, 0.1), Ok(0.1));
        assert_eq!(point.duration(0.100_000_000_05, 0.1), Ok(0.1 + (0.100_000_000_05 - 0.1)));
        assert_eq!(point.now(), 0.1);
    }

    #[test]
    fn a_gap_beyond_rounding_does_not_follow_however_long_the_step() {
        let mut point = CommunicationPoint::new(0.0, None);
        point.take_step(0.0, 1e-3, 1e-3);
        let long = [1000.0, 9e8, 1e12, 1e300].map(|step_size| (0.9, step_size));
        let short = [(1.001e-3, 1e-3), (0.999e-3, 1e-3), (1e-3 + 1e-11, 1e-3), (0.0, 1e12)];
        for (time, step_size) in long.into_iter().chain(short) {
            let refused = point.duration(time, step_size);
            assert_eq!(refused, Err(CallError::TimeDoesNotFollow { got: time, expected: 1e-3 }));
        }
        // However many steps went before.
        let mut point = CommunicationPoint::new(0.0, None);
        (0..1_000_000).for_each(|k| point.take_step(f64::from(k) * 1e-3, 1e-3, 1e-3));
        for (gap, step_size) in [(0.2, 1e9), (1e-5, 1e9), (1e-5, 1e300), (1e-7, 1e-3)] {
            let refused = point.duration(1000.0 + gap, step_size);
            assert!(
                matches!(refused, Err(CallError::TimeDoesNotFollow { .. })),
                "{gap} {step_size}: {refused:?}"
            );
        }
        // Where time comes to 0, sums have rounded by more than the time itself.
        let mut point = CommunicationPoint::new(-1.0, None);
        for k in 1..=10 {
            let time = point.now();
            assert_eq!(point.duration(time, 0.1), Ok(0.1));
            point.take_step(time, 0.1, 0.1);
            let multiple = -1.0 + f64::from(k) * 0.1;
            assert!((point.duration(multiple, 0.1).unwrap() - 0.1).abs() < 1e-15, "{multiple}");
        }
    }

    #[test]
    fn steps_end_at_the_stop_time_but_for_rounding() {
        let (stop_time, h) = (0.01, 1e-3);
        let mut point = CommunicationPoint::new(0.0, Some(stop_time));
        point.move_to(0.009);
        for beyond in [0.0, 1e-12] {
            assert!(point.duration(0.009, h + beyond).is_ok(), "{beyond}");
        }
        let late = point.duration(0.009, h + 3e-12);
        assert!(
            matches!(late, Err(CallError::PastStopTime { stop_time: 0.01, .. })),
            "three billionths of a step: {late:?}"
        );
        assert_eq!(
            point.duration(0.009, 2e-3).unwrap_err().to_string(),
            "currentCommunicationPoint + communicationStepSize = 0.011 s is past the stop time: expected at most 0.01 s"
        );
        // Late in a long simulation a billionth of a step is less than the last digit of the time.
        let mut point = CommunicationPoint::new(0.0, Some(1e6));
        point.move_to(1e6 - 1e-4);
        assert!(point.duration(1e6 - 1e-4, 1e-4 + 1e-10).is_ok());
    }

    #[test]
    fn times_that_make_no_sense_are_named() {
        let point = CommunicationPoint::new(1.0, None);
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
        let late = CommunicationPoint::new(1e308, None);
        assert!(late.duration(1e308, 1e308).unwrap_err().to_string().ends_with("ends at a finite time"));
    }
}
