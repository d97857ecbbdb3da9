//! Models that act at the ticks of a clock: what it takes to leave the ticks to somebody else.

use super::longest_step::check_step;
use super::sample_clock::SampleClock;
use super::work::{LARGEST_WORK, Load, require_affordable};
use super::{Description, Edition, LogSink, ModelError};

/// Intervals of a clock that any step may span, so that short steps need not be judged.
const ALWAYS_AFFORDABLE: f64 = 4.0;

/// Cost of a tick \[s\] with which those and one more are a step's [`LARGEST_WORK`]; no observer is dearer.
const LARGEST_COST: f64 = LARGEST_WORK / (ALWAYS_AFFORDABLE + 1.0);

/// A model whose ticks may be had one by one; [`super::Model::advance`] runs them by itself.
///
/// The ticks that are run are the same either way, and so is what they do: it follows from the inputs at a tick and
/// from what the ticks before have left behind, never from the steps in between.
pub trait SampledModel {
    fn clock(&self) -> &SampleClock;

    fn clock_mut(&mut self) -> &mut SampleClock;

    /// Reads the inputs and sets the outputs as at `time` \[s\]. The caller keeps the clock.
    fn tick(&mut self, time: f64, sink: &mut dyn LogSink);

    /// Longest step that is accepted \[s\], see [`super::longest_step`].
    fn longest_step(&self) -> f64;

    /// What a tick costs at most with the present parameters \[s\], see [`super::work`].
    fn cost_of_tick(&self) -> f64;

    /// Refuses a step over `duration` \[s\] that the loop would not bear or that would compute for too long.
    #[inline(always)]
    fn require_acceptable_step(&self, duration: f64) -> Result<(), ModelError> {
        // Nearly every step.
        if duration <= ALWAYS_AFFORDABLE * self.clock().period() && duration <= self.longest_step() {
            return Ok(());
        }
        self.require_acceptable_long_step(duration)
    }

    /// As [`Self::require_acceptable_step`], for every step.
    #[cold]
    fn require_acceptable_long_step(&self, duration: f64) -> Result<(), ModelError> {
        let interval = self.clock().period();
        if duration > ALWAYS_AFFORDABLE * interval {
            let cost = self.cost_of_tick().min(LARGEST_COST);
            match require_affordable(duration, [Load { cost, interval }]) {
                // The smaller limit is the one that will be accepted: that of the loop, below.
                Err(ModelError::StepTooLong { limit, .. }) if self.longest_step() < limit => {}
                affordable => affordable?,
            }
        }
        self.require_within_longest_step(duration)
    }

    /// Refuses a step over `duration` \[s\] that the loop would not bear.
    #[inline]
    fn require_within_longest_step(&self, duration: f64) -> Result<(), ModelError> {
        check_step(self.clock().time(), duration, self.longest_step())
    }
}

/// A clock that an importer can see. It holds no value and thus has no row in the table of values.
#[derive(Debug)]
pub struct ClockVariable {
    pub name: &'static str,
    pub description: &'static str,
    /// Whether the importer makes it tick, otherwise the model does.
    pub is_input: bool,
}

/// Every sampled model has these two, with the value references that follow those of its table.
///
/// No variable but `ticked` itself is bound to one of them (FMI 3.0: attribute `clocks`). Bound variables may be read at
/// a tick only, so that importers without events could not read the outputs at all; the outputs are states that hold
/// what the last tick has left, as they do in FMI 2.0.
pub static CLOCKS: [ClockVariable; 2] = [
    ClockVariable {
        name: "tick",
        description: "Ticks every sample_time, at multiples of it: runs observer and law",
        is_input: true,
    },
    ClockVariable { name: "ticked", description: "A tick has set the outputs anew", is_input: false },
];

/// Name of the parameter of every sampled model that is the interval of `tick`.
pub const SAMPLE_TIME: &str = "sample_time";

/// Places in [`CLOCKS`].
pub const TICK: usize = 0;
pub const TICKED: usize = 1;

impl Description {
    /// Clocks with their value references.
    pub fn clocks(&self) -> impl Iterator<Item = (usize, &'static ClockVariable)> + use<> {
        Edition::Clocked.clocks(self)
    }
}
