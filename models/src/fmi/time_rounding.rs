//! Rounding of the times that importers name: what of it is ignored, what passes, and what is none.

use serde::{Deserialize, Serialize};

/// Rounding of a time, in units in the last place.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Rounding that gaps may come to and be ignored, in units in the last place: times that are counted round by less, and what
/// is made up for in one step stays within what a clock takes for a tick's time and a longest step for its own.
pub(super) const IGNORED: f64 = 2.0 * f64::EPSILON;

/// Half a unit in the last place of 1.
const HALF_A_UNIT: f64 = 0.5 * f64::EPSILON;

/// Share of a step by which the point that it leads to may be named differently, and its end miss the stop time, by rounding.
const TOLERANCE: f64 = 1e-9;

/// Share of a step that the gap before it may come to at most, however long the step before: it is rounding to both.
const LARGEST_SHARE: f64 = 1e-6;

/// Share of a step by which its end may miss the stop time at most, however many steps went before: no step is taken for
/// rounding. Ten million steps of one size round by less.
const LARGEST_TOLERANCE: f64 = 1e-2;

/// What the times of a simulation have rounded by so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TimeRounding {
    /// By how much the sum of the steps so far may be off \[s\]: each addition rounds by up to half a unit in the last
    /// place of the time it leads to. Importers add up step sizes, as FMI 2.0.5 asks (section 4.2.1: t_{i+1} = t_i + h_i).
    /// After n steps of one size it is n eps t / 4.
    drift: f64,
    /// Length of the last step \[s\], 0 before the first.
    last_step: f64,
    /// Sum of the gaps that were ignored: begin of a step less end of the one before \[s\].
    gaps: f64,
    /// Sum of what the ends of steps, begin + step size, have rounded by meanwhile \[s\].
    rounded: f64,
}

impl TimeRounding {
    /// Whether a simulation can have rounded like this.
    pub fn is_possible(&self) -> bool {
        let Self { drift, last_step, gaps, rounded } = *self;
        [drift, last_step].iter().all(|length| (0.0..f64::INFINITY).contains(length))
            && gaps.is_finite()
            && rounded.is_finite()
    }

    /// Whether gaps that come to `gaps` \[s\] are nothing but `rounding` \[s\].
    ///
    /// An importer that adds up its steps leaves no gap. One that counts them (t = start + k h) leaves such that undo what
    /// the additions here have rounded by, so that its time is the sum of all steps. Gaps of others, whose steps are not
    /// quite what lies between their times, grow with the steps in both respects.
    #[inline(always)]
    fn is_rounding(&self, gaps: f64, rounding: f64) -> bool {
        gaps.abs() <= rounding || (gaps + self.rounded).abs() <= rounding
    }

    /// Whether a step that begins `gap` \[s\] after the end of the last one takes its own size and no more, for both are
    /// the same but for a `rounding` \[s\].
    #[inline(always)]
    pub fn is_ignored(&self, gap: f64, rounding: f64) -> bool {
        gap.abs() <= rounding && self.is_rounding(self.gaps, rounding)
    }

    /// Time \[s\] that passes in a step over `step_size` whose begin misses the end of the last step by `gap`, both in s and
    /// at times of up to `largest_time` \[s\].
    ///
    /// Gaps are ignored as long as they come to a few units in the last place of the time, or undo what times have rounded
    /// by. Beyond that they pass with the step, so that the model's time is the importer's, or with a later one that is long
    /// enough. A gap of more than a billionth of the last step or a millionth of this one, and of some units in the last
    /// place, is no rounding: `None`.
    pub fn duration(&self, gap: f64, step_size: f64, largest_time: f64) -> Option<f64> {
        let gaps = self.gaps + gap;
        let passes = step_size + (gaps + self.rounded);
        let is_close = gap.abs() <= ROUNDING * largest_time;
        let tolerance = (TOLERANCE * self.last_step).min(LARGEST_SHARE * step_size);
        if is_close && (passes <= 0.0 || self.is_rounding(gaps, IGNORED * largest_time)) {
            Some(step_size)
        } else if passes > 0.0 && (is_close || gap.abs() <= tolerance) {
            Some(passes)
        } else {
            None
        }
    }

    /// By how much `time` may be past the stop time, after a last step over `step`; all in s.
    pub fn tolerance_of_end(&self, time: f64, step: f64) -> f64 {
        self.drift.max(TOLERANCE * step).min(LARGEST_TOLERANCE * step) + ROUNDING * time.abs()
    }

    /// A step from `begin` over `step_size` is taken, `gap` after the end of the last one, in which `duration` passes; all
    /// in s.
    #[inline]
    pub fn begin_step(&mut self, gap: f64, begin: f64, step_size: f64, duration: f64) {
        self.gaps += gap;
        if duration != step_size {
            self.gaps += self.rounded + (step_size - duration);
            self.rounded = 0.0;
        }
        // Two-sum of Knuth: what the end differs by from the sum of two numbers, exactly.
        let end = begin + step_size;
        let added = end - begin;
        self.rounded += (end - added - begin) + (added - step_size);
        if step_size > 0.0 {
            self.last_step = step_size;
        }
    }

    /// Time has come to `time` \[s\] by an addition.
    #[inline]
    pub fn reach(&mut self, time: f64) {
        self.drift += HALF_A_UNIT * time.abs();
    }

    /// A step over `way` \[s\] has ended where the importer's time is ahead of the model's clock by `ahead` \[s\].
    pub fn agree(&mut self, way: f64, ahead: f64) {
        (self.gaps, self.rounded) = (ahead, 0.0);
        if way > 0.0 {
            self.last_step = way;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CallError, CommunicationPoint};
    use crate::model::sample_clock::SampleClock;
    use proptest::prelude::*;

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
                let duration = duration.unwrap();
                passed += duration;
                point.take_step(time, h, duration);
            }
            let expected = f64::from(steps + 5) * h;
            prop_assert!((passed - expected).abs() < 1e-11 * expected, "{passed} {expected}");
        }
    }

    /// Steps from start + k h, computed by `time(k)`; the time that passes in each and in all of them.
    fn passed(start: f64, steps: u32, h: f64, time: impl Fn(u32) -> f64) -> (Vec<f64>, f64) {
        let mut point = CommunicationPoint::new(start, None);
        let durations: Vec<f64> = (0..steps)
            .map(|k| {
                let duration = point.duration(time(k), h).unwrap();
                point.take_step(time(k), h, duration);
                duration
            })
            .collect();
        // Adds without rounding.
        let mut clock = SampleClock::new(1.0, 0.0);
        durations.iter().for_each(|duration| clock.pass(*duration));
        (durations, clock.time())
    }

    proptest! {
        /// Bits depend on it: importers that count their steps, in either way, and such that add them up let the same time
        /// pass.
        #[test]
        fn rounding_of_honest_importers_changes_no_step(
            exponent in -3.0..9.0f64, step_exponent in -5.0..-1.0f64, steps in 1000u32..20_000,
        ) {
            let (start, h) = (10f64.powf(exponent), 10f64.powf(step_exponent));
            let (counted, _) = passed(start, steps, h, |k| start + f64::from(k) * h);
            prop_assert!(counted.iter().all(|duration| *duration == h));
            let divisor = libm::ceil(1.0 / h);
            let (divided, _) = passed(start, steps, 1.0 / divisor, |k| start + f64::from(k) / divisor);
            prop_assert!(divided.iter().all(|duration| *duration == 1.0 / divisor));
            let mut times = vec![start];
            (1..steps as usize).for_each(|k| times.push(times[k - 1] + h));
            let (added_up, _) = passed(start, steps, h, |k| times[k as usize]);
            prop_assert!(added_up.iter().all(|duration| *duration == h));
        }

        /// Guards: a step size that is off by some units in the last place of the time took the clock away for ever, at
        /// 1.7e9 s by 39 ms in 20 s; one of ten digits did, where each gap is less than the last digit of the time.
        #[test]
        fn gaps_that_add_up_pass(
            exponent in 0.0..10.0f64, units in prop_oneof![-14.0..14.0f64, -0.6..0.6f64], steps in 1000u32..50_000,
        ) {
            let (start, h) = (10f64.powf(exponent), 1e-3);
            let wrong = h + units * f64::EPSILON * start;
            prop_assume!(h > 64.0 * f64::EPSILON * start);
            let time = |k: u32| start + f64::from(k) * h;
            let (_, sum) = passed(start, steps, wrong, time);
            let expected = time(steps - 1) + wrong - start;
            let rounding = what_additions_round(time(steps), steps);
            prop_assert!((sum - expected).abs() <= rounding, "{sum} {expected} {rounding}");
        }

        /// Guards: an importer that counts its steps and passes them with ten digits lost its ticks after some minutes.
        #[test]
        fn counted_steps_of_ten_digits_pass(divisor in 601u32..100_000, start in -10.0..10.0f64, steps in 1000u32..50_000) {
            let h = 1.0 / f64::from(divisor);
            let ten_digits: f64 = format!("{h:.9e}").parse().unwrap();
            let time = |k: u32| start + f64::from(k) * h;
            let (_, sum) = passed(start, steps, ten_digits, time);
            let expected = time(steps - 1) + ten_digits - start;
            let rounding = what_additions_round(10.0 + expected, steps);
            prop_assert!((sum - expected).abs() <= rounding, "{divisor} {start}: {sum} {expected} {rounding}");
        }
    }

    /// Where the additions round as the importer's times do, gaps cannot be told from them; beyond that little is ignored.
    fn what_additions_round(largest_time: f64, steps: u32) -> f64 {
        (0.5 * f64::from(steps) + 64.0) * f64::EPSILON * largest_time
    }

    /// Takes all but the last of `steps` steps of `h` \[s\] as an importer that adds them up; returns where it stands.
    fn added_up(point: &mut CommunicationPoint, h: f64, steps: u32) -> f64 {
        let mut time = 0.0;
        for _ in 1..steps {
            assert_eq!(point.duration(time, h), Ok(h), "at {time} s");
            point.take_step(time, h, h);
            time += h;
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
            assert!(
                (0.99..1.01).contains(&(point.rounding.drift / bound)),
                "{} {bound}",
                point.rounding.drift
            );
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
        point.rounding.drift = 1.0;
        point.move_to(0.9);
        assert!(point.duration(0.9, 0.1 + 0.9e-3).is_ok());
        assert!(point.duration(0.9, 0.1 + 1.1e-3).is_err());
        // A solver that has gone back by a rounding.
        assert!(point.require_before_stop_time("time", 0.9, -1e-17).is_ok());
    }
}
