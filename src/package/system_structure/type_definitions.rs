//! What the structure of a system and its parameter sets share (SSP 1.0.1 and 2.0, schema SystemStructureCommon).

use std::io;

use super::form::SystemForm;
use crate::model::variable::{Kind, Variable};
use crate::package::model_description::{base_unit, literal, units_of_measure};
use crate::package::xml::{Writer, attribute, element, empty_element, optional};

/// Namespace of the elements with the prefix `ssc`.
pub const NAMESPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";

/// The element that tells the data type of a connector or parameter, such as `ssc:Real`, if it has any; a parameter
/// has its `value` there.
pub fn data_type(
    writer: &mut Writer,
    prefix: &str,
    variable: &Variable,
    value: Option<f64>,
    form: SystemForm,
) -> io::Result<()> {
    let Some(name) = form.data_type(variable.kind) else { return Ok(()) };
    let unit = match variable.kind {
        Kind::Real(quantity) => Some(quantity.unit.name),
        _ => None,
    };
    let value = value.map(|value| literal(variable.kind, value));
    let attributes = optional("value", value).into_iter().chain(optional("unit", unit));
    empty_element(writer, &format!("{prefix}:{name}"), attributes)
}

/// The units of measure of some variables.
pub fn units<'a>(
    writer: &mut Writer,
    name: &str,
    variables: impl Iterator<Item = &'a Variable>,
) -> io::Result<()> {
    element(writer, name, [], |writer| {
        units_of_measure(variables).into_iter().try_for_each(|unit| {
            element(writer, "ssc:Unit", [attribute("name", unit.name)], |writer| {
                base_unit(writer, "ssc:BaseUnit", unit)
            })
        })
    })
}
