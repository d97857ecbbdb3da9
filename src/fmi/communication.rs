//! Communication points: whether a step follows the one before, how much time really passes, and where time ends.

use super::CallError;
use serde::{Deserialize, Serialize};

/// Rounding that importers accumulate between two communication points, in units in the last place.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Half a unit in the last place of 1.
const HALF_A_UNIT: f64 = 0.5 * f64::EPSILON;

/// Share of a step by which its begin may miss the end of the last step, and its end the stop time, by rounding.
const TOLERANCE: f64 = 1e-9;

/// Share of a step by which its end may miss the stop time at most, however many steps went before: no step is taken for
/// rounding. Ten million steps of one size round by less.
const LARGEST_TOLERANCE: f64 = 1e-2;

/// The point the simulation has reached, and the one it must not pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommunicationPoint {
    /// \[s\]
    now: f64,
    /// \[s\], infinite if none is defined: a number, so that saved states have a fixed size.
    stop_time: f64,
    /// By how much the sum of the steps so far may be off \[s\]: each addition rounds by up to half a unit in the last
    /// place of the time it leads to. Importers add up step sizes, as FMI 2.0.5 asks (section 4.2.1: t_{i+1} = t_i + h_i).
    /// After n steps of one size it is n eps t / 4.
    drift: f64,
}

impl CommunicationPoint {
    /// Stands at `start_time`; `stop_time` is `None` if the importer defines none, both in s.
    pub fn new(start_time: f64, stop_time: Option<f64>) -> Self {
        Self { now: start_time, stop_time: stop_time.unwrap_or(f64::INFINITY), drift: 0.0 }
    }

    /// Time reached \[s\].
    pub fn now(&self) -> f64 {
        self.now
    }

    /// Whether a simulation that began at `start_time` \[s\] can stand here.
    pub fn is_possible_after(&self, start_time: f64) -> bool {
        let is_drift = (0.0..f64::INFINITY).contains(&self.drift);
        self.now.is_finite() && start_time.is_finite() && self.stop_time >= start_time && is_drift
    }

    /// Time \[s\] that passes in a step from `point` over `step_size`, both in s.
    ///
    /// A difference between `point` and the end of the last step is taken for rounding and ignored up to a few
    /// units in the last place, passes in addition up to a billionth of the step, or of the times if those are smaller, and is
    /// an error beyond. A step that
    /// ends after the stop time is an error, too, unless rounding alone carries it there, its own and that of the steps
    /// before (FMI 2.0.5, section 2.1.6; FMI 3.0.2, section 2.3.2).
    #[inline(always)]
    pub fn duration(&self, point: f64, step_size: f64) -> Result<f64, CallError> {
        let end = point + step_size;
        // Nearly every step. An end that is finite was reached from finite numbers, and no comparison holds of what is none.
        if step_size > 0.0 && self.is_here(point) && end <= self.stop_time && end < f64::INFINITY {
            return Ok(step_size);
        }
        self.duration_in_full(point, step_size)
    }

    /// Whether `point` is the end of the last step, but for a few units in the last place.
    #[inline(always)]
    fn is_here(&self, point: f64) -> bool {
        (point - self.now).abs() <= ROUNDING * self.now.abs()
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
        let passes = if self.is_here(point) { step_size } else { self.duration_after_gap(point, step_size)? };
        let argument = "currentCommunicationPoint + communicationStepSize";
        self.require_before_stop_time(argument, point + step_size, step_size)?;
        Ok(passes)
    }

    /// As [`Self::duration`], of a step from a `point` that is not the end of the last step.
    fn duration_after_gap(&self, point: f64, step_size: f64) -> Result<f64, CallError> {
        let gap = point - self.now;
        // Times round by their own size, be the step as long as it likes; where they come to 0, by that of those before.
        let largest_time = point.abs().max(self.now.abs());
        let rounding_before = (ROUNDING / HALF_A_UNIT * self.drift).min(TOLERANCE * step_size);
        if gap.abs() <= ROUNDING * largest_time {
            Ok(step_size)
        } else if gap.abs() <= (TOLERANCE * step_size.min(largest_time)).max(rounding_before) {
            Ok(step_size + gap)
        } else {
            Err(CallError::TimeDoesNotFollow { got: point, expected: self.now })
        }
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
        let excess = time - self.stop_time;
        let tolerance = self.drift.max(TOLERANCE * step).min(LARGEST_TOLERANCE * step);
        if excess <= tolerance + ROUNDING * time.abs() {
            Ok(())
        } else {
            Err(CallError::PastStopTime { argument, time, stop_time: self.stop_time })
        }
    }

    /// Time has come to `time` \[s\].
    #[inline]
    pub fn move_to(&mut self, time: f64) {
        self.now = time;
        self.drift += HALF_A_UNIT * time.abs();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rounding_is_ignored_and_small_gaps_pass() {
        let mut point = CommunicationPoint::new(0.0, None);
        assert_eq!(point.duration(0.0, 0.1), Ok(0.1));
        point.move_to(0.1);
        assert_eq!(point.duration(0.100_000_000_000_000_03, 0.1), Ok(0.1));
        assert_eq!(point.duration(0.100_000_000_05, 0.1), Ok(0.1 + (0.100_000_000_05 - 0.1)));
        assert_eq!(point.now(), 0.1);
    }

    #[test]
    fn a_gap_beyond_rounding_does_not_follow_however_long_the_step() {
        let mut point = CommunicationPoint::new(0.0, None);
        point.move_to(1e-3);
        let long = [1000.0, 9e8, 1e12, 1e300].map(|step_size| (0.9, step_size));
        let short = [(1.001e-3, 1e-3), (0.999e-3, 1e-3), (1e-3 + 1e-11, 1e-3), (0.0, 1e12)];
        for (time, step_size) in long.into_iter().chain(short) {
            let refused = point.duration(time, step_size);
            assert_eq!(refused, Err(CallError::TimeDoesNotFollow { got: time, expected: 1e-3 }));
        }
        // However many steps went before.
        let mut point = CommunicationPoint::new(0.0, None);
        (1..=1_000_000).for_each(|k| point.move_to(f64::from(k) * 1e-3));
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
            point.move_to(time + 0.1);
            let multiple = -1.0 + f64::from(k) * 0.1;
            assert!((point.duration(multiple, 0.1).unwrap() - 0.1).abs() < 1e-15, "{multiple}");
        }
    }

    proptest! {
        /// Guards: communication points start + k h of importers that start before 0, refused where they come to 0.
        #[test]
        fn multiples_of_a_step_follow_each_other_through_zero(start in -10.0..-1e-3f64, steps in 1u32..3000) {
            let h = -start / f64::from(steps);
            let (mut point, mut passed) = (CommunicationPoint::new(start, None), 0.0);
            for k in 0..steps + 5 {
                let time = start + f64::from(k) * h;
                let duration = point.duration(time, h);
                prop_assert!(duration.is_ok(), "start {start} step {h} number {k}: {duration:?}");
                passed += duration.unwrap();
                point.move_to(time + h);
            }
            let expected = f64::from(steps + 5) * h;
            prop_assert!((passed - expected).abs() < 1e-11 * expected, "{passed} {expected}");
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

    /// Takes all but the last of `steps` steps of `h` \[s\] as an importer that adds them up; returns where it stands.
    fn added_up(point: &mut CommunicationPoint, h: f64, steps: u32) -> f64 {
        let mut time = 0.0;
        for _ in 1..steps {
            assert_eq!(point.duration(time, h), Ok(h), "at {time} s");
            time += h;
            point.move_to(time);
        }
        time
    }

    /// Guards: the last of a million steps refused, since their sum is 2.2e-9 s late.
    #[test]
    fn importers_that_add_up_their_steps_reach_the_stop_time() {
        let mut latest = 0.0;
        for (h, steps, stop_time) in [
            (1e-4, 1_000_000, 100.0),
            (1e-3, 100_000, 100.0),
            (1e-3, 1_000_000, 1000.0),
            (7e-4, 1_000_000, 700.0),
            (1.0 / 3000.0, 300_000, 100.0),
        ] {
            let mut point = CommunicationPoint::new(0.0, Some(stop_time));
            let time = added_up(&mut point, h, steps);
            latest = f64::max(latest, (time + h - stop_time) / h);
            assert_eq!(point.duration(time, h), Ok(h), "{steps} steps of {h} s");
            // The bound of the sum of so many roundings.
            let bound = f64::from(steps) * f64::EPSILON * stop_time / 4.0;
            assert!((0.99..1.01).contains(&(point.drift / bound)), "{} {bound}", point.drift);
            assert!((time + h - stop_time).abs() < bound);

            for past in [1e-3 * h, 0.5 * h, h] {
                let late = point.duration(time, h + past);
                assert!(matches!(late, Err(CallError::PastStopTime { .. })), "{past} s past: {late:?}");
            }
            point.move_to(time + h);
            assert!(matches!(point.duration(time + h, h), Err(CallError::PastStopTime { .. })));
        }
        assert!(latest > 1e-5, "a sum that ends late is among them: {latest} of a step");
    }

    #[test]
    fn no_number_of_steps_makes_up_for_a_hundredth_of_one() {
        let mut point = CommunicationPoint::new(0.0, Some(1.0));
        point.drift = 1.0;
        point.move_to(0.9);
        assert!(point.duration(0.9, 0.1 + 0.9e-3).is_ok());
        assert!(point.duration(0.9, 0.1 + 1.1e-3).is_err());
        // A solver that has gone back by a rounding.
        assert!(point.require_before_stop_time("time", 0.9, -1e-17).is_ok());
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
