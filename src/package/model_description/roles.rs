//! What the standards derive from a variable's causality and variability.

use crate::model::structure::DependencyKind;
use crate::model::variable::{Causality, Kind, Variability, Variable};
use crate::model::{Description, Edition};
use crate::package::xml::real;
use crate::package::{Capabilities, dependencies};

/// The attribute `causality`.
pub fn causality(variable: &Variable) -> &'static str {
    match variable.causality {
        Causality::Independent => "independent",
        Causality::Parameter => "parameter",
        Causality::CalculatedParameter => "calculatedParameter",
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::Local => "local",
    }
}

/// The attribute `variability`.
pub fn variability(variable: &Variable) -> &'static str {
    match variable.variability {
        Variability::Fixed => "fixed",
        Variability::Tunable => "tunable",
        Variability::Discrete => "discrete",
        Variability::Continuous => "continuous",
    }
}

/// The attribute `initial`; inputs and the independent variable must not have it.
pub fn initial(variable: &Variable) -> Option<&'static str> {
    match variable.causality {
        Causality::Independent | Causality::Input => None,
        Causality::Parameter => Some("exact"),
        Causality::CalculatedParameter | Causality::Output | Causality::Local => Some("calculated"),
    }
}

/// The attribute `start`: of what the importer may set, and of nothing else.
pub fn start(variable: &Variable, value: f64) -> Option<String> {
    (!variable.is_calculated()).then(|| literal(variable.kind, value))
}

/// The attributes `min` and `max`.
pub fn range(variable: &Variable) -> [Option<String>; 2] {
    let (minimum, maximum) = variable.range;
    [minimum, maximum].map(|bound| bound.is_finite().then(|| literal(variable.kind, bound)))
}

/// FMI 3.0, attribute `intermediateUpdate`: whether an importer may give the variable a value within a step. A sampled
/// model calls the importer back before each tick within a step, which then reads its continuous inputs.
pub fn may_be_set_within_a_step(description: &Description, variable: &Variable) -> bool {
    Capabilities::of(description, Edition::Plain).provides_intermediate_update
        && (variable.causality, variable.variability) == (Causality::Input, Variability::Continuous)
}

/// A value of a variable in XML, with all its digits.
pub fn literal(kind: Kind, value: f64) -> String {
    match kind {
        Kind::Real(_) => real(value),
        Kind::Boolean => (value != 0.0).to_string(),
        // Integers are written without a decimal point and items of an enumeration by their number.
        Kind::Integer | Kind::Enumeration(_) => format!("{value:.0}"),
    }
}

/// Value references of all outputs.
pub fn outputs(description: &Description) -> impl Iterator<Item = usize> {
    let is_output = |variable: &Variable| variable.causality == Causality::Output;
    description.variables.iter().enumerate().filter(move |(_, row)| is_output(row)).map(|(index, _)| index)
}

/// Value references of the derivatives of all continuous states; their order is that of the state vector.
pub fn derivatives(description: &Description) -> impl Iterator<Item = usize> {
    description.continuous_states().map(|(_, derivative)| derivative)
}

/// Value reference of the state whose derivative the variable is.
pub fn derivative_of(description: &Description, variable: &Variable) -> Option<usize> {
    description.find(variable.derivative_of?).map(|(state, _)| state)
}

/// The attribute `reinit` of a continuous state that may jump.
pub fn reinit(variable: &Variable) -> Option<bool> {
    variable.is_reinitialised.then_some(true)
}

/// What an unknown depends on: value references in ascending order, and how each enters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dependencies {
    pub references: Vec<usize>,
    pub kinds: Vec<&'static str>,
}

impl Dependencies {
    fn new(mut entries: Vec<(usize, &'static str)>) -> Self {
        entries.sort_unstable();
        let (references, kinds) = entries.into_iter().unzip();
        Self { references, kinds }
    }

    /// What the variable follows from at one instant after initialisation. Parameters are knowns of FMI 3.0 only.
    pub fn at_an_instant(description: &Description, reference: usize, with_parameters: bool) -> Self {
        let dependencies = dependencies(description).swap_remove(reference).at_an_instant;
        let entries = dependencies.into_iter().filter_map(|(known, kind)| {
            let kind = match kind {
                DependencyKind::Constant => "constant",
                DependencyKind::Fixed => "fixed",
                DependencyKind::Discrete => "discrete",
                DependencyKind::Dependent => "dependent",
            };
            let is_parameter = description.variables[known].causality == Causality::Parameter;
            (with_parameters || !is_parameter).then_some((known, kind))
        });
        Self::new(entries.collect())
    }

    /// What a variable follows from in initialisation mode.
    fn initial(references: Vec<usize>) -> Self {
        Self::new(references.into_iter().map(|reference| (reference, "dependent")).collect())
    }

    /// The attribute `dependencies`, counted from `offset`.
    pub fn list(&self, offset: usize) -> String {
        let numbers: Vec<String> =
            self.references.iter().map(|reference| (reference + offset).to_string()).collect();
        numbers.join(" ")
    }

    /// The attribute `dependenciesKind`.
    pub fn kind_list(&self) -> Option<String> {
        (!self.kinds.is_empty()).then(|| self.kinds.join(" "))
    }
}

/// Value references of all outputs, calculated parameters, continuous states and derivatives, which are unknown until
/// the model is initialised, with what each follows from. Other local variables are not listed.
pub fn initial_unknowns(description: &Description) -> impl Iterator<Item = (usize, Dependencies)> {
    let is_state = |index| description.continuous_states().any(|(state, _)| state == index);
    let variables = description.variables.iter().enumerate();
    let unknowns = variables.filter(move |(index, row)| {
        matches!(row.causality, Causality::Output | Causality::CalculatedParameter)
            || row.derivative_of.is_some()
            || is_state(*index)
    });
    let mut dependencies = dependencies(description);
    unknowns.map(move |(index, _)| {
        (index, Dependencies::initial(core::mem::take(&mut dependencies[index].initially)))
    })
}
