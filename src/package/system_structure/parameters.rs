//! Parameter sets (`*.ssv`; SSP 1.0.1 and 2.0, section 6): all numbers and truth values that may be changed, at their start
//! values.
//!
//! Enumerations are left out: of the importers at hand one ends the process and two fail on a set that has any.

use super::form::SystemForm;
use super::type_definitions::{self, data_type, units};
use crate::model::system::System;
use crate::model::variable::{Causality, Kind, Variable};
use crate::model::{Description, StartValues};
use crate::package::GenerationTime;
use crate::package::xml::{attribute, document, element, origin};

/// Namespace of the elements with the prefix `ssv`.
const NAMESPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// The document `ssv:ParameterSet` of a model.
pub fn parameter_set(
    system: &System,
    description: &Description,
    start_values: &StartValues,
    form: SystemForm,
    time: GenerationTime,
) -> String {
    let summary = format!("Parameters of {} at their start values", description.name);
    let attributes = [
        attribute("xmlns:ssv", NAMESPACE),
        attribute("xmlns:ssc", type_definitions::NAMESPACE),
        attribute("version", form.version()),
        // The same for both models: importers apply sets of one name together.
        attribute("name", system.name),
        attribute("description", summary),
    ];
    let parameters: Vec<(usize, &Variable)> =
        description.variables.iter().enumerate().filter(|(_, variable)| is_listed(variable)).collect();
    document("ssv:ParameterSet", attributes.into_iter().chain(origin(Some(time))), |writer| {
        element(writer, "ssv:Parameters", [], |writer| {
            parameters.iter().try_for_each(|&(reference, variable)| {
                let attributes =
                    [attribute("name", variable.name), attribute("description", variable.description)];
                let value = start_values.of(reference, variable);
                element(writer, "ssv:Parameter", attributes, |writer| {
                    data_type(writer, "ssv", variable, Some(value), form)
                })
            })
        })?;
        units(writer, "ssv:Units", parameters.iter().map(|(_, variable)| *variable))
    })
}

/// Whether the set tells the value of a variable.
fn is_listed(variable: &Variable) -> bool {
    variable.causality == Causality::Parameter && !matches!(variable.kind, Kind::Enumeration(_))
}
