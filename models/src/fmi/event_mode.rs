//! Event mode, which model exchange and co-simulation share.

use super::earliest_time::EarliestTime;
use super::ticking::sampled;
use super::{CallError, Instance, Interface, Phase};

/// What an importer learns from the end of an event iteration.
pub(super) struct EventEnd {
    /// Another one is needed.
    pub is_unfinished: bool,
    /// A continuous state jumped.
    pub have_states_changed: bool,
    /// \[s\]
    pub next_event_time: Option<f64>,
}

impl Instance {
    pub(super) fn enter_event_mode(&mut self) -> Result<(), CallError> {
        match self.interface {
            Interface::ModelExchange => self.require_not_past_stop_time()?,
            Interface::CoSimulationWithEvents { .. } => {}
            Interface::CoSimulation | Interface::ScheduledExecution => {
                return Err(CallError::NotOffered("event mode, which the instance was not made for"));
            }
        }
        self.state.earliest_time = EarliestTime::at_event(self.state.communication.now());
        self.state.phase = Phase::EventMode;
        Ok(())
    }

    /// Discrete transitions. Those of model exchange are settled by one call; its time events are readings of a sensor. In
    /// co-simulation the tick is run whose clock is active, and another iteration shows its results.
    pub(super) fn update_discrete_states(&mut self) -> Result<EventEnd, CallError> {
        if self.interface == Interface::ModelExchange {
            return self.update_states_of_integration();
        }
        let is_active = core::mem::take(&mut self.state.clocks.is_tick_active);
        if is_active {
            self.run_due_tick()?;
        }
        let clock = sampled(&mut *self.model)?.clock();
        // A tick that is still due belongs to this event; the next one is that after it.
        let next = clock.next_number().saturating_add(i64::from(clock.is_due()));
        let next_event_time = Some(clock.time_of(next));
        Ok(EventEnd { is_unfinished: is_active, have_states_changed: false, next_event_time })
    }

    fn run_due_tick(&mut self) -> Result<(), CallError> {
        let model = sampled(&mut *self.model)?;
        if model.clock().is_due() {
            let time = model.clock_mut().take();
            model.tick(time, &mut self.logger);
        }
        Ok(())
    }

    pub(super) fn enter_step_mode(&mut self) -> Result<(), CallError> {
        if self.interface == Interface::ModelExchange {
            return Err(CallError::WrongInterface(self.interface.name()));
        }
        // Of an importer that knows no clocks, or left the event without another update.
        self.run_due_tick()?;
        self.state.clocks.is_tick_active = false;
        self.state.phase = Phase::StepMode;
        Ok(())
    }
}
