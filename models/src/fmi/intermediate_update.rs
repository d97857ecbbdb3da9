//! Intermediate update of FMI 3.0: a sampled model calls the importer back at each tick within a step.
//!
//! At the callback the tick is due and not yet run: the importer may set the continuous inputs as of that time, which
//! the tick then reads, or end the step there. The first tick of a step that starts at it needs no callback, its inputs
//! were just set. Plants make no steps of their own within a communication step and call nobody.
//!
//! A callback that does not come back, ended by an exception or a jump, leaves the step where it is: the importer frees or
//! resets the instance, or restores a state from before.

use super::fmi3::types::{fmi3InstanceEnvironment, fmi3IntermediateUpdateCallback};
use super::ticking::{StepEnd, sampled};
use super::{CallError, Instance, Interface, Phase};
use crate::model::TIME;
use crate::model::sample_clock::SampleClock;

/// What the importer gave at instantiation.
#[derive(Clone, Copy)]
pub(super) struct IntermediateUpdate {
    pub callback: fmi3IntermediateUpdateCallback,
    pub environment: fmi3InstanceEnvironment,
    /// The importer lets steps end early.
    pub may_return_early: bool,
    /// What it may set.
    pub registered: RegisteredVariables,
}

/// Variables that the importer named as `requiredIntermediateVariables`, by value reference.
#[derive(Clone, Copy, Default)]
pub(super) struct RegisteredVariables(u128);

impl RegisteredVariables {
    /// The references that stand for one of `count` variables, clocks among them; the first that does not is an error.
    pub fn new(references: &[u32], count: usize) -> Result<Self, CallError> {
        let largest = count.min(u128::BITS as usize) - 1;
        let mut rows = 0;
        for &reference in references {
            if reference as usize > largest {
                return Err(CallError::UnknownReference { reference, largest });
            }
            rows |= 1 << reference;
        }
        Ok(Self(rows))
    }

    pub fn contains(self, reference: u32) -> bool {
        1u128.checked_shl(reference).is_some_and(|row| self.0 & row != 0)
    }
}

/// A step with callbacks; times in s.
#[derive(Clone, Copy)]
pub(super) struct StepInProgress {
    /// Communication point at which the step is to end.
    end: f64,
    /// Duration that is left.
    rest: f64,
    /// Time of the callback.
    time: f64,
    /// The model's clock as it will be at the end; none once the end has been moved.
    final_clock: Option<SampleClock>,
}

/// How far a step has come.
pub(super) enum Progress {
    Done(StepEnd),
    /// The importer has to be called back at this time \[s\], and [`Instance::resume_step`] then.
    Waits(IntermediateUpdate, f64),
}

impl Instance {
    /// Begins a step from `point` over `step_size`, both in s.
    #[inline]
    pub(super) fn begin_step(&mut self, point: f64, step_size: f64) -> Result<Progress, CallError> {
        // With events, ticks end steps unless that is forbidden, and it is the importer who runs them.
        let ends_at_ticks = self.interface == Interface::CoSimulationWithEvents { may_return_early: true };
        match self.intermediate_update {
            Some(update) if !ends_at_ticks && self.model.sampled().is_some() => {
                self.begin_step_with_callbacks(update, point, step_size)
            }
            _ => self.step_to_event(point, step_size).map(Progress::Done),
        }
    }

    fn begin_step_with_callbacks(
        &mut self,
        update: IntermediateUpdate,
        point: f64,
        step_size: f64,
    ) -> Result<Progress, CallError> {
        let duration = self.state.communication.duration(point, step_size)?;
        let model = sampled(&mut *self.model)?;
        // Refuses what `Model::advance` would refuse; the ticks are counted one by one below.
        model.require_acceptable_step(duration)?;
        self.state.communication.begin_step(point, step_size, duration);
        let mut final_clock = *model.clock();
        final_clock.advance(duration);
        if model.clock().until_tick_within(duration) == Some(0.0) {
            let time = model.clock_mut().take();
            model.tick(time, &mut self.logger);
        }
        let end = point + step_size;
        let step = StepInProgress { end, rest: duration, time: point, final_clock: Some(final_clock) };
        self.go_on(update, step)
    }

    /// Goes on after a callback; the importer wants the step to end at `early_return` \[s\], if it does.
    pub(super) fn resume_step(&mut self, early_return: Option<f64>) -> Result<Progress, CallError> {
        let (Some(mut step), Some(update)) = (self.step.take(), self.intermediate_update) else {
            return Err(CallError::NotOffered("no step is in progress"));
        };
        self.state.phase = Phase::StepMode;
        let early_return = early_return.filter(|_| update.may_return_early);
        // Not a number counts as now.
        let early_return = early_return.map(|time| if time > step.time { time } else { step.time });
        if let Some(time) = early_return.filter(|time| *time < step.end) {
            step.rest = time - step.time;
            step.end = time;
            step.final_clock = None;
        }
        let model = sampled(&mut *self.model)?;
        // A tick at the end of the step belongs to the next one.
        if model.clock().until_tick_within(step.rest).is_some() {
            let time = model.clock_mut().take();
            model.tick(time, &mut self.logger);
        }
        self.go_on(update, step)
    }

    /// To the next tick within the step, or to its end.
    fn go_on(&mut self, update: IntermediateUpdate, mut step: StepInProgress) -> Result<Progress, CallError> {
        let model = sampled(&mut *self.model)?;
        let clock = model.clock_mut();
        if let Some(wait) = clock.until_tick_within(step.rest) {
            clock.pass(wait);
            step.rest -= wait;
            step.time = clock.next_time().max(step.time).min(step.end);
            self.model.values_mut()[TIME] = step.time;
            self.state.phase = Phase::IntermediateUpdateMode;
            self.step = Some(step);
            return Ok(Progress::Waits(update, step.time));
        }
        match &step.final_clock {
            // To the last digit where `Model::advance` would have left it.
            Some(final_clock) => {
                *clock = *final_clock;
                self.state.communication.move_to(step.end);
            }
            None => {
                clock.pass(step.rest);
                self.state.communication.move_to_time_of_clock(step.end, clock.time());
            }
        }
        let is_event = matches!(self.interface, Interface::CoSimulationWithEvents { .. }) && clock.is_due();
        self.model.values_mut()[TIME] = step.end;
        Ok(Progress::Done(StepEnd { is_event, is_early: step.final_clock.is_none() }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::MODELS;

    #[test]
    fn every_row_can_be_registered() {
        for model in MODELS {
            let count = model.description.variables.len();
            let all: Vec<u32> = (0..count as u32).collect();
            let registered = RegisteredVariables::new(&all, count).unwrap();
            assert!(
                all.iter().all(|reference| registered.contains(*reference)),
                "{}",
                model.description.name
            );
            assert!(!registered.contains(count as u32) && !registered.contains(u32::MAX));
            let refused = CallError::UnknownReference { reference: count as u32, largest: count - 1 };
            assert_eq!(RegisteredVariables::new(&[count as u32], count).err(), Some(refused));
        }
        assert!(!RegisteredVariables::default().contains(0));
    }
}
