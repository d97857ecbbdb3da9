//! Event mode, which model exchange and co-simulation share.

use super::ticking::{ClockStates, sampled};
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
            Interface::ModelExchange | Interface::CoSimulationWithEvents { .. } => {}
            Interface::CoSimulation | Interface::ScheduledExecution => {
                return Err(CallError::NotOffered("event mode, which the instance was not made for"));
            }
        }
        self.phase = Phase::EventMode;
        Ok(())
    }

    /// Discrete transitions. Those of model exchange are settled by one call; its time events are readings of a sensor. In
    /// co-simulation the tick that is due is run, if there is one, and another iteration shows its results.
    pub(super) fn update_discrete_states(&mut self) -> Result<EventEnd, CallError> {
        if self.interface == Interface::ModelExchange {
            return self.update_states_of_integration();
        }
        let unit = sampled(&mut *self.unit)?;
        let is_due = unit.clock().is_due();
        if is_due {
            let time = unit.clock_mut().take();
            unit.tick(time, &mut self.logger);
        }
        let next_event_time = Some(unit.clock().next_time());
        self.clocks = ClockStates { has_ticked: is_due, ..ClockStates::default() };
        Ok(EventEnd { is_unfinished: is_due, have_states_changed: false, next_event_time })
    }

    pub(super) fn enter_step_mode(&mut self) -> Result<(), CallError> {
        if self.interface == Interface::ModelExchange {
            return Err(CallError::WrongInterface(self.interface.name()));
        }
        self.clocks = ClockStates::default();
        self.phase = Phase::StepMode;
        Ok(())
    }
}
