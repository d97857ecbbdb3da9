//! Model exchange: the importer integrates the states, the instance evaluates derivatives and event indicators.

use super::event_mode::EventEnd;
use super::{CallError, Instance, Interface, Phase};
use crate::model::continuous::nominal;
use crate::model::value::{ValueError, is_finite};
use crate::model::variable::Variable;
use crate::model::{ContinuousModel, TIME};

impl Instance {
    /// Refuses functions that belong to model exchange alone on instances that were made for something else.
    pub(super) fn require_model_exchange(&self) -> Result<(), CallError> {
        match self.interface {
            Interface::ModelExchange => Ok(()),
            other => Err(CallError::WrongInterface(other.name())),
        }
    }

    /// What an instance for model exchange integrates.
    fn exchanged(&mut self) -> Result<&mut dyn ContinuousModel, CallError> {
        self.require_model_exchange()?;
        self.model.continuous().ok_or(CallError::NotOffered("the model has no continuous states"))
    }

    /// Discrete transitions; one call settles them all.
    pub(super) fn update_states_of_integration(&mut self) -> Result<EventEnd, CallError> {
        let model = self.exchanged()?;
        let have_states_changed = model.update_discrete_states();
        let next_event_time = model.next_event_time();
        self.state.needs_evaluation = true;
        Ok(EventEnd { is_unfinished: false, have_states_changed, next_event_time })
    }

    pub(super) fn enter_continuous_time_mode(&mut self) -> Result<(), CallError> {
        self.require_model_exchange()?;
        self.state.phase = Phase::ContinuousTimeMode;
        Ok(())
    }

    /// The solver accepts where it is. No model has step events.
    pub(super) fn complete_integrator_step(&mut self) -> Result<(), CallError> {
        self.require_model_exchange()?;
        self.require_not_past_stop_time()?;
        self.state.earliest_time.completed_step(self.state.communication.now());
        Ok(())
    }

    /// Solvers look past the stop time, since they interpolate back from there; to stay there is an error.
    pub(super) fn require_not_past_stop_time(&self) -> Result<(), CallError> {
        let now = self.state.communication.now();
        let last = self.state.earliest_time.last_completed();
        if now <= last {
            // What lies as far was accepted before, when the way that led there was known.
            return Ok(());
        }
        self.state.communication.require_before_stop_time("time", now, now - last)
    }

    /// Nothing depends on time but through the inputs.
    pub(super) fn set_time(&mut self, time: f64) -> Result<(), CallError> {
        self.require_model_exchange()?;
        if !time.is_finite() {
            let expected = "a finite time";
            return Err(CallError::WrongTime { argument: "time", value: time, expected });
        }
        self.state.earliest_time.check(time)?;
        self.model.values_mut()[TIME] = time;
        self.state.communication.move_to(time);
        Ok(())
    }

    pub(super) fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), CallError> {
        self.require_model_exchange()?;
        let rows = self.rows;
        require_count("nx", states.len(), rows.states().len())?;
        for (row, value) in rows.states().iter().zip(states) {
            if !value.is_finite() {
                let variable = &self.variables[*row];
                let (name, unit) = (variable.name, variable.unit());
                return Err(CallError::StateRejected(ValueError::NotFinite { name, value: *value, unit }));
            }
        }
        let values = self.model.values_mut();
        for (row, value) in rows.states().iter().zip(states) {
            values[*row] = *value;
        }
        self.state.needs_evaluation = true;
        Ok(())
    }

    pub(super) fn get_continuous_states(&mut self, states: &mut [f64]) -> Result<(), CallError> {
        let rows = self.rows;
        self.copy_rows("nx", rows.states(), states)
    }

    pub(super) fn get_derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), CallError> {
        let rows = self.rows;
        self.copy_rows("nx", rows.derivatives(), derivatives)
    }

    pub(super) fn get_event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), CallError> {
        let rows = self.rows;
        self.copy_rows("ni", rows.event_indicators(), indicators)
    }

    pub(super) fn get_nominals(&mut self, nominals: &mut [f64]) -> Result<(), CallError> {
        self.require_model_exchange()?;
        let rows = self.rows;
        require_count("nx", nominals.len(), rows.states().len())?;
        for (target, row) in nominals.iter_mut().zip(rows.states()) {
            *target = nominal(self.model.description(), *row);
        }
        Ok(())
    }

    /// Copies the values of `rows` to `target` as they are at this instant; all of them or none.
    fn copy_rows(
        &mut self,
        argument: &'static str,
        rows: &[usize],
        target: &mut [f64],
    ) -> Result<(), CallError> {
        self.require_model_exchange()?;
        require_count(argument, target.len(), rows.len())?;
        self.refresh_before_first_step()?;
        self.evaluate();
        let source = self.model.values();
        for row in rows {
            require_computed(&self.variables[*row], source[*row])?;
        }
        for (target, row) in target.iter_mut().zip(rows) {
            *target = source[*row];
        }
        Ok(())
    }
}

/// Refuses a value that overflowed.
#[inline]
pub(super) fn require_computed(variable: &Variable, value: f64) -> Result<(), CallError> {
    if is_finite(value) {
        return Ok(());
    }
    Err(CallError::NotComputable { name: variable.name, value, unit: variable.unit() })
}

fn require_count(argument: &'static str, got: usize, expected: usize) -> Result<(), CallError> {
    if got == expected { Ok(()) } else { Err(CallError::WrongCount { argument, got, expected }) }
}
