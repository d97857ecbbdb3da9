//! A row of the variable table in words, for the documentation.

use crate::model::variable::{Causality, Kind, Variability, Variable};

/// What kind of variable it is, as a user thinks of it.
pub fn kind(variable: &Variable) -> &'static str {
    match (variable.causality, variable.variability) {
        (Causality::Independent, _) => "time",
        (Causality::Parameter, Variability::Tunable) => "tunable parameter",
        (Causality::Parameter, _) => "parameter",
        (Causality::CalculatedParameter, _) => "calculated parameter",
        (Causality::Input, _) => "input",
        (Causality::Output, _) => "output",
        (Causality::Local, _) => "local",
    }
}

/// Unit symbol, or the data type of a variable without one.
pub fn unit(variable: &Variable) -> &'static str {
    match variable.kind {
        Kind::Real(_) => variable.unit(),
        Kind::Integer => "integer",
        Kind::Boolean => "boolean",
        Kind::Enumeration(_) => "enumeration",
    }
}

/// Start value; empty if the model computes the variable.
pub fn start(variable: &Variable, number: f64) -> String {
    if variable.is_calculated() { String::new() } else { value(variable.kind, number) }
}

/// Smallest and largest value, as far as there are any.
pub fn range(variable: &Variable) -> String {
    let (minimum, maximum) = variable.range;
    let text = |bound| value(variable.kind, bound);
    match (minimum.is_finite(), maximum.is_finite()) {
        (true, true) => format!("{} to {}", text(minimum), text(maximum)),
        (true, false) => format!("at least {}", text(minimum)),
        (false, true) => format!("at most {}", text(maximum)),
        (false, false) => String::new(),
    }
}

/// A value as a person writes it.
fn value(kind: Kind, value: f64) -> String {
    match kind {
        Kind::Real(_) | Kind::Integer => {
            let text = if value.abs() >= 1e6 && value % 1e5 == 0.0 {
                format!("{value:e}")
            } else {
                format!("{value:?}")
            };
            text.trim_end_matches(".0").to_owned()
        }
        Kind::Boolean => (value != 0.0).to_string(),
        Kind::Enumeration(enumeration) => {
            enumeration.items.get(value as usize - 1).map_or("", |(name, _)| *name).to_owned()
        }
    }
}
