//! Elements and attributes that are the same in FMI 2.0 and FMI 3.0.

use std::{io, ptr};

use super::roles::{self, Dependencies};
use crate::fmi::LOG_CATEGORIES;
use crate::model::quantity::{Enumeration, Quantity};
use crate::model::unit_of_measure::UnitOfMeasure;
use crate::model::variable::{Kind, Variable};
use crate::model::{Description, StartValues};
use crate::package::xml::{Attribute, Writer, attribute, element, empty_element, optional, real};

/// Quantities of some variables, each once, in the order of their first use.
pub fn quantities<'a>(variables: impl IntoIterator<Item = &'a Variable>) -> Vec<&'static Quantity> {
    distinct(variables.into_iter().filter_map(|variable| match variable.kind {
        Kind::Real(quantity) => Some(quantity),
        _ => None,
    }))
}

/// Units of measure of some variables, each once, in the order of their first use.
pub fn units_of_measure<'a>(
    variables: impl IntoIterator<Item = &'a Variable>,
) -> Vec<&'static UnitOfMeasure> {
    distinct(quantities(variables).into_iter().map(|quantity| quantity.unit))
}

/// Enumerations of a model's variables, each once, in the order of their first use.
pub fn enumerations(description: &Description) -> Vec<&'static Enumeration> {
    distinct(description.variables.iter().filter_map(|variable| match variable.kind {
        Kind::Enumeration(enumeration) => Some(enumeration),
        _ => None,
    }))
}

/// Each item once, in the order of first occurrence.
fn distinct<T>(items: impl Iterator<Item = &'static T>) -> Vec<&'static T> {
    let mut found: Vec<&'static T> = Vec::new();
    for item in items {
        if !found.iter().any(|known| ptr::eq(*known, item)) {
            found.push(item);
        }
    }
    found
}

/// `BaseUnit` of FMI and SSP: what is not as the schemas have it by default.
pub fn base_unit(writer: &mut Writer, name: &str, unit: &UnitOfMeasure) -> io::Result<()> {
    let exponents = unit.dimension.exponents().into_iter().filter(|(_, exponent)| *exponent != 0);
    let exponents = exponents.map(|(name, exponent)| attribute(name, exponent));
    let factor = (unit.factor != 1.0).then(|| real(unit.factor));
    let scale = optional("factor", factor).into_iter().chain(offset(unit.offset));
    empty_element(writer, name, exponents.chain(scale))
}

fn offset(offset: f64) -> Option<Attribute> {
    optional("offset", (offset != 0.0).then(|| real(offset)))
}

/// `UnitDefinitions` (FMI 2.0, section 2.2.2; FMI 3.0, section 2.4.3).
pub fn unit_definitions(writer: &mut Writer, description: &Description) -> io::Result<()> {
    element(writer, "UnitDefinitions", [], |writer| {
        units_of_measure(description.variables).into_iter().try_for_each(|unit| unit_definition(writer, unit))
    })
}

/// `Unit` with its exponents and its display unit.
fn unit_definition(writer: &mut Writer, unit: &UnitOfMeasure) -> io::Result<()> {
    element(writer, "Unit", [attribute("name", unit.name)], |writer| {
        base_unit(writer, "BaseUnit", unit)?;
        unit.display.iter().try_for_each(|display| {
            let attributes = [attribute("name", display.name), attribute("factor", real(display.factor))];
            empty_element(writer, "DisplayUnit", attributes.into_iter().chain(offset(display.offset)))
        })
    })
}

/// Attributes of the type that stands for a quantity (FMI 2.0, section 2.2.3; FMI 3.0, section 2.4.4).
pub fn quantity_attributes(quantity: &Quantity) -> impl Iterator<Item = Attribute> {
    let display_unit = quantity.unit.display.as_ref().map(|display| display.name);
    [attribute("quantity", quantity.name), attribute("unit", quantity.unit.name)]
        .into_iter()
        .chain(optional("displayUnit", display_unit))
        .chain([attribute("nominal", real(quantity.nominal))])
}

/// The `Item`s of an enumeration type, numbered from 1 (FMI 2.0, section 2.2.3; FMI 3.0, section 2.4.4).
pub fn items(writer: &mut Writer, enumeration: &Enumeration) -> io::Result<()> {
    (1..).zip(enumeration.items).try_for_each(|(value, (name, description))| {
        let attributes =
            [attribute("name", name), attribute("value", value), attribute("description", description)];
        empty_element(writer, "Item", attributes)
    })
}

/// `LogCategories` (FMI 2.0, section 2.2.4; FMI 3.0, section 2.4.5).
pub fn log_categories(writer: &mut Writer) -> io::Result<()> {
    element(writer, "LogCategories", [], |writer| {
        LOG_CATEGORIES.iter().try_for_each(|(name, description)| {
            let attributes =
                [attribute("name", name.to_string_lossy()), attribute("description", description)];
            empty_element(writer, "Category", attributes)
        })
    })
}

/// `DefaultExperiment` (FMI 2.0, section 2.2.5; FMI 3.0, section 2.4.6).
pub fn default_experiment(writer: &mut Writer, description: &Description) -> io::Result<()> {
    let attributes = [
        attribute("startTime", real(0.0)),
        attribute("stopTime", real(description.stop_time)),
        attribute("stepSize", real(description.step_size)),
    ];
    empty_element(writer, "DefaultExperiment", attributes)
}

/// Attributes of a variable of any type (FMI 2.0, section 2.2.7; FMI 3.0, section 2.4.7.4).
pub fn variable_attributes(value_reference: usize, variable: &Variable) -> impl Iterator<Item = Attribute> {
    let always = [
        attribute("name", variable.name),
        attribute("valueReference", value_reference),
        attribute("description", variable.description),
        attribute("causality", roles::causality(variable)),
        attribute("variability", roles::variability(variable)),
    ];
    always.into_iter().chain(optional("initial", roles::initial(variable)))
}

/// The attribute `declaredType`.
pub fn declared_type(variable: &Variable) -> Option<Attribute> {
    let name = match variable.kind {
        Kind::Real(quantity) => Some(quantity.name),
        Kind::Enumeration(enumeration) => Some(enumeration.name),
        Kind::Integer | Kind::Boolean => None,
    };
    optional("declaredType", name)
}

/// Attributes that belong to the type of a variable (FMI 2.0, section 2.2.7; FMI 3.0, section 2.4.7.5). Variables are
/// counted from `first`.
pub fn value_attributes(
    description: &Description,
    value_reference: usize,
    variable: &Variable,
    start_values: &StartValues,
    first: usize,
) -> impl Iterator<Item = Attribute> {
    let [minimum, maximum] = roles::range(variable);
    let state = roles::derivative_of(description, variable);
    let attributes = [
        optional("min", minimum),
        optional("max", maximum),
        optional("start", roles::start(variable, start_values.of(value_reference, variable))),
        optional("derivative", state.map(|state| first + state)),
        optional("reinit", roles::reinit(variable)),
    ];
    attributes.into_iter().flatten()
}

/// What an unknown of the model structure depends on (FMI 2.0, section 2.2.8; FMI 3.0, section 2.4.8). Variables are
/// counted from `first`.
pub fn dependency_attributes(dependencies: &Dependencies, first: usize) -> impl Iterator<Item = Attribute> {
    let list = attribute("dependencies", dependencies.list(first));
    [list].into_iter().chain(optional("dependenciesKind", dependencies.kind_list()))
}
