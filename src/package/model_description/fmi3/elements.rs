//! Elements and attributes of FMI 3.0 (text of 3.0.2, sections 2.4 and 4.4).

use serde::Serialize;

use crate::package::model_description::common::{DefaultExperiment, Item, LogCategories, UnitDefinitions};

#[derive(Serialize)]
pub struct ModelDescription {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: &'static str,
    #[serde(rename = "@instantiationToken")]
    pub instantiation_token: String,
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
    #[serde(rename = "ModelExchange", skip_serializing_if = "Option::is_none")]
    pub model_exchange: Option<ModelExchange>,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    #[serde(rename = "ScheduledExecution", skip_serializing_if = "Option::is_none")]
    pub scheduled_execution: Option<ScheduledExecution>,
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
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub provides_adjoint_derivatives: bool,
    #[serde(rename = "@providesPerElementDependencies")]
    pub provides_per_element_dependencies: bool,
    #[serde(rename = "@needsCompletedIntegratorStep")]
    pub needs_completed_integrator_step: bool,
    #[serde(rename = "@providesEvaluateDiscreteStates")]
    pub provides_evaluate_discrete_states: bool,
}

#[derive(Serialize)]
pub struct CoSimulation {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    pub needs_execution_tool: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub provides_adjoint_derivatives: bool,
    #[serde(rename = "@providesPerElementDependencies")]
    pub provides_per_element_dependencies: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    #[serde(rename = "@providesIntermediateUpdate")]
    pub provides_intermediate_update: bool,
    #[serde(rename = "@mightReturnEarlyFromDoStep")]
    pub might_return_early_from_do_step: bool,
    #[serde(rename = "@canReturnEarlyAfterIntermediateUpdate")]
    pub can_return_early_after_intermediate_update: bool,
    #[serde(rename = "@hasEventMode")]
    pub has_event_mode: bool,
    #[serde(rename = "@providesEvaluateDiscreteStates")]
    pub provides_evaluate_discrete_states: bool,
}

#[derive(Serialize)]
pub struct ScheduledExecution {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    pub needs_execution_tool: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub provides_adjoint_derivatives: bool,
    #[serde(rename = "@providesPerElementDependencies")]
    pub provides_per_element_dependencies: bool,
}

#[derive(Serialize)]
pub struct TypeDefinitions {
    #[serde(rename = "$value")]
    pub types: Vec<Type>,
}

/// Unit, display unit, quantity and nominal value stand here and nowhere else: not every importer takes them on
/// a variable. No description does: FMPy before 0.3.24 refuses types that have one.
#[derive(Serialize)]
pub enum Type {
    Float64Type {
        #[serde(rename = "@name")]
        name: &'static str,
        #[serde(rename = "@quantity")]
        quantity: &'static str,
        #[serde(rename = "@unit")]
        unit: &'static str,
        #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
        display_unit: Option<&'static str>,
        #[serde(rename = "@nominal")]
        nominal: String,
    },
    EnumerationType {
        #[serde(rename = "@name")]
        name: &'static str,
        #[serde(rename = "Item")]
        items: Vec<Item>,
    },
}

#[derive(Serialize)]
pub struct ModelVariables {
    #[serde(rename = "$value")]
    pub variables: Vec<TypedVariable>,
}

#[derive(Serialize)]
pub enum TypedVariable {
    Float64(VariableAttributes),
    Int32(VariableAttributes),
    Boolean(VariableAttributes),
    Enumeration(VariableAttributes),
    Clock(ClockAttributes),
}

#[derive(Serialize)]
pub struct ClockAttributes {
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
    /// Clocks at whose ticks this one may tick.
    #[serde(rename = "@clocks", skip_serializing_if = "Option::is_none")]
    pub clocks: Option<String>,
    #[serde(rename = "@priority", skip_serializing_if = "Option::is_none")]
    pub priority: Option<u32>,
    #[serde(rename = "@intervalVariability")]
    pub interval_variability: &'static str,
    /// \[s\]
    #[serde(rename = "@intervalDecimal", skip_serializing_if = "Option::is_none")]
    pub interval_decimal: Option<String>,
    #[serde(rename = "@supportsFraction", skip_serializing_if = "Option::is_none")]
    pub supports_fraction: Option<bool>,
}

#[derive(Serialize)]
pub struct VariableAttributes {
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
    #[serde(rename = "@intermediateUpdate", skip_serializing_if = "Option::is_none")]
    pub intermediate_update: Option<bool>,
    #[serde(rename = "@declaredType", skip_serializing_if = "Option::is_none")]
    pub declared_type: Option<&'static str>,
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub minimum: Option<String>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    pub maximum: Option<String>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Value reference of the state whose derivative this is.
    #[serde(rename = "@derivative", skip_serializing_if = "Option::is_none")]
    pub derivative: Option<usize>,
    #[serde(rename = "@reinit", skip_serializing_if = "Option::is_none")]
    pub reinit: Option<bool>,
}

#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Output")]
    pub outputs: Vec<Unknown>,
    #[serde(rename = "ContinuousStateDerivative")]
    pub derivatives: Vec<Unknown>,
    #[serde(rename = "InitialUnknown")]
    pub initial_unknowns: Vec<Unknown>,
    #[serde(rename = "EventIndicator")]
    pub event_indicators: Vec<Unknown>,
}

#[derive(Serialize)]
pub struct Unknown {
    #[serde(rename = "@valueReference")]
    pub value_reference: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
    #[serde(rename = "@dependenciesKind", skip_serializing_if = "Option::is_none")]
    pub dependencies_kind: Option<String>,
}
