//! Reading and writing variables by value reference.

use super::floating_point::in_default_environment;
use super::model_exchange::require_computed;
use super::{CallError, FmiVersion, Instance, Phase};
use crate::model::LARGEST_TABLE;
use crate::model::variable::{Causality, Kind, Variability, Variable};

/// A data type of a standard: its name there and the kinds of variables it carries.
pub(super) struct DataType {
    pub name: &'static str,
    pub carries: fn(&Kind) -> bool,
    pub standard: FmiVersion,
}

/// Where both sides hold `f64`, reading and writing copies and compares bits, and computes nothing by itself: see
/// [`super::boundary::enter_to_copy`].
impl Instance {
    /// Copies the values of variables of one data type to `values`.
    #[inline]
    pub(super) fn get<T>(
        &mut self,
        data_type: &DataType,
        references: &[u32],
        values: &mut [T],
        convert: impl Fn(f64) -> T,
    ) -> Result<(), CallError> {
        self.refresh_before_first_step()?;
        self.evaluate();
        let source = self.model.values();
        for reference in references {
            require_computed(self.find(data_type, *reference)?, source[*reference as usize])?;
        }
        for (value, reference) in values.iter_mut().zip(references) {
            *value = convert(source[*reference as usize]);
        }
        Ok(())
    }

    /// Gives values to variables of one data type; all or, when one is refused, none.
    #[inline]
    pub(super) fn set<T: Copy>(
        &mut self,
        data_type: &DataType,
        references: &[u32],
        values: &[T],
        convert: impl Fn(T) -> f64,
    ) -> Result<(), CallError> {
        let mut parameters_changed = false;
        for (reference, value) in references.iter().zip(values) {
            let variable = self.find(data_type, *reference)?;
            self.require_settable(data_type.standard, *reference, variable)?;
            variable.check(convert(*value))?;
            parameters_changed |= variable.causality == Causality::Parameter;
        }
        if parameters_changed && !self.state.phase.is_before_first_step() {
            return self.tune(references.iter().zip(values).map(|(row, value)| (*row, convert(*value))));
        }
        let target = self.model.values_mut();
        for (reference, value) in references.iter().zip(values) {
            target[*reference as usize] = convert(*value);
        }
        if self.state.phase.is_before_first_step() {
            self.state.needs_initialisation = true;
        } else {
            self.state.needs_evaluation = true;
        }
        Ok(())
    }

    /// As [`Instance::get`] for a data type that no variable has: the first reference is refused.
    pub(super) fn get_absent<T>(
        &mut self,
        data_type: &DataType,
        references: &[u32],
        _values: &mut [T],
    ) -> Result<(), CallError> {
        self.refresh_before_first_step()?;
        self.refuse_all(data_type, references)
    }

    /// As [`Instance::set`] for a data type that no variable has: the first reference is refused.
    pub(super) fn set_absent<T>(
        &mut self,
        data_type: &DataType,
        references: &[u32],
        _values: &[T],
    ) -> Result<(), CallError> {
        self.refuse_all(data_type, references)
    }

    #[cold]
    fn refuse_all(&self, data_type: &DataType, references: &[u32]) -> Result<(), CallError> {
        references.iter().try_for_each(|reference| self.find(data_type, *reference).map(|_| ()))
    }

    /// Gives checked values to tunable parameters and perhaps inputs; all or, when the parameters do not fit together,
    /// none.
    fn tune(&mut self, assignments: impl Iterator<Item = (u32, f64)>) -> Result<(), CallError> {
        let mut before = [0.0; LARGEST_TABLE];
        let values = self.model.values_mut();
        let before = &mut before[..values.len()];
        before.copy_from_slice(values);
        for (reference, value) in assignments {
            values[reference as usize] = value;
        }
        let model = &mut self.model;
        let fit =
            in_default_environment(|| model.check_parameters().map(|()| model.apply_tunable_parameters()));
        if let Err(error) = fit {
            model.values_mut().copy_from_slice(before);
            return Err(error.into());
        }
        self.state.needs_evaluation = true;
        Ok(())
    }

    /// Calculated values follow parameters and inputs until the first step.
    #[inline]
    pub(super) fn refresh_before_first_step(&mut self) -> Result<(), CallError> {
        if self.state.needs_initialisation && self.state.phase.is_before_first_step() {
            self.refresh()?;
        }
        Ok(())
    }

    /// Why there is no variable with this value reference.
    #[cold]
    fn no_variable(&self, data_type: &DataType, reference: u32) -> CallError {
        if data_type.standard == FmiVersion::Two {
            return CallError::UnknownReference { reference, largest: self.variables.len() - 1 };
        }
        match self.clocks().find(|(known, _)| *known == reference as usize) {
            Some((_, clock)) => CallError::IsClock { name: clock.name, reference, asked: data_type.name },
            None => self.unknown_reference(reference),
        }
    }

    pub(super) fn unknown_reference(&self, reference: u32) -> CallError {
        let clocks = self.clocks().count();
        CallError::UnknownReference { reference, largest: self.variables.len() + clocks - 1 }
    }

    #[inline]
    fn find(&self, data_type: &DataType, reference: u32) -> Result<&'static Variable, CallError> {
        let Some(variable) = self.variables.get(reference as usize) else {
            return Err(self.no_variable(data_type, reference));
        };
        if (data_type.carries)(&variable.kind) {
            return Ok(variable);
        }
        Err(CallError::WrongType {
            name: variable.name,
            reference,
            is: match variable.kind {
                Kind::Real(_) => "a real variable",
                Kind::Integer => "an integer",
                Kind::Boolean => "a boolean",
                Kind::Enumeration(_) => "an enumeration",
            },
            asked: data_type.name,
        })
    }

    /// Whether the importer has been called back within a step and has not registered the variable (FMI 3.0.2, section
    /// 4.2.2).
    #[inline]
    fn is_unregistered(&self, reference: u32) -> bool {
        self.state.phase == Phase::IntermediateUpdateMode
            && !self.intermediate_update.is_some_and(|update| update.registered.contains(reference))
    }

    /// Continuous inputs, which importers set most, may always be set between steps.
    #[inline]
    fn require_settable(
        &self,
        standard: FmiVersion,
        reference: u32,
        variable: &Variable,
    ) -> Result<(), CallError> {
        let is_continuous_input =
            variable.causality == Causality::Input && variable.variability == Variability::Continuous;
        if is_continuous_input && self.state.phase != Phase::IntermediateUpdateMode {
            return Ok(());
        }
        self.require_settable_now(standard, reference, variable)
    }

    /// Before the first step parameters and inputs may be set, afterwards inputs and tunable parameters. An importer
    /// that integrates the model may set continuous inputs and states in continuous time, and by FMI 3.0 at an event also
    /// states that do not jump (section 2.3.5; not so FMI 2.0.5, table in section 3.2.3). Within a step registered
    /// continuous inputs may be set, too.
    #[inline(never)]
    fn require_settable_now(
        &self,
        standard: FmiVersion,
        reference: u32,
        variable: &Variable,
    ) -> Result<(), CallError> {
        let is_initial = self.state.phase.is_before_first_step();
        let is_continuous_time =
            matches!(self.state.phase, Phase::ContinuousTimeMode | Phase::IntermediateUpdateMode);
        let why = match (variable.causality, variable.variability) {
            (Causality::Input, Variability::Continuous) if !self.is_unregistered(reference) => return Ok(()),
            (Causality::Input, Variability::Continuous) => {
                "an input that requiredIntermediateVariables lacks"
            }
            (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) if !is_continuous_time => {
                return Ok(());
            }
            (Causality::Input, _) => "a discrete input",
            (Causality::Parameter, Variability::Tunable) => "a parameter",
            (Causality::Parameter, _) if is_initial => return Ok(()),
            (Causality::Parameter, _) => "a fixed parameter",
            (Causality::Independent, _) => "the independent variable",
            _ if self.rows.states().contains(&(reference as usize)) => match self.state.phase {
                Phase::ContinuousTimeMode => return Ok(()),
                Phase::EventMode if standard == FmiVersion::Three && !variable.is_reinitialised => {
                    return Ok(());
                }
                _ => "a continuous state",
            },
            _ => "calculated by the model",
        };
        Err(CallError::NotSettable { name: variable.name, why, phase: self.state.phase.name() })
    }
}
