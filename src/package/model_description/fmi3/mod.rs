//! The model description of FMI 3.0 (text of 3.0.2, sections 2.4 and 4.4).

mod elements;

pub use elements::ModelDescription;
use elements::{
    CoSimulation, ModelExchange, ModelStructure, ModelVariables, Type, TypeDefinitions, TypedVariable,
    Unknown, VariableAttributes,
};

use super::common::{
    DefaultExperiment, GENERATION_TOOL, Item, LogCategories, UnitDefinitions, VERSION, enumerations,
    quantities, real,
};
use super::roles;
use crate::package::{Capabilities, FmiVersion, GenerationTime, licenses};
use crate::unit::Description;
use crate::unit::variable::{Kind, Variable};

impl ModelDescription {
    pub fn new(description: &'static Description, time: Option<GenerationTime>) -> Self {
        let variables = description.variables.iter().enumerate();
        Self {
            fmi_version: FmiVersion::Three.text(),
            model_name: description.name,
            instantiation_token: description.token().as_str().to_owned(),
            description: description.summary,
            version: VERSION,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.map(|time| time.to_string()),
            variable_naming_convention: "structured",
            model_exchange: description.offers_model_exchange().then(|| ModelExchange::new(description)),
            co_simulation: CoSimulation::new(description),
            unit_definitions: UnitDefinitions::new(description),
            type_definitions: TypeDefinitions::new(description),
            log_categories: LogCategories::new(),
            default_experiment: DefaultExperiment::new(description),
            model_variables: ModelVariables {
                variables: variables
                    .map(|(reference, variable)| TypedVariable::new(description, reference, variable))
                    .collect(),
            },
            model_structure: ModelStructure::new(description),
        }
    }
}

impl ModelExchange {
    fn new(description: &Description) -> Self {
        let can = Capabilities::of(description);
        Self {
            model_identifier: description.name,
            needs_execution_tool: can.needs_execution_tool,
            can_be_instantiated_only_once_per_process: can.can_be_instantiated_only_once_per_process,
            can_get_and_set_fmu_state: can.can_get_and_set_fmu_state,
            can_serialize_fmu_state: can.can_serialize_fmu_state,
            provides_directional_derivatives: can.provides_directional_derivatives,
            provides_adjoint_derivatives: can.provides_adjoint_derivatives,
            provides_per_element_dependencies: can.provides_per_element_dependencies,
            needs_completed_integrator_step: can.needs_completed_integrator_step,
            provides_evaluate_discrete_states: can.provides_evaluate_discrete_states,
        }
    }
}

impl CoSimulation {
    fn new(description: &Description) -> Self {
        let can = Capabilities::of(description);
        Self {
            model_identifier: description.name,
            needs_execution_tool: can.needs_execution_tool,
            can_be_instantiated_only_once_per_process: can.can_be_instantiated_only_once_per_process,
            can_get_and_set_fmu_state: can.can_get_and_set_fmu_state,
            can_serialize_fmu_state: can.can_serialize_fmu_state,
            provides_directional_derivatives: can.provides_directional_derivatives,
            provides_adjoint_derivatives: can.provides_adjoint_derivatives,
            provides_per_element_dependencies: can.provides_per_element_dependencies,
            can_handle_variable_communication_step_size: can.can_handle_variable_communication_step_size,
            max_output_derivative_order: can.max_output_derivative_order,
            provides_intermediate_update: can.provides_intermediate_update,
            might_return_early_from_do_step: can.might_return_early_from_do_step,
            can_return_early_after_intermediate_update: can.can_return_early_after_intermediate_update,
            has_event_mode: can.has_event_mode,
            provides_evaluate_discrete_states: can.provides_evaluate_discrete_states,
        }
    }
}

impl TypeDefinitions {
    fn new(description: &Description) -> Self {
        let reals = quantities(description).into_iter().map(|quantity| Type::Float64Type {
            name: quantity.name,
            description: quantity.description,
            quantity: quantity.name,
            unit: quantity.unit.name,
            display_unit: quantity.unit.display.map(|(name, _)| name),
            nominal: real(quantity.nominal),
        });
        let enumerations = enumerations(description).into_iter().map(|enumeration| Type::EnumerationType {
            name: enumeration.name,
            description: enumeration.description,
            items: Item::all(enumeration),
        });
        Self { types: reals.chain(enumerations).collect() }
    }
}

impl TypedVariable {
    fn new(description: &Description, value_reference: usize, variable: &Variable) -> Self {
        let [minimum, maximum] = roles::range(variable);
        let attributes = |declared_type| VariableAttributes {
            name: variable.name,
            value_reference,
            description: variable.description,
            causality: roles::causality(variable),
            variability: roles::variability(variable),
            initial: roles::initial(variable),
            declared_type,
            minimum,
            maximum,
            start: roles::start(variable),
            derivative: roles::derivative_of(description, variable),
            reinit: roles::reinit(variable),
        };
        match variable.kind {
            Kind::Real(quantity) => Self::Float64(attributes(Some(quantity.name))),
            Kind::Integer => Self::Int32(attributes(None)),
            Kind::Boolean => Self::Boolean(attributes(None)),
            Kind::Enumeration(enumeration) => Self::Enumeration(attributes(Some(enumeration.name))),
        }
    }
}

impl ModelStructure {
    fn new(description: &Description) -> Self {
        let unknown = |value_reference, dependencies: roles::Dependencies| Unknown {
            value_reference,
            dependencies: dependencies.list(0),
            dependencies_kind: dependencies.kind_list(),
        };
        let at_an_instant =
            |reference| unknown(reference, roles::Dependencies::at_an_instant(description, reference, true));
        Self {
            outputs: roles::outputs(description).map(at_an_instant).collect(),
            derivatives: roles::derivatives(description).map(at_an_instant).collect(),
            initial_unknowns: roles::initial_unknowns(description)
                .map(|(reference, dependencies)| unknown(reference, dependencies))
                .collect(),
            event_indicators: description.event_indicators().map(at_an_instant).collect(),
        }
    }
}
