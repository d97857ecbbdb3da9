//! The model description of FMI 2.0 (text of 2.0.5, sections 2.2 and 4.3).

mod elements;

pub use elements::ModelDescription;
use elements::{
    CoSimulation, Definition, ModelStructure, ModelVariables, ScalarVariable, SimpleType, TypeDefinitions,
    Unknown, Unknowns, Value, ValueAttributes,
};

use super::common::{
    DefaultExperiment, GENERATION_TOOL, Item, LogCategories, UnitDefinitions, VERSION, enumerations,
    quantities, real,
};
use super::roles;
use crate::package::{Capabilities, FmiVersion, GenerationTime, licenses};
use crate::unit::variable::{Kind, Variable};
use crate::unit::{Description, StartValues};

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
            guid: start_values.token(description),
            description: description.summary,
            version: VERSION,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.map(|time| time.to_string()),
            variable_naming_convention: "structured",
            co_simulation: CoSimulation::new(description),
            unit_definitions: UnitDefinitions::new(description),
            type_definitions: TypeDefinitions::new(description),
            log_categories: LogCategories::new(),
            default_experiment: DefaultExperiment::new(description),
            model_variables: ModelVariables {
                variables: variables
                    .map(|(reference, variable)| ScalarVariable::new(reference, variable, start_values))
                    .collect(),
            },
            model_structure: ModelStructure::new(description),
        }
    }
}

impl CoSimulation {
    fn new(description: &Description) -> Self {
        let can = Capabilities::of(description);
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
    fn new(value_reference: usize, variable: &Variable, start_values: &StartValues) -> Self {
        let [minimum, maximum] = roles::range(variable);
        let start = roles::start(variable, start_values.of(value_reference, variable));
        let attributes =
            |declared_type, unit| ValueAttributes { declared_type, unit, minimum, maximum, start };
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
        let unknown = |reference: usize, dependencies: &[usize]| Unknown {
            index: reference + 1,
            dependencies: roles::joined(&dependencies.iter().map(|known| known + 1).collect::<Vec<_>>()),
            dependencies_kind: roles::dependencies_kind(dependencies.len()),
        };
        Self {
            // Outputs change in a step only: at a communication point they depend on nothing.
            outputs: Unknowns {
                unknowns: roles::outputs(description).map(|reference| unknown(reference, &[])).collect(),
            },
            initial_unknowns: Unknowns {
                unknowns: roles::initial_unknowns(description)
                    .map(|(reference, dependencies)| unknown(reference, &dependencies))
                    .collect(),
            },
        }
    }
}
