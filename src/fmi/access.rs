//! Reading and writing variables by value reference.

use super::floating_point::in_default_environment;
use super::{CallError, Instance, Phase};
use crate::unit::variable::{Causality, Kind, Variability, Variable};

/// A data type of a standard: its name there and the kinds of variables it carries.
pub(super) struct DataType {
    pub name: &'static str,
    pub carries: fn(&Kind) -> bool,
    /// Whether the standard has clocks, too.
    pub has_clocks: bool,
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
        for reference in references {
            self.find(data_type, *reference)?;
            self.require_computed(*reference as usize)?;
        }
        let source = self.unit.values();
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
            self.require_settable(*reference, variable)?;
            variable.check(convert(*value))?;
            parameters_changed |= variable.causality == Causality::Parameter;
        }
        let target = self.unit.values_mut();
        for (reference, value) in references.iter().zip(values) {
            target[*reference as usize] = convert(*value);
        }
        if matches!(self.phase, Phase::Instantiated | Phase::InitializationMode) {
            self.is_stale = true;
            return Ok(());
        }
        self.needs_evaluation = true;
        if parameters_changed {
            in_default_environment(|| self.unit.adopt_parameters());
        }
        Ok(())
    }

    /// Calculated values follow parameters and inputs until the first step.
    #[inline]
    pub(super) fn refresh_before_first_step(&mut self) -> Result<(), CallError> {
        if self.is_stale && matches!(self.phase, Phase::Instantiated | Phase::InitializationMode) {
            self.refresh()?;
        }
        Ok(())
    }

    /// Why there is no variable with this value reference.
    #[cold]
    fn no_variable(&self, data_type: &DataType, reference: u32) -> CallError {
        if !data_type.has_clocks {
            return CallError::UnknownReference { reference, largest: self.variables.len() - 1 };
        }
        let mut clocks = self.unit.description().clocks();
        match clocks.find(|(known, _)| *known == reference as usize) {
            Some((_, clock)) => CallError::IsClock { name: clock.name, reference, asked: data_type.name },
            None => self.unknown_reference(reference),
        }
    }

    pub(super) fn unknown_reference(&self, reference: u32) -> CallError {
        let clocks = self.unit.description().clocks().count();
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

    /// Before the first step parameters and inputs may be set, afterwards inputs and tunable parameters. An importer
    /// that integrates the unit may set continuous inputs and states in continuous time, and at an event also states
    /// that do not jump (FMI 3.0.2, section 2.3.5). Within a step continuous inputs may be set, too.
    #[inline]
    fn require_settable(&self, reference: u32, variable: &Variable) -> Result<(), CallError> {
        let is_initial = matches!(self.phase, Phase::Instantiated | Phase::InitializationMode);
        let is_continuous_time =
            matches!(self.phase, Phase::ContinuousTimeMode | Phase::IntermediateUpdateMode);
        let why = match (variable.causality, variable.variability) {
            (Causality::Input, Variability::Continuous) => return Ok(()),
            (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) if !is_continuous_time => {
                return Ok(());
            }
            (Causality::Input, _) => "a discrete input",
            (Causality::Parameter, Variability::Tunable) => "a parameter",
            (Causality::Parameter, _) if is_initial => return Ok(()),
            (Causality::Parameter, _) => "a fixed parameter",
            (Causality::Independent, _) => "the independent variable",
            _ if self.rows.states().contains(&(reference as usize)) => match self.phase {
                Phase::ContinuousTimeMode => return Ok(()),
                Phase::EventMode if !variable.is_reinitialised => return Ok(()),
                _ => "a continuous state",
            },
            _ => "calculated by the unit",
        };
        Err(CallError::NotSettable { name: variable.name, why, phase: self.phase.name() })
    }
}
