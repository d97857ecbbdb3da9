//! What the standards derive from a variable's causality and variability.

use crate::unit::Description;
use crate::unit::variable::{Causality, Kind, Variability, Variable};

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

/// A value of a variable in XML, with all its digits.
pub fn literal(kind: Kind, value: f64) -> String {
    match kind {
        Kind::Real(_) => format!("{value:?}"),
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

/// Value references of all outputs and calculated parameters, which are unknown until the unit is initialised,
/// each with those of the variables it follows from, in ascending order. Local variables are not listed unless
/// they are continuous states or derivatives, which these units do not expose.
pub fn initial_unknowns(description: &Description) -> impl Iterator<Item = (usize, Vec<usize>)> {
    let is_unknown =
        |row: &Variable| matches!(row.causality, Causality::Output | Causality::CalculatedParameter);
    let variables = description.variables.iter().enumerate();
    variables.filter(move |(_, variable)| is_unknown(variable)).map(|(index, variable)| {
        let sources = variable.initially_from.iter().filter_map(|name| description.find(name));
        let mut references: Vec<usize> = sources.map(|(reference, _)| reference).collect();
        references.sort_unstable();
        (index, references)
    })
}

/// A list in an attribute.
pub fn joined(references: &[usize]) -> String {
    references.iter().map(usize::to_string).collect::<Vec<_>>().join(" ")
}

/// The attribute `dependenciesKind` for `count` dependencies without particular structure.
pub fn dependencies_kind(count: usize) -> Option<String> {
    (count > 0).then(|| vec!["dependent"; count].join(" "))
}
