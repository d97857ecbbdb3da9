//! Who makes a sampled unit tick: the unit within its steps, the importer at events, or a scheduler ([`Interface`]).
//!
//! All three run the same ticks with the same inputs. Without events a tick at t reads the inputs that were set before
//! the step that starts at or before t. With events a step ends at the tick; the importer enters event mode, sets the
//! inputs, and `fmi3UpdateDiscreteStates` runs the tick. It then asks for another event iteration, in which the new
//! outputs can be read and the clock `ticked` is active. The outputs thus follow from the state alone and never, at
//! one instant, from the inputs: a loop through a plant is no algebraic loop.

use super::{CallError, CommunicationPoint, Instance, Interface, Phase};
use crate::unit::sampled::{CLOCKS, TICK, TICKED};
use crate::unit::{SampledUnit, TIME, Unit};
use serde::{Deserialize, Serialize};

/// Clocks at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ClockStates {
    /// The importer has activated `tick`.
    pub is_tick_set: bool,
    /// `ticked` is active.
    pub has_ticked: bool,
    /// A model partition was activated before.
    pub was_activated: bool,
}

/// What an importer learns from a step.
pub(super) struct StepEnd {
    /// A tick is due.
    pub is_event: bool,
    /// The step ends before the time asked for.
    pub is_early: bool,
}

impl Instance {
    /// One step from `point` over `step_size`, both in s, or up to the tick before its end.
    #[inline]
    pub(super) fn step_to_event(&mut self, point: f64, step_size: f64) -> Result<StepEnd, CallError> {
        let Interface::CoSimulationWithEvents { may_return_early } = self.interface else {
            self.do_step(point, step_size)?;
            return Ok(StepEnd { is_event: false, is_early: false });
        };
        let duration = self.communication.duration(point, step_size)?;
        let clock = sampled(&mut *self.unit)?.clock_mut();
        let mut is_early = false;
        match clock.until_tick_within(duration) {
            Some(wait) if may_return_early => {
                clock.pass(wait);
                // The importer's time may be off by rounding; a step never goes back nor beyond its end.
                let reached = clock.next_time().max(point).min(point + step_size);
                self.communication = CommunicationPoint::new(if wait > 0.0 { reached } else { point });
                is_early = self.communication.now() < point + step_size;
            }
            _ => {
                self.unit.advance(duration, &mut self.logger)?;
                self.communication.advance(point, step_size);
            }
        }
        self.unit.values_mut()[TIME] = self.communication.now();
        Ok(StepEnd { is_event: sampled(&mut *self.unit)?.clock().is_due(), is_early })
    }

    /// Runs the tick that a scheduler calls for at `time` \[s\].
    pub(super) fn activate_model_partition(&mut self, clock: u32, time: f64) -> Result<(), CallError> {
        if self.find_clock(clock)? != TICK {
            return Err(self.no_input_clock());
        }
        let now = self.communication.now();
        if !time.is_finite() || time < now || (time == now && self.clocks.was_activated) {
            return Err(CallError::ActivationTime { got: time, last: now });
        }
        let unit = sampled(&mut *self.unit)?;
        let tick_time = unit.clock_mut().take_at(time);
        unit.tick(tick_time, &mut self.logger);
        self.communication = CommunicationPoint::new(time);
        self.unit.values_mut()[TIME] = time;
        self.clocks.was_activated = true;
        self.clocks.has_ticked = true;
        Ok(())
    }

    /// The importer is told that `ticked` is active.
    pub(super) fn enter_clock_update_mode(&mut self) {
        self.phase = Phase::ClockUpdateMode;
    }

    /// Back from the importer, who may have asked for `ticked` or not.
    pub(super) fn leave_clock_update_mode(&mut self) {
        self.clocks.has_ticked = false;
        self.phase = Phase::ClockActivationMode;
    }

    /// Place of the clock with this value reference in the unit's clocks.
    pub(super) fn find_clock(&self, reference: u32) -> Result<usize, CallError> {
        if let Some(variable) = self.variables.get(reference as usize) {
            return Err(CallError::NoClock { name: variable.name, reference });
        }
        let found = self.clocks().position(|(known, _)| known == reference as usize);
        found.ok_or_else(|| self.unknown_reference(reference))
    }

    fn no_input_clock(&self) -> CallError {
        let why = "a clock that the unit itself activates";
        CallError::NotSettable { name: CLOCKS[TICKED].name, why, phase: self.phase.name() }
    }

    /// Activation states. In scheduled execution `ticked` tells of each tick once.
    pub(super) fn get_clocks(&mut self, references: &[u32], values: &mut [u8]) -> Result<(), CallError> {
        for reference in references {
            self.find_clock(*reference)?;
        }
        for (value, reference) in values.iter_mut().zip(references) {
            *value = match self.find_clock(*reference)? {
                TICK => self.clocks.is_tick_set.into(),
                _ => self.clocks.has_ticked.into(),
            };
        }
        if self.interface == Interface::ScheduledExecution && !references.is_empty() {
            self.clocks.has_ticked = false;
        }
        Ok(())
    }

    /// Activates `tick` where a tick is due, which happens then in any case: an importer that knows nothing of clocks
    /// gets the same ticks. A tick that has been run at this instant stays run.
    pub(super) fn set_clocks(&mut self, references: &[u32], values: &[u8]) -> Result<(), CallError> {
        let has_ticked = self.clocks.has_ticked;
        let mut is_tick_set = self.clocks.is_tick_set;
        for (reference, value) in references.iter().zip(values) {
            if self.find_clock(*reference)? != TICK {
                return Err(self.no_input_clock());
            }
            let now = self.communication.now();
            let unit = sampled(&mut *self.unit)?;
            match (*value != 0, unit.clock().is_due() || has_ticked) {
                (true, true) => is_tick_set = true,
                (true, false) => {
                    return Err(CallError::NoTick { now, next: unit.clock().next_time() });
                }
                (false, _) if is_tick_set => return Err(CallError::ClockStaysActive),
                (false, _) => {}
            }
        }
        self.clocks.is_tick_set = is_tick_set;
        Ok(())
    }

    /// Interval \[s\] of an input clock, and the time from the start to its first tick \[s\].
    pub(super) fn interval_and_shift(&mut self, reference: u32) -> Result<(f64, f64), CallError> {
        if self.find_clock(reference)? != TICK {
            return Err(self.no_input_clock());
        }
        self.refresh_before_first_step()?;
        let start_time = self.start_time;
        let clock = sampled(&mut *self.unit)?.clock();
        Ok((clock.period(), (clock.next_time() - start_time).max(0.0)))
    }
}

pub(super) fn sampled(unit: &mut dyn Unit) -> Result<&mut dyn SampledUnit, CallError> {
    unit.sampled().ok_or(CallError::NotOffered("the unit has no clocks"))
}
