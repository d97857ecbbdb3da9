//! Model exchange: the importer integrates the states, the instance evaluates derivatives and event indicators.

use super::{CallError, CommunicationPoint, Instance, Interface, Phase};
use crate::unit::continuous::nominal;
use crate::unit::value::{ValueError, is_finite};
use crate::unit::{ContinuousUnit, TIME};

impl Instance {
    /// Refuses functions that belong to model exchange alone on instances that were made for something else.
    pub(super) fn require_model_exchange(&self) -> Result<(), CallError> {
        match self.interface {
            Interface::ModelExchange => Ok(()),
            other => Err(CallError::WrongInterface(other.name())),
        }
    }

    /// The unit of a model-exchange instance.
    fn exchanged(&mut self) -> Result<&mut dyn ContinuousUnit, CallError> {
        self.require_model_exchange()?;
        self.unit.continuous().ok_or(CallError::NotOffered("the unit has no continuous states"))
    }

    /// Readings are taken with the inputs that the importer set last, the left limit at the event.
    pub(super) fn enter_event_of_integration(&mut self) -> Result<(), CallError> {
        let comes_from_continuous_time = self.phase == Phase::ContinuousTimeMode;
        let unit = self.exchanged()?;
        if comes_from_continuous_time {
            unit.enter_event();
        }
        Ok(())
    }

    /// Discrete transitions; whether a continuous state jumped. One call settles them all.
    pub(super) fn update_states_of_integration(&mut self) -> Result<bool, CallError> {
        let have_states_changed = self.exchanged()?.update_discrete_states();
        self.needs_evaluation = true;
        Ok(have_states_changed)
    }

    pub(super) fn enter_continuous_time_mode(&mut self) -> Result<(), CallError> {
        self.require_model_exchange()?;
        self.phase = Phase::ContinuousTimeMode;
        Ok(())
    }

    /// Nothing depends on time but through the inputs, so any finite time will do.
    pub(super) fn set_time(&mut self, time: f64) -> Result<(), CallError> {
        self.require_model_exchange()?;
        if !time.is_finite() {
            let expected = "a finite time";
            return Err(CallError::WrongTime { argument: "time", value: time, expected });
        }
        self.unit.values_mut()[TIME] = time;
        self.communication = CommunicationPoint::new(time);
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
        let values = self.unit.values_mut();
        for (row, value) in rows.states().iter().zip(states) {
            values[*row] = *value;
        }
        self.needs_evaluation = true;
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
            *target = nominal(self.unit.description(), *row);
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
        rows.iter().try_for_each(|row| self.require_computed(*row))?;
        for (target, row) in target.iter_mut().zip(rows) {
            *target = self.unit.values()[*row];
        }
        Ok(())
    }

    /// Refuses a value that overflowed.
    #[inline]
    pub(super) fn require_computed(&self, row: usize) -> Result<(), CallError> {
        let value = self.unit.values()[row];
        if is_finite(value) {
            return Ok(());
        }
        let variable = &self.variables[row];
        Err(CallError::NotComputable { name: variable.name, value, unit: variable.unit() })
    }
}

fn require_count(argument: &'static str, got: usize, expected: usize) -> Result<(), CallError> {
    if got == expected { Ok(()) } else { Err(CallError::WrongCount { argument, got, expected }) }
}
