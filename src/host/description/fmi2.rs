//! The XML schema of FMI 2.0, as far as co-simulation needs it.

use std::collections::HashMap;
use std::sync::Arc;

use serde::Deserialize;

use crate::host::error::{HostError, Result};

use super::attributes::{self, Experiment, Item};
use super::document::read;
use super::model_description::{CoSimulation, ModelDescription};
use crate::fmi::FmiVersion;
use crate::host::variable::{Kind, Storage, Variability, Variable};

#[derive(Deserialize)]
struct Document {
    #[serde(rename = "@modelName")]
    model_name: String,
    #[serde(rename = "@guid")]
    guid: String,
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
    #[serde(rename = "@canGetAndSetFMUstate")]
    state: Option<String>,
    #[serde(rename = "@needsExecutionTool")]
    tool: Option<String>,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    only_once: Option<String>,
}

#[derive(Deserialize)]
struct Types {
    #[serde(rename = "SimpleType", default)]
    simple: Vec<SimpleType>,
}

#[derive(Deserialize)]
struct SimpleType {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "Real")]
    real: Option<RealType>,
    #[serde(rename = "Enumeration")]
    enumeration: Option<EnumerationType>,
}

#[derive(Deserialize)]
struct RealType {
    #[serde(rename = "@unit")]
    unit: Option<String>,
}

#[derive(Deserialize)]
struct EnumerationType {
    #[serde(rename = "Item", default)]
    items: Vec<Item>,
}

#[derive(Deserialize)]
struct Variables {
    #[serde(rename = "ScalarVariable", default)]
    scalars: Vec<ScalarVariable>,
}

#[derive(Deserialize)]
struct ScalarVariable {
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
    #[serde(rename = "Real")]
    real: Option<Value>,
    #[serde(rename = "Integer")]
    integer: Option<Value>,
    #[serde(rename = "Boolean")]
    boolean: Option<Value>,
    #[serde(rename = "String")]
    string: Option<Value>,
    #[serde(rename = "Enumeration")]
    enumeration: Option<Value>,
}

/// The child element that tells the type of a variable.
#[derive(Deserialize)]
struct Value {
    #[serde(rename = "@start")]
    start: Option<String>,
    #[serde(rename = "@unit")]
    unit: Option<String>,
    #[serde(rename = "@declaredType")]
    declared_type: Option<String>,
}

pub(super) fn parse(xml: &str) -> Result<ModelDescription> {
    let document: Document = read(xml)?;
    let mut type_units = HashMap::new();
    let mut enumerations = HashMap::new();
    for simple in document.types.map(|types| types.simple).unwrap_or_default() {
        if let Some(unit) = simple.real.and_then(|real| real.unit) {
            type_units.insert(simple.name.clone(), Arc::from(unit));
        }
        if let Some(enumeration) = simple.enumeration {
            let items = attributes::items(&simple.name, enumeration.items)?;
            enumerations.insert(simple.name, items);
        }
    }
    let variables = document
        .variables
        .scalars
        .into_iter()
        .map(|scalar| variable(scalar, &type_units))
        .collect::<Result<Vec<_>>>()?;
    Ok(ModelDescription {
        fmi_version: FmiVersion::Two,
        model_name: document.model_name,
        instantiation_token: document.guid,
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
        fixed_internal_step_size: None,
        can_get_and_set_state: flag("canGetAndSetFMUstate", &interface.state)?,
        has_event_mode: false,
        needs_execution_tool: flag("needsExecutionTool", &interface.tool)?,
        only_one_instance_per_process: flag("canBeInstantiatedOnlyOncePerProcess", &interface.only_once)?,
        model_identifier: interface.model_identifier,
    })
}

fn variable(scalar: ScalarVariable, type_units: &HashMap<String, Arc<str>>) -> Result<Variable> {
    let element = format!("the variable `{}`", scalar.name);
    let (kind, storage, value) = [
        (Kind::Real, Storage::Float64, scalar.real),
        (Kind::Integer, Storage::Int32, scalar.integer),
        (Kind::Boolean, Storage::Boolean, scalar.boolean),
        (Kind::String, Storage::String, scalar.string),
        (Kind::Enumeration, Storage::Int32, scalar.enumeration),
    ]
    .into_iter()
    .find_map(|(kind, storage, value)| value.map(|value| (kind, storage, value)))
    .ok_or_else(|| HostError::Description { reason: format!("{element} has no type") })?;
    let inherited = || value.declared_type.as_ref().and_then(|name| type_units.get(name)).cloned();
    Ok(Variable {
        value_reference: attributes::number(
            &element,
            "valueReference",
            &scalar.value_reference,
            "an unsigned 32 bit number",
        )?,
        kind,
        storage,
        causality: attributes::causality(&element, scalar.causality.as_deref())?,
        variability: attributes::variability(
            &element,
            scalar.variability.as_deref(),
            Variability::Continuous,
        )?,
        start: value.start.map(Arc::from),
        unit: value.unit.map(Arc::from).or_else(inherited),
        declared_type: value.declared_type.map(Arc::from),
        description: scalar.description,
        is_array: false,
        name: scalar.name,
    })
}
