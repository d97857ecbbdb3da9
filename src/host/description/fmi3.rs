//! The XML schema of FMI 3.0, as far as co-simulation needs it.

use std::collections::HashMap;
use std::sync::Arc;

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::host::error::{HostError, Result};

use super::attributes::{self, Experiment, Item};
use super::document::read;
use super::elements::{Known, known};
use super::model_description::{CoSimulation, ModelDescription};
use crate::fmi::FmiVersion;
use crate::host::variable::{Kind, Storage, Variability, Variable};

#[derive(Deserialize)]
struct Document {
    #[serde(rename = "@modelName")]
    model_name: String,
    #[serde(rename = "@instantiationToken")]
    instantiation_token: String,
    #[serde(rename = "CoSimulation")]
    co_simulation: Option<Interface>,
    #[serde(rename = "TypeDefinitions")]
    types: Option<Types>,
    #[serde(rename = "DefaultExperiment", default)]
    experiment: Experiment,
    #[serde(rename = "ModelVariables")]
    variables: Variables,
}

#[derive(Deserialize)]
struct Interface {
    #[serde(rename = "@modelIdentifier")]
    model_identifier: String,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    variable_step: Option<String>,
    #[serde(rename = "@fixedInternalStepSize")]
    internal_step: Option<String>,
    #[serde(rename = "@canGetAndSetFMUState")]
    state: Option<String>,
    #[serde(rename = "@hasEventMode")]
    event_mode: Option<String>,
    #[serde(rename = "@needsExecutionTool")]
    tool: Option<String>,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    only_once: Option<String>,
}

#[derive(Deserialize)]
struct Types {
    #[serde(rename = "$value", default, deserialize_with = "known")]
    all: Vec<TypeElement>,
}

#[derive(Deserialize)]
enum TypeElement {
    #[serde(rename = "Float64Type", alias = "Float32Type")]
    Float(FloatType),
    #[serde(rename = "EnumerationType")]
    Enumeration(EnumerationType),
    /// Types that carry neither a unit nor items.
    #[serde(other)]
    Other,
}

#[derive(Deserialize)]
struct FloatType {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@unit")]
    unit: Option<String>,
}

#[derive(Deserialize)]
struct EnumerationType {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "Item", default)]
    items: Vec<Item>,
}

#[derive(Deserialize)]
struct Variables {
    #[serde(rename = "$value", default, deserialize_with = "known")]
    all: Vec<VariableElement>,
}

#[derive(Deserialize)]
enum VariableElement {
    Float64(Attributes),
    Float32(Attributes),
    Int8(Attributes),
    UInt8(Attributes),
    Int16(Attributes),
    UInt16(Attributes),
    Int32(Attributes),
    UInt32(Attributes),
    Int64(Attributes),
    UInt64(Attributes),
    Boolean(Attributes),
    String(Attributes),
    Enumeration(Attributes),
    Binary(Attributes),
    Clock(Attributes),
    /// Whatever a later edition adds.
    #[serde(other)]
    Unknown,
}

impl Known for TypeElement {
    fn is_known(&self) -> bool {
        !matches!(self, Self::Other)
    }
}

impl Known for VariableElement {
    fn is_known(&self) -> bool {
        !matches!(self, Self::Unknown)
    }
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@valueReference")]
    value_reference: String,
    #[serde(rename = "@description")]
    description: Option<String>,
    #[serde(rename = "@causality")]
    causality: Option<String>,
    #[serde(rename = "@variability")]
    variability: Option<String>,
    #[serde(rename = "@start")]
    start: Option<String>,
    #[serde(rename = "@unit")]
    unit: Option<String>,
    #[serde(rename = "@declaredType")]
    declared_type: Option<String>,
    #[serde(rename = "Dimension", default)]
    dimensions: Vec<IgnoredAny>,
    #[serde(rename = "Start", default)]
    start_elements: Vec<StartElement>,
    #[serde(rename = "Alias", default)]
    aliases: Vec<Alias>,
}

/// Strings and binaries have their start values in elements.
#[derive(Deserialize)]
struct StartElement {
    #[serde(rename = "@value")]
    value: String,
}

#[derive(Deserialize)]
struct Alias {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@description")]
    description: Option<String>,
}

pub(super) fn parse(xml: &str) -> Result<ModelDescription> {
    let document: Document = read(xml)?;
    let mut type_units = HashMap::new();
    let mut enumerations = HashMap::new();
    for element in document.types.map(|types| types.all).unwrap_or_default() {
        match element {
            TypeElement::Float(FloatType { name, unit: Some(unit) }) => {
                type_units.insert(name, Arc::from(unit));
            }
            TypeElement::Enumeration(EnumerationType { name, items }) => {
                let items = attributes::items(&name, items)?;
                enumerations.insert(name, items);
            }
            TypeElement::Float(_) | TypeElement::Other => {}
        }
    }
    let mut variables = Vec::with_capacity(document.variables.all.len());
    let mut seen = HashMap::new();
    for element in document.variables.all {
        let start = variables.len();
        append(element, &type_units, &mut variables)?;
        check_reference(&variables, start, &mut seen)?;
    }
    Ok(ModelDescription {
        fmi_version: FmiVersion::Three,
        model_name: document.model_name,
        instantiation_token: document.instantiation_token,
        co_simulation: document.co_simulation.map(co_simulation).transpose()?,
        variables,
        default_experiment: document.experiment.read()?,
        enumerations,
        index: HashMap::new(),
    })
}

fn co_simulation(interface: Interface) -> Result<CoSimulation> {
    let flag =
        |attribute, text: &Option<String>| attributes::flag("CoSimulation", attribute, text.as_deref());
    Ok(CoSimulation {
        can_handle_variable_step: flag("canHandleVariableCommunicationStepSize", &interface.variable_step)?,
        fixed_internal_step_size: attributes::optional_real(
            "CoSimulation",
            "fixedInternalStepSize",
            interface.internal_step.as_deref(),
        )?,
        can_get_and_set_state: flag("canGetAndSetFMUState", &interface.state)?,
        has_event_mode: flag("hasEventMode", &interface.event_mode)?,
        needs_execution_tool: flag("needsExecutionTool", &interface.tool)?,
        only_one_instance_per_process: flag("canBeInstantiatedOnlyOncePerProcess", &interface.only_once)?,
        model_identifier: interface.model_identifier,
    })
}

/// Appends the variable and its aliases.
fn append(
    element: VariableElement,
    type_units: &HashMap<String, Arc<str>>,
    variables: &mut Vec<Variable>,
) -> Result<()> {
    let Some((kind, storage, attributes)) = classify(element) else { return Ok(()) };
    let element = format!("the variable `{}`", attributes.name);
    let default = match kind {
        Kind::Real => Variability::Continuous,
        _ => Variability::Discrete,
    };
    let inherited = || attributes.declared_type.as_ref().and_then(|name| type_units.get(name)).cloned();
    let from_elements = || {
        let values: Vec<_> = attributes.start_elements.iter().map(|start| start.value.as_str()).collect();
        (!values.is_empty()).then(|| values.join(" "))
    };
    // Each alias has a name and a description of its own, and shares everything else.
    let value = Variable {
        value_reference: attributes::number(
            &element,
            "valueReference",
            &attributes.value_reference,
            "an unsigned 32 bit number",
        )?,
        kind,
        storage,
        causality: attributes::causality(&element, attributes.causality.as_deref())?,
        variability: attributes::variability(&element, attributes.variability.as_deref(), default)?,
        start: attributes.start.or_else(from_elements).map(Arc::from),
        unit: attributes.unit.map(Arc::from).or_else(inherited),
        declared_type: attributes.declared_type.map(Arc::from),
        description: None,
        is_array: !attributes.dimensions.is_empty(),
        name: String::new(),
    };
    let own = (attributes.name, attributes.description);
    let aliases = attributes.aliases.into_iter().map(|alias| (alias.name, alias.description));
    let names = std::iter::once(own).chain(aliases);
    variables.extend(names.map(|(name, description)| Variable { name, description, ..value.clone() }));
    Ok(())
}

/// FMI 3.0 forbids what FMI 2.0 calls an alias: "The valueReference must be unique for all variables of an FMU"
/// (section 2.4.7.4). Its own aliases are elements of their variable.
fn check_reference(variables: &[Variable], start: usize, seen: &mut HashMap<u32, usize>) -> Result<()> {
    let Some(variable) = variables.get(start) else { return Ok(()) };
    match seen.insert(variable.value_reference, start) {
        None => Ok(()),
        Some(first) => Err(HostError::Duplicate {
            what: format!("the value reference {}", variable.value_reference),
            first: format!("`{}`", variables[first].name.escape_debug()),
            second: format!("`{}`", variable.name.escape_debug()),
        }),
    }
}

fn classify(element: VariableElement) -> Option<(Kind, Storage, Attributes)> {
    use VariableElement as Element;
    Some(match element {
        Element::Float64(attributes) => (Kind::Real, Storage::Float64, attributes),
        Element::Float32(attributes) => (Kind::Real, Storage::Float32, attributes),
        Element::Int8(attributes) => (Kind::Integer, Storage::Int8, attributes),
        Element::UInt8(attributes) => (Kind::Integer, Storage::UInt8, attributes),
        Element::Int16(attributes) => (Kind::Integer, Storage::Int16, attributes),
        Element::UInt16(attributes) => (Kind::Integer, Storage::UInt16, attributes),
        Element::Int32(attributes) => (Kind::Integer, Storage::Int32, attributes),
        Element::UInt32(attributes) => (Kind::Integer, Storage::UInt32, attributes),
        Element::Int64(attributes) => (Kind::Integer, Storage::Int64, attributes),
        Element::UInt64(attributes) => (Kind::Integer, Storage::UInt64, attributes),
        Element::Boolean(attributes) => (Kind::Boolean, Storage::Boolean, attributes),
        Element::String(attributes) => (Kind::String, Storage::String, attributes),
        // The C interface passes an enumeration of FMI 3.0 as an Int64.
        Element::Enumeration(attributes) => (Kind::Enumeration, Storage::Int64, attributes),
        Element::Binary(attributes) | Element::Clock(attributes) => (Kind::Other, Storage::Other, attributes),
        Element::Unknown => return None,
    })
}
