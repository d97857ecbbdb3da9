//! Ticks of a sampled controller at t = k * period, counted in integers.
//!
//! Importers accumulate rounding: t = 1.0000000000000007, h = 0.09999999999999998. The clock adds up the step
//! sizes with a compensated sum, which stays exact to the last digit however many steps there are, and a tick
//! belongs to a step only if it lies more than a ten-thousandth of a period before the step's end. Ticks thus never
//! depend on how the interval was cut into steps, not even when an importer rounds its step size to some ten digits.

use super::ModelError;
use serde::{Deserialize, Serialize};

/// Share of a period by which a communication point may miss a tick and still mean it.
const TOLERANCE: f64 = 1e-4;

/// Largest number of a tick at a start: there the rounding of a quotient is half a period.
const LARGEST_NUMBER: f64 = 281_474_976_710_656.0;

/// Clock with integer ticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampleClock {
    /// \[s\]
    period: f64,
    /// Time since t = 0 \[s\] as an unevaluated sum of a large and a small part.
    elapsed: (f64, f64),
    /// Number k of the next tick; saved in a fixed number of bytes.
    #[serde(with = "postcard::fixint::le")]
    next: i64,
}

impl SampleClock {
    /// A clock that stands at `start_time` \[s\]; its first tick is the first k with k * `period` >= start.
    pub fn new(period: f64, start_time: f64) -> Self {
        let mut clock = Self { period, elapsed: (start_time, 0.0), next: 0 };
        clock.next = clock.first_tick_not_before_now();
        clock
    }

    /// As [`SampleClock::new`]; refused where the numbers of neighbouring ticks have no different times any more.
    pub fn starting(period: f64, start_time: f64) -> Result<Self, ModelError> {
        let limit = LARGEST_NUMBER * period;
        if start_time.abs() <= limit {
            Ok(Self::new(period, start_time))
        } else {
            Err(ModelError::StartOutOfReach { start_time, period, limit })
        }
    }

    /// Lets `duration` \[s\] pass and returns the numbers of the ticks in it, its start included, its end not.
    #[inline]
    pub fn advance(&mut self, duration: f64) -> core::ops::Range<i64> {
        self.pass(duration);
        let first = self.next;
        self.next = self.first_tick_not_before_now().max(first);
        first..self.next
    }

    /// Lets `duration` \[s\] pass and returns the numbers of the ticks in it, its start excluded, its end not, for what
    /// happens at the ends of steps. Not to be mixed with [`SampleClock::advance`] on one clock.
    #[inline]
    pub fn advance_through(&mut self, duration: f64) -> core::ops::Range<i64> {
        self.pass(duration);
        self.take_all_due()
    }

    /// Moves to `time` \[s\], never back, counts the ticks up to it, it included, and returns their numbers.
    pub fn advance_up_to(&mut self, time: f64) -> core::ops::Range<i64> {
        if time > self.elapsed.0 {
            self.stand_at(time);
        }
        self.take_all_due()
    }

    /// Whether the last tick that was counted is at the present time, but for rounding.
    pub fn has_just_ticked(&self) -> bool {
        let periods = (self.elapsed.0 + self.elapsed.1) / self.period;
        (periods - self.next.saturating_sub(1) as f64).abs() <= tolerance(periods)
    }

    /// Time until tick `k` \[s\].
    pub fn until(&self, k: i64) -> f64 {
        (self.time_of(k) - self.elapsed.0) - self.elapsed.1
    }

    fn take_all_due(&mut self) -> core::ops::Range<i64> {
        let first = self.next;
        self.next = self.first_tick_not_before_now().max(first);
        if self.is_due() {
            self.next = self.next.saturating_add(1);
        }
        first..self.next
    }

    /// Lets `duration` \[s\] pass and leaves the ticks in it to the caller, who takes them one by one.
    #[inline]
    pub fn pass(&mut self, duration: f64) {
        // Two-sum of Knuth: `sum + error` is exactly `large + addend`.
        let (large, small) = self.elapsed;
        let addend = duration + small;
        let sum = large + addend;
        let virtual_addend = sum - large;
        let error = (large - (sum - virtual_addend)) + (addend - virtual_addend);
        self.elapsed = (sum, error);
    }

    /// Moves to `time` \[s\], however far away: somebody else decides about time.
    pub fn stand_at(&mut self, time: f64) {
        self.elapsed = (time, 0.0);
    }

    /// Where the clock stands \[s\].
    pub fn time(&self) -> f64 {
        self.elapsed.0
    }

    /// \[s\]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Number k of the next tick.
    pub fn next_number(&self) -> i64 {
        self.next
    }

    /// Time of the next tick \[s\].
    pub fn next_time(&self) -> f64 {
        self.time_of(self.next)
    }

    /// Whether the next tick is at the present time, or before it.
    pub fn is_due(&self) -> bool {
        let periods = (self.elapsed.0 + self.elapsed.1) / self.period;
        self.next as f64 <= periods + tolerance(periods)
    }

    /// Time until the next tick \[s\], 0 if it is due, provided that [`SampleClock::advance`] would tick within
    /// `duration` \[s\].
    pub fn until_tick_within(&self, duration: f64) -> Option<f64> {
        let mut clock = *self;
        if clock.advance(duration).is_empty() {
            return None;
        }
        Some(if self.is_due() { 0.0 } else { self.until(self.next).max(0.0).min(duration) })
    }

    /// Counts the next tick and returns its time \[s\].
    pub fn take(&mut self) -> f64 {
        let time = self.next_time();
        self.next = self.next.saturating_add(1);
        time
    }

    /// Counts the tick that somebody calls for at `time` \[s\] and returns its own time: a multiple of the period if
    /// that is what `time` means, else `time` itself.
    pub fn take_at(&mut self, time: f64) -> f64 {
        self.stand_at(time);
        self.next = self.first_tick_not_before_now();
        if self.is_due() { self.take() } else { time }
    }

    /// Whether a clock with this `period` \[s\] can stand here; false for numbers that no clock ever has.
    pub fn is_valid_for(&self, period: f64) -> bool {
        let due = self.first_tick_not_before_now();
        // So far away that rounding is more than a period, ticks may have been counted that the quotient does not show.
        let periods = (self.elapsed.0 + self.elapsed.1) / self.period;
        let hidden = (3.0 * tolerance(periods)) as i64;
        self.period == period
            && period > 0.0
            && self.elapsed.0.is_finite()
            && self.elapsed.1.is_finite()
            && (due..=due.saturating_add(1).saturating_add(hidden)).contains(&self.next)
    }

    /// Time of tick `k` \[s\].
    pub fn time_of(&self, k: i64) -> f64 {
        k as f64 * self.period
    }

    #[inline]
    fn first_tick_not_before_now(&self) -> i64 {
        let periods = (self.elapsed.0 + self.elapsed.1) / self.period;
        // Beyond the range of numbers the tolerance is as large as what it is taken from.
        let bound = if periods.is_finite() { periods - tolerance(periods) } else { periods };
        // Rounds up; the casts saturate, and 2^63 ticks are out of reach.
        let below = bound as i64;
        if (below as f64) < bound { below.saturating_add(1) } else { below }
    }
}

/// Periods by which a point in time, given in `periods`, may miss a tick and still mean it.
#[inline]
fn tolerance(periods: f64) -> f64 {
    // The quotient itself is only good to some last digits; this matters beyond 1e9 periods.
    TOLERANCE.max(8.0 * f64::EPSILON * periods.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_start_where_ticks_cannot_be_told_apart_is_refused() {
        for period in [1e-6, 1e-3, 1.0] {
            let limit = LARGEST_NUMBER * period;
            for start_time in [limit, -limit, 0.0] {
                let mut clock = SampleClock::starting(period, start_time).unwrap();
                // Rounding is half a period there, so that the second one may be yet to come.
                let ticks = clock.advance(1.5 * period);
                assert!((1..=2).contains(&(ticks.end - ticks.start)), "{period} {start_time} {ticks:?}");
                assert!(clock.is_valid_for(period));
            }
            for start_time in [limit.next_up(), -limit.next_up(), 1e300, -1e300] {
                let refused = SampleClock::starting(period, start_time);
                assert_eq!(refused, Err(ModelError::StartOutOfReach { start_time, period, limit }));
            }
        }
    }

    #[test]
    fn a_clock_far_away_stands_where_it_has_come_to() {
        for time in [1e15, 2.3e16, 1e300] {
            let mut clock = SampleClock::new(1e-3, 0.0);
            clock.stand_at(time);
            for _ in 0..1000 {
                clock.advance_through(0.0);
                assert!(clock.is_valid_for(1e-3), "{time}");
            }
        }
    }

    #[test]
    fn ticks_lie_in_the_half_open_interval() {
        let mut clock = SampleClock::new(1e-3, 0.0);
        assert_eq!(clock.advance(0.5e-3), 0..1);
        assert_eq!(clock.advance(0.5e-3), 1..1);
        assert_eq!(clock.advance(3.7e-3), 1..5);
        assert_eq!(SampleClock::new(1e-3, 0.0025).advance(1e-3), 3..4);
    }

    #[test]
    fn ticks_taken_one_by_one_are_those_of_whole_steps() {
        for step in [1e-3, 2.5e-4, 3.7e-3, 1.0 / 60.0, 0.0009999999999999998] {
            let (mut whole, mut single) = (SampleClock::new(1e-3, 0.0), SampleClock::new(1e-3, 0.0));
            let (mut expected, mut taken) = (Vec::new(), Vec::new());
            for _ in 0..500 {
                expected.extend(whole.advance(step).map(|k| whole.time_of(k)));
                let mut rest = step;
                while let Some(wait) = single.until_tick_within(rest) {
                    single.pass(wait);
                    assert!(single.is_due());
                    taken.push(single.take());
                    rest -= wait;
                    if rest <= 0.0 {
                        break;
                    }
                }
                single.pass(rest);
            }
            assert_eq!(taken, expected, "{step}");
        }
    }

    #[test]
    fn a_tick_is_due_from_its_time_on() {
        let mut clock = SampleClock::new(1e-3, 0.0);
        assert!(clock.is_due());
        assert_eq!(clock.until_tick_within(1e-3), Some(0.0));
        assert_eq!(clock.take(), 0.0);
        assert!(!clock.is_due());
        // The end of an interval does not belong to it.
        assert_eq!(clock.until_tick_within(1e-3), None);
        assert_eq!(clock.until_tick_within(2e-3), Some(1e-3));
        clock.pass(0.000_999_999_999);
        assert!(clock.is_due(), "rounded");
        assert_eq!(clock.next_time(), 1e-3);
    }

    #[test]
    fn a_tick_on_call_snaps_to_the_grid_it_means() {
        let mut clock = SampleClock::new(1e-3, 0.0);
        assert_eq!(clock.take_at(0.0), 0.0);
        assert_eq!(clock.take_at(1e-3 + 1e-12), 1e-3);
        assert_eq!(clock.take_at(0.0015), 0.0015);
        assert_eq!(clock.take_at(0.0019999999999), 0.002);
        assert!(clock.is_valid_for(1e-3));
    }

    #[test]
    fn ticks_at_the_end_belong_to_a_step_that_is_gone_through() {
        let mut clock = SampleClock::new(1e-3, 0.0);
        assert_eq!(clock.advance_through(0.0), 0..1);
        assert_eq!(clock.advance_through(0.5e-3), 1..1);
        assert_eq!(clock.advance_through(0.5e-3), 1..2);
        assert_eq!(clock.advance_through(3.7e-3), 2..5);
        assert_eq!(clock.advance_up_to(0.005), 5..6);
        // Neither twice nor back, and what is rounded off still counts.
        assert_eq!(clock.advance_up_to(0.005), 6..6);
        assert_eq!(clock.advance_up_to(0.001), 6..6);
        assert_eq!(clock.advance_up_to(0.005_999_999_99), 6..7);
        assert_eq!(clock.advance_up_to(0.0105), 7..11);
        assert!(clock.is_valid_for(1e-3));
        assert_eq!(clock.advance_up_to(f64::MAX).end, i64::MAX);
    }

    #[test]
    fn a_hundred_million_steps_lose_no_tick() {
        let mut clock = SampleClock::new(1e-4, 0.0);
        for k in 0..100_000_000 {
            assert_eq!(clock.advance(1e-4), k..k + 1);
        }
    }

    #[test]
    fn a_rounded_step_size_takes_no_tick_early_for_an_hour() {
        // A third of a millisecond, given with twelve digits: after an hour the sum is 3.6 ns ahead.
        let mut clock = SampleClock::new(1e-3, 0.0);
        for step in 1..=10_800_000i64 {
            clock.advance(0.000_333_333_333_334);
            assert_eq!(clock.next, (step + 2) / 3, "step {step}");
        }
    }

    #[test]
    fn sixtieths_of_a_second_meet_every_tick() {
        let mut clock = SampleClock::new(1e-3, 0.0);
        let mut ticks = 0;
        for step in 1..=6_000_000i64 {
            ticks += clock.advance(1.0 / 60.0).count() as i64;
            // Ticks 0, 1, ... below step/60 s: ceil(1000 step / 60) in integers.
            assert_eq!(ticks, (1000 * step + 59) / 60);
        }
    }

    proptest! {
        #[test]
        fn rounding_noise_changes_nothing(
            noise in prop::collection::vec(-3i64..=3, 2000), ratio in 0.01..7.3f64, steps_per_period in 1u32..10,
        ) {
            // Both an arbitrary ratio and steps that divide the period exactly.
            for step in [1e-3 * ratio, 1e-3 / f64::from(steps_per_period)] {
                let (mut plain, mut noisy) = (SampleClock::new(1e-3, 0.0), SampleClock::new(1e-3, 0.0));
                for ulps in &noise {
                    let jittered = f64::from_bits(step.to_bits().wrapping_add_signed(*ulps));
                    prop_assert_eq!(plain.advance(step), noisy.advance(jittered));
                }
            }
        }
    }
}
