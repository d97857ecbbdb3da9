//! Elements and attributes of FMI 2.0 (text of 2.0.5, sections 2.2 and 4.3).

use serde::Serialize;

use crate::package::model_description::common::{DefaultExperiment, Item, LogCategories, UnitDefinitions};

#[derive(Serialize)]
pub struct ModelDescription {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: &'static str,
    #[serde(rename = "@guid")]
    pub guid: String,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@copyright")]
    pub copyright: &'static str,
    #[serde(rename = "@license")]
    pub license: &'static str,
    #[serde(rename = "@generationTool")]
    pub generation_tool: &'static str,
    #[serde(rename = "@generationDateAndTime", skip_serializing_if = "Option::is_none")]
    pub generation_time: Option<String>,
    #[serde(rename = "@variableNamingConvention")]
    pub variable_naming_convention: &'static str,
    #[serde(rename = "@numberOfEventIndicators", skip_serializing_if = "Option::is_none")]
    pub number_of_event_indicators: Option<usize>,
    #[serde(rename = "ModelExchange", skip_serializing_if = "Option::is_none")]
    pub model_exchange: Option<ModelExchange>,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    #[serde(rename = "UnitDefinitions")]
    pub unit_definitions: UnitDefinitions,
    #[serde(rename = "TypeDefinitions")]
    pub type_definitions: TypeDefinitions,
    #[serde(rename = "LogCategories")]
    pub log_categories: LogCategories,
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    #[serde(rename = "ModelVariables")]
    pub model_variables: ModelVariables,
    #[serde(rename = "ModelStructure")]
    pub model_structure: ModelStructure,
}

#[derive(Serialize)]
pub struct ModelExchange {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    pub needs_execution_tool: bool,
    #[serde(rename = "@completedIntegratorStepNotNeeded")]
    pub completed_integrator_step_not_needed: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

#[derive(Serialize)]
pub struct CoSimulation {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    pub needs_execution_tool: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@canInterpolateInputs")]
    pub can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    // The standard's own spelling.
    #[serde(rename = "@canRunAsynchronuously")]
    pub can_run_asynchronously: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

#[derive(Serialize)]
pub struct TypeDefinitions {
    #[serde(rename = "SimpleType")]
    pub types: Vec<SimpleType>,
}

#[derive(Serialize)]
pub struct SimpleType {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "$value")]
    pub definition: Definition,
}

#[derive(Serialize)]
pub enum Definition {
    Real {
        #[serde(rename = "@quantity")]
        quantity: &'static str,
        #[serde(rename = "@unit")]
        unit: &'static str,
        #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
        display_unit: Option<&'static str>,
        #[serde(rename = "@nominal")]
        nominal: String,
    },
    Enumeration {
        #[serde(rename = "Item")]
        items: Vec<Item>,
    },
}

#[derive(Serialize)]
pub struct ModelVariables {
    #[serde(rename = "ScalarVariable")]
    pub variables: Vec<ScalarVariable>,
}

#[derive(Serialize)]
pub struct ScalarVariable {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@valueReference")]
    pub value_reference: usize,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    #[serde(rename = "$value")]
    pub value: Value,
}

#[derive(Serialize)]
pub enum Value {
    Real(ValueAttributes),
    Integer(ValueAttributes),
    Boolean(ValueAttributes),
    Enumeration(ValueAttributes),
}

#[derive(Serialize)]
pub struct ValueAttributes {
    #[serde(rename = "@declaredType", skip_serializing_if = "Option::is_none")]
    pub declared_type: Option<&'static str>,
    /// Repeated from the type for importers that do not look there.
    #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub minimum: Option<String>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    pub maximum: Option<String>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Position of the state whose derivative this is in the list of variables, counted from 1.
    #[serde(rename = "@derivative", skip_serializing_if = "Option::is_none")]
    pub derivative: Option<usize>,
    #[serde(rename = "@reinit", skip_serializing_if = "Option::is_none")]
    pub reinit: Option<bool>,
}

#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Outputs")]
    pub outputs: Unknowns,
    #[serde(rename = "Derivatives", skip_serializing_if = "Option::is_none")]
    pub derivatives: Option<Unknowns>,
    #[serde(rename = "InitialUnknowns")]
    pub initial_unknowns: Unknowns,
}

#[derive(Serialize)]
pub struct Unknowns {
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

#[derive(Serialize)]
pub struct Unknown {
    /// Position in the list of variables, counted from 1.
    #[serde(rename = "@index")]
    pub index: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
    #[serde(rename = "@dependenciesKind", skip_serializing_if = "Option::is_none")]
    pub dependencies_kind: Option<String>,
}
