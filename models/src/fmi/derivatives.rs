//! Derivatives: directional and adjoint ones between variables, and those of inputs and outputs with respect to time.

use super::{CallError, Instance, Interface, Phase};
use crate::model::ContinuousModel;
use crate::model::continuous::{Stage, Tangents};
use crate::model::value::ValueError;
use crate::model::variable::{Causality, Kind, Variability, Variable};

/// What the sampled models answer: their outputs are held between ticks, so that at a communication point they depend on
/// no input, and every derivative would be zero.
const HELD: CallError = CallError::NotOffered("its outputs are held between ticks");

impl Instance {
    /// Sensitivity of each unknown when all knowns move along `seed`.
    pub(super) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), CallError> {
        let model = Differentiated::new(self, unknowns, knowns)?;
        let tangents = model.tangents(knowns.iter().copied().zip(seed.iter().copied()));
        let along_seed = |unknown: u32| tangents.of_value(unknown as usize);
        fill(unknowns, sensitivity, along_seed, "the derivative along the seed of", model.variables)
    }

    /// Sensitivity of the unknowns, weighted with `seed`, to each known.
    pub(super) fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), CallError> {
        let model = Differentiated::new(self, unknowns, knowns)?;
        let along_seed = |known: u32| {
            let tangents = model.tangents(core::iter::once((known, 1.0)));
            let terms = unknowns.iter().zip(seed);
            terms.map(|(unknown, seed)| tangents.of_value(*unknown as usize) * seed).sum()
        };
        fill(knowns, sensitivity, along_seed, "the derivative of the weighted unknowns by", model.variables)
    }

    /// First derivatives of outputs with respect to time at the end of the last step; 0 for outputs that are held.
    pub(super) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        derivatives: &mut [f64],
    ) -> Result<(), CallError> {
        self.require_co_simulation()?;
        for (reference, order) in references.iter().zip(orders) {
            let variable = self.find_real(*reference)?;
            if variable.causality != Causality::Output {
                return Err(wrong_role(variable, *reference, "an output"));
            }
            require_first_order(variable, *order)?;
        }
        self.evaluate();
        let (rows, variables) = (self.rows, self.variables);
        let model = self.model.continuous().ok_or(HELD)?;
        let slopes = model.output_slopes(&rows);
        let slope = |output: u32| slopes.of_value(output as usize);
        fill(references, derivatives, slope, "the derivative with respect to time of", variables)
    }

    /// First derivatives of inputs with respect to time, from the begin of the next step on.
    pub(super) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        derivatives: &[f64],
    ) -> Result<(), CallError> {
        self.require_co_simulation()?;
        for ((reference, order), derivative) in references.iter().zip(orders).zip(derivatives) {
            let variable = self.find_real(*reference)?;
            let is_continuous_input =
                variable.causality == Causality::Input && variable.variability == Variability::Continuous;
            if !is_continuous_input {
                return Err(wrong_role(variable, *reference, "a continuous input"));
            }
            require_first_order(variable, *order)?;
            if !derivative.is_finite() {
                let (name, value) = (variable.name, *derivative);
                return Err(ValueError::SlopeNotFinite { name, value, unit: variable.unit() }.into());
            }
        }
        let model = self.model.continuous().ok_or(HELD)?;
        for (reference, derivative) in references.iter().zip(derivatives) {
            model.set_input_slope(*reference as usize, *derivative);
        }
        Ok(())
    }

    /// Refuses functions that belong to co-simulation alone on instances that were made for something else.
    pub(super) fn require_co_simulation(&self) -> Result<(), CallError> {
        match self.interface {
            Interface::CoSimulation => Ok(()),
            other => Err(CallError::WrongInterface(other.name())),
        }
    }

    fn find_real(&self, reference: u32) -> Result<&'static Variable, CallError> {
        let Some(variable) = self.variables.get(reference as usize) else {
            return Err(CallError::UnknownReference { reference, largest: self.variables.len() - 1 });
        };
        match variable.kind {
            Kind::Real(_) => Ok(variable),
            _ => Err(wrong_role(variable, reference, "a real variable")),
        }
    }

    /// Whether the variable is computed from others at this stage.
    fn is_unknown(&self, reference: u32, variable: &Variable) -> bool {
        let row = reference as usize;
        let is_listed = self.rows.derivatives().contains(&row) || variable.causality == Causality::Output;
        is_listed || (self.is_initialising() && variable.causality == Causality::CalculatedParameter)
    }

    /// Whether the variable is given at this stage.
    fn is_known(&self, reference: u32, variable: &Variable) -> bool {
        match variable.causality {
            Causality::Input | Causality::Parameter | Causality::Independent => true,
            _ => !self.is_initialising() && self.rows.states().contains(&(reference as usize)),
        }
    }

    fn is_initialising(&self) -> bool {
        self.state.phase == Phase::InitializationMode
    }
}

/// A model whose unknowns and knowns have been checked.
struct Differentiated<'a> {
    model: &'a dyn ContinuousModel,
    variables: &'static [Variable],
    is_initialising: bool,
}

impl<'a> Differentiated<'a> {
    fn new(instance: &'a mut Instance, unknowns: &[u32], knowns: &[u32]) -> Result<Self, CallError> {
        if instance.model.continuous().is_none() {
            return Err(HELD);
        }
        for reference in unknowns {
            let variable = instance.find_real(*reference)?;
            if !instance.is_unknown(*reference, variable) {
                return Err(wrong_role(variable, *reference, "an unknown: an output or a state derivative"));
            }
        }
        for reference in knowns {
            let variable = instance.find_real(*reference)?;
            if !instance.is_known(*reference, variable) {
                return Err(wrong_role(variable, *reference, "a known: an input, a parameter or a state"));
            }
        }
        instance.refresh_before_first_step()?;
        instance.evaluate();
        let (is_initialising, variables) = (instance.is_initialising(), instance.variables);
        Ok(Self { model: instance.model.continuous().ok_or(HELD)?, variables, is_initialising })
    }

    /// How fast every value changes when `knowns` do so.
    fn tangents(&self, knowns: impl Iterator<Item = (u32, f64)>) -> Tangents {
        let stage = if self.is_initialising { Stage::Initialisation } else { Stage::Running };
        self.model.tangents(stage, &mut knowns.map(|(known, along)| (known as usize, along)))
    }
}

/// Writes the `derivative` of each of `references`, which the caller has checked; all of them or, if one is not finite, none.
fn fill(
    references: &[u32],
    target: &mut [f64],
    derivative: impl Fn(u32) -> f64,
    what: &'static str,
    variables: &[Variable],
) -> Result<(), CallError> {
    for reference in references {
        let value = derivative(*reference);
        if !value.is_finite() {
            return Err(CallError::NoDerivative { what, name: variables[*reference as usize].name, value });
        }
    }
    for (target, reference) in target.iter_mut().zip(references) {
        *target = derivative(*reference);
    }
    Ok(())
}

fn require_first_order(variable: &Variable, order: i32) -> Result<(), CallError> {
    if order == 1 { Ok(()) } else { Err(CallError::WrongOrder { name: variable.name, order }) }
}

fn wrong_role(variable: &Variable, reference: u32, expected: &'static str) -> CallError {
    let is = match (variable.causality, variable.kind) {
        (_, Kind::Integer | Kind::Boolean | Kind::Enumeration(_)) => "no real number",
        (Causality::Independent, _) => "the independent variable",
        (Causality::Parameter, _) => "a parameter",
        (Causality::CalculatedParameter, _) => "a calculated parameter",
        (Causality::Input, _) => "an input",
        (Causality::Output, _) => "an output",
        (Causality::Local, _) => "a local variable",
    };
    CallError::WrongRole { name: variable.name, reference, is, expected }
}
