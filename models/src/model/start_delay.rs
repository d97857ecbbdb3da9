//! The time at the start during which a controller lets its ticks pass.
//!
//! Masters that step all models at once hand the first values over after the first step, some of them zeros before. A
//! controller that ticks in that step takes them for measurements, and its observer for a motion.

use super::quantity::DURATION;
use super::variable::{Kind, Variable};
use serde::{Deserialize, Serialize};

/// Share of a period by which a tick may lie before the end of the delay and still mean it.
const TOLERANCE: f64 = 1e-4;

/// Name of the row.
pub const NAME: &str = "start_delay";

/// Row of the tables of all controllers.
pub const fn start_delay() -> Variable {
    Variable::parameter(NAME, Kind::Real(&DURATION), 0.0).range(0.0, 10.0).describe(
        "Time from the start during which ticks do nothing; set it to one communication step if the master passes \
         zeros before the first exchange",
    )
}

/// Which ticks pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartDelay {
    /// Time of the first tick that acts \[s\], or a little earlier
    acts_from: f64,
}

impl StartDelay {
    /// Of `delay` \[s\] from `start_time` \[s\], for ticks `period` \[s\] apart.
    pub fn new(start_time: f64, delay: f64, period: f64) -> Self {
        // Without one every tick acts, whatever rounding makes of its time.
        let acts_from = if delay > 0.0 { start_time + delay - TOLERANCE * period } else { f64::NEG_INFINITY };
        Self { acts_from }
    }

    /// Whether the tick at `time` \[s\] does nothing.
    #[inline]
    pub fn covers(self, time: f64) -> bool {
        time < self.acts_from
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_tick_at_the_end_acts() {
        let delay = StartDelay::new(0.1, 2e-3, 1e-3);
        assert_eq!([100, 101, 102].map(|k| delay.covers(f64::from(k) * 1e-3)), [true, true, false]);
    }

    proptest! {
        #[test]
        fn as_many_ticks_pass_as_fit_in(start in 0i32..100_000, ticks in 0i32..1000, period in 1e-6..1.0f64) {
            let start_time = f64::from(start) * period;
            let delay = StartDelay::new(start_time, f64::from(ticks) * period, period);
            let passing = (start..).take_while(|k| delay.covers(f64::from(*k) * period)).count();
            prop_assert_eq!(passing, ticks as usize);
        }
    }
}
