//! Who makes a sampled model tick: the model within its steps, the importer at events, or a scheduler ([`Interface`]).
//!
//! All three run the same ticks with the same inputs. Without events a tick at t reads the inputs that were set before
//! the step that starts at or before t. With events a step ends at the tick and the importer enters event mode. There
//! it is the importer who activates the clock `tick` (FMI 3.0.2, section 2.2.8): after `fmi3SetClock` the
//! `fmi3UpdateDiscreteStates` that follows runs the tick with the inputs of that moment, however many event iterations
//! went before, and asks for another one, in which the new outputs can be read. An importer that knows no clocks gets a
//! tick that is still due when it leaves event mode. The outputs follow from the state alone and never, at one instant,
//! from the inputs: a loop through a plant is no algebraic loop. The clock `ticked` is active while `tick` is.

use super::fraction::shift_from;
use super::{CallError, Instance, Interface, Phase};
use crate::model::sampled::{CLOCKS, SAMPLE_TIME, TICK, TICKED};
use crate::model::{Model, SampledModel, TIME};
use serde::{Deserialize, Serialize};

/// Clocks at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ClockStates {
    /// The importer has activated `tick` in this event iteration.
    pub is_tick_active: bool,
    /// A scheduled activation is yet to be told through `ticked`.
    pub is_activation_untold: bool,
    /// A model partition was activated before.
    pub was_activated: bool,
    /// Interval \[s\] of `tick` that the importer was told last, 0 if none.
    pub told_interval: f64,
}

/// When the clock `tick` ticks.
pub(super) struct Timing {
    /// \[s\]
    pub interval: f64,
    /// Time from the start to the first tick \[s\].
    pub shift: f64,
    /// The same as a fraction of seconds.
    pub shift_fraction: (u64, u64),
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
        let duration = self.state.communication.duration(point, step_size)?;
        let model = sampled(&mut *self.model)?;
        let mut is_early = false;
        match model.clock().until_tick_within(duration) {
            Some(wait) if may_return_early => {
                // However long the step that was asked for, the part up to the tick computes nothing.
                model.require_within_longest_step(wait)?;
                let clock = model.clock_mut();
                clock.pass(wait);
                if wait > 0.0 {
                    // The importer's time may be off by rounding; a step never goes back nor beyond its end.
                    let reached = clock.next_time().max(point).min(point + step_size);
                    self.state.communication.move_to_time_of_clock(reached, clock.time());
                } else {
                    self.state.communication.take_step(point, 0.0, 0.0);
                }
                is_early = self.state.communication.now() < point + step_size;
            }
            _ => {
                self.model.advance(duration, &mut self.logger)?;
                self.state.communication.take_step(point, step_size, duration);
            }
        }
        self.model.values_mut()[TIME] = self.state.communication.now();
        Ok(StepEnd { is_event: sampled(&mut *self.model)?.clock().is_due(), is_early })
    }

    /// Runs the tick that a scheduler calls for at `time` \[s\].
    pub(super) fn activate_model_partition(&mut self, clock: u32, time: f64) -> Result<(), CallError> {
        self.require_input_clock(clock)?;
        let now = self.state.communication.now();
        if !time.is_finite() || time < now || (time == now && self.state.clocks.was_activated) {
            return Err(CallError::ActivationTime { got: time, last: now });
        }
        let model = sampled(&mut *self.model)?;
        self.state.communication.require_before_stop_time("activationTime", time, model.clock().period())?;
        let tick_time = model.clock_mut().take_at(time);
        model.tick(tick_time, &mut self.logger);
        self.state.communication.move_to(time);
        self.model.values_mut()[TIME] = time;
        self.state.clocks.was_activated = true;
        self.state.clocks.is_activation_untold = true;
        Ok(())
    }

    /// The importer is told that `ticked` is active.
    pub(super) fn enter_clock_update_mode(&mut self) {
        self.state.phase = Phase::ClockUpdateMode;
    }

    /// Back from the importer, who may have asked for `ticked` or not.
    pub(super) fn leave_clock_update_mode(&mut self) {
        self.state.clocks.is_activation_untold = false;
        self.state.phase = Phase::ClockActivationMode;
    }

    /// Place of the clock with this value reference in the model's clocks.
    pub(super) fn find_clock(&self, reference: u32) -> Result<usize, CallError> {
        if let Some(variable) = self.variables.get(reference as usize) {
            return Err(CallError::NoClock { name: variable.name, reference });
        }
        let found = self.clocks().position(|(known, _)| known == reference as usize);
        found.ok_or_else(|| self.unknown_reference(reference))
    }

    /// Only `tick` is the importer's.
    fn require_input_clock(&self, reference: u32) -> Result<(), CallError> {
        match self.find_clock(reference)? {
            TICK => Ok(()),
            clock => Err(CallError::NoInputClock { name: CLOCKS[clock].name }),
        }
    }

    /// Activation states. In scheduled execution `ticked` tells of each activation once.
    pub(super) fn get_clocks(&mut self, references: &[u32], values: &mut [u8]) -> Result<(), CallError> {
        for reference in references {
            self.find_clock(*reference)?;
        }
        for (value, reference) in values.iter_mut().zip(references) {
            let is_untold = self.find_clock(*reference)? == TICKED
                && core::mem::take(&mut self.state.clocks.is_activation_untold);
            *value = (self.state.clocks.is_tick_active || is_untold).into();
        }
        Ok(())
    }

    /// Activates `tick` where a tick is due; [`Instance::update_discrete_states`] runs and deactivates it.
    pub(super) fn set_clocks(&mut self, references: &[u32], values: &[u8]) -> Result<(), CallError> {
        let mut is_tick_active = self.state.clocks.is_tick_active;
        for (reference, value) in references.iter().zip(values) {
            self.require_input_clock(*reference)?;
            let now = self.state.communication.now();
            let clock = sampled(&mut *self.model)?.clock();
            match (*value != 0, clock.is_due()) {
                (true, true) => is_tick_active = true,
                (true, false) => {
                    let (next, period) = (clock.next_time(), clock.period());
                    return Err(CallError::NoTick { now, next, period });
                }
                (false, _) if is_tick_active => return Err(CallError::ClockStaysActive),
                (false, _) => {}
            }
        }
        self.state.clocks.is_tick_active = is_tick_active;
        Ok(())
    }

    /// When an input clock ticks.
    pub(super) fn timing(&mut self, reference: u32) -> Result<Timing, CallError> {
        self.require_input_clock(reference)?;
        self.refresh_before_first_step()?;
        let start_time = self.state.start_time;
        let clock = sampled(&mut *self.model)?.clock();
        let interval = clock.period();
        let about = (clock.next_time() - start_time).max(0.0);
        let shift_fraction = shift_from(start_time, clock.next_number(), interval, about);
        let shift = shift_fraction.0 as f64 / shift_fraction.1 as f64;
        Ok(Timing { interval, shift, shift_fraction })
    }

    /// Lets the clock tick in intervals of so many seconds, by the parameter that says so.
    pub(super) fn set_intervals(
        &mut self,
        references: &[u32],
        intervals: impl Iterator<Item = f64> + Clone,
    ) -> Result<(), CallError> {
        // A model without clocks has no reference that passes.
        let sample_time = self.model.description().find(SAMPLE_TIME);
        for (reference, interval) in references.iter().zip(intervals.clone()) {
            self.require_input_clock(*reference)?;
            sample_time.map_or(Ok(()), |(_, variable)| variable.check(interval))?;
        }
        if let (Some((row, _)), Some(interval)) = (sample_time, intervals.last()) {
            self.model.values_mut()[row] = interval;
            self.state.needs_initialisation = true;
        }
        Ok(())
    }
}

pub(super) fn sampled(model: &mut dyn Model) -> Result<&mut dyn SampledModel, CallError> {
    model.sampled().ok_or(CallError::NotOffered("the model has no clocks"))
}
