//! The model description of FMI 2.0 (text of 2.0.5, sections 2.2 and 4.3).

mod elements;

pub use elements::ModelDescription;
use elements::{
    CoSimulation, Definition, ModelExchange, ModelStructure, ModelVariables, ScalarVariable, SimpleType,
    TypeDefinitions, Unknown, Unknowns, Value, ValueAttributes,
};

use super::common::{
    DefaultExperiment, GENERATION_TOOL, Item, LogCategories, UnitDefinitions, VERSION, enumerations,
    quantities, real,
};
use super::roles;
use crate::package::{Capabilities, FmiVersion, GenerationTime, licenses};
use crate::unit::variable::{Kind, Variable};
use crate::unit::{Description, Edition, StartValues};

impl ModelDescription {
    pub fn new(
        description: &'static Description,
        start_values: &StartValues,
        time: Option<GenerationTime>,
    ) -> Self {
        let variables = description.variables.iter().enumerate();
        Self {
            fmi_version: FmiVersion::Two.text(),
            model_name: description.name,
            guid: start_values.token(description, Edition::Plain),
            description: description.summary,
            version: VERSION,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.map(|time| time.to_string()),
            variable_naming_convention: "structured",
            number_of_event_indicators: description
                .offers_model_exchange()
                .then(|| description.event_indicators().count()),
            model_exchange: description.offers_model_exchange().then(|| ModelExchange::new(description)),
            co_simulation: CoSimulation::new(description),
            unit_definitions: UnitDefinitions::new(description),
            type_definitions: TypeDefinitions::new(description),
            log_categories: LogCategories::new(),
            default_experiment: DefaultExperiment::new(description),
            model_variables: ModelVariables {
                variables: variables
                    .map(|(reference, variable)| {
                        ScalarVariable::new(description, reference, variable, start_values)
                    })
                    .collect(),
            },
            model_structure: ModelStructure::new(description),
        }
    }
}

impl ModelExchange {
    fn new(description: &Description) -> Self {
        let can = Capabilities::of(description, Edition::Plain);
        Self {
            model_identifier: description.name,
            needs_execution_tool: can.needs_execution_tool,
            completed_integrator_step_not_needed: !can.needs_completed_integrator_step,
            can_be_instantiated_only_once_per_process: can.can_be_instantiated_only_once_per_process,
            can_not_use_memory_management_functions: can.can_not_use_memory_management_functions,
            can_get_and_set_fmu_state: can.can_get_and_set_fmu_state,
            can_serialize_fmu_state: can.can_serialize_fmu_state,
            provides_directional_derivative: can.provides_directional_derivatives,
        }
    }
}

impl CoSimulation {
    fn new(description: &Description) -> Self {
        let can = Capabilities::of(description, Edition::Plain);
        Self {
            model_identifier: description.name,
            needs_execution_tool: can.needs_execution_tool,
            can_handle_variable_communication_step_size: can.can_handle_variable_communication_step_size,
            can_interpolate_inputs: can.can_interpolate_inputs,
            max_output_derivative_order: can.max_output_derivative_order,
            can_run_asynchronously: can.can_run_asynchronously,
            can_be_instantiated_only_once_per_process: can.can_be_instantiated_only_once_per_process,
            can_not_use_memory_management_functions: can.can_not_use_memory_management_functions,
            can_get_and_set_fmu_state: can.can_get_and_set_fmu_state,
            can_serialize_fmu_state: can.can_serialize_fmu_state,
            provides_directional_derivative: can.provides_directional_derivatives,
        }
    }
}

impl TypeDefinitions {
    fn new(description: &Description) -> Self {
        let reals = quantities(description).into_iter().map(|quantity| SimpleType {
            name: quantity.name,
            description: quantity.description,
            definition: Definition::Real {
                quantity: quantity.name,
                unit: quantity.unit.name,
                display_unit: quantity.unit.display.map(|(name, _)| name),
                nominal: real(quantity.nominal),
            },
        });
        let enumerations = enumerations(description).into_iter().map(|enumeration| SimpleType {
            name: enumeration.name,
            description: enumeration.description,
            definition: Definition::Enumeration { items: Item::all(enumeration) },
        });
        Self { types: reals.chain(enumerations).collect() }
    }
}

impl ScalarVariable {
    fn new(
        description: &Description,
        value_reference: usize,
        variable: &Variable,
        start_values: &StartValues,
    ) -> Self {
        let [minimum, maximum] = roles::range(variable);
        let start = roles::start(variable, start_values.of(value_reference, variable));
        let attributes = |declared_type, unit| ValueAttributes {
            declared_type,
            unit,
            minimum,
            maximum,
            start,
            derivative: roles::derivative_of(description, variable).map(|state| state + 1),
            reinit: roles::reinit(variable),
        };
        Self {
            name: variable.name,
            value_reference,
            description: variable.description,
            causality: roles::causality(variable),
            variability: roles::variability(variable),
            initial: roles::initial(variable),
            value: match variable.kind {
                Kind::Real(quantity) => {
                    Value::Real(attributes(Some(quantity.name), Some(quantity.unit.name)))
                }
                Kind::Integer => Value::Integer(attributes(None, None)),
                Kind::Boolean => Value::Boolean(attributes(None, None)),
                Kind::Enumeration(enumeration) => {
                    Value::Enumeration(attributes(Some(enumeration.name), None))
                }
            },
        }
    }
}

impl ModelStructure {
    fn new(description: &Description) -> Self {
        let unknown = |reference: usize, dependencies: roles::Dependencies| Unknown {
            index: reference + 1,
            dependencies: dependencies.list(1),
            dependencies_kind: dependencies.kind_list(),
        };
        let at_an_instant =
            |reference| unknown(reference, roles::Dependencies::at_an_instant(description, reference, false));
        Self {
            outputs: Unknowns { unknowns: roles::outputs(description).map(at_an_instant).collect() },
            derivatives: description
                .offers_model_exchange()
                .then(|| Unknowns { unknowns: roles::derivatives(description).map(at_an_instant).collect() }),
            initial_unknowns: Unknowns {
                unknowns: roles::initial_unknowns(description)
                    .map(|(reference, dependencies)| unknown(reference, dependencies))
                    .collect(),
            },
        }
    }
}
