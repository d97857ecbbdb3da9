//! The model description of FMI 3.0 (text of 3.0.2, sections 2.4 and 4.4).

mod elements;

pub use elements::ModelDescription;
use elements::{
    ClockAttributes, CoSimulation, ModelExchange, ModelStructure, ModelVariables, ScheduledExecution, Type,
    TypeDefinitions, TypedVariable, Unknown, VariableAttributes,
};

use super::common::{
    DefaultExperiment, GENERATION_TOOL, Item, LogCategories, UnitDefinitions, VERSION, enumerations,
    quantities, real,
};
use super::roles;
use crate::package::{Capabilities, FmiVersion, GenerationTime, licenses};
use crate::unit::sampled::{ClockVariable, SAMPLE_TIME};
use crate::unit::variable::{Kind, Variable};
use crate::unit::{Description, Edition, StartValues};

impl ModelDescription {
    pub fn new(
        description: &'static Description,
        edition: Edition,
        start_values: &StartValues,
        time: Option<GenerationTime>,
    ) -> Self {
        let can = Capabilities::of(description, edition);
        let variables = description.variables.iter().enumerate();
        let input_clocks = input_clocks(description, edition);
        let clocks = edition.clocks(description);
        Self {
            fmi_version: FmiVersion::Three.text(),
            model_name: description.name,
            instantiation_token: start_values.token(description, edition),
            description: description.summary,
            version: VERSION,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.map(|time| time.to_string()),
            variable_naming_convention: "structured",
            model_exchange: description.offers_model_exchange().then(|| ModelExchange::new(description, can)),
            co_simulation: CoSimulation::new(description, can),
            scheduled_execution: can
                .offers_scheduled_execution
                .then(|| ScheduledExecution::new(description, can)),
            unit_definitions: UnitDefinitions::new(description),
            type_definitions: TypeDefinitions::new(description),
            log_categories: LogCategories::new(),
            default_experiment: DefaultExperiment::new(description),
            model_variables: ModelVariables {
                variables: variables
                    .map(|(reference, variable)| {
                        TypedVariable::new(description, reference, variable, start_values)
                    })
                    .chain(clocks.map(|(reference, clock)| {
                        TypedVariable::clock(description, reference, clock, &input_clocks, start_values)
                    }))
                    .collect(),
            },
            model_structure: ModelStructure::new(description, edition),
        }
    }
}

impl ModelExchange {
    fn new(description: &Description, can: Capabilities) -> Self {
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
    fn new(description: &Description, can: Capabilities) -> Self {
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

impl ScheduledExecution {
    fn new(description: &Description, can: Capabilities) -> Self {
        Self {
            model_identifier: description.name,
            needs_execution_tool: can.needs_execution_tool,
            can_be_instantiated_only_once_per_process: can.can_be_instantiated_only_once_per_process,
            can_get_and_set_fmu_state: can.can_get_and_set_fmu_state,
            can_serialize_fmu_state: can.can_serialize_fmu_state,
            provides_directional_derivatives: can.provides_directional_derivatives,
            provides_adjoint_derivatives: can.provides_adjoint_derivatives,
            provides_per_element_dependencies: can.provides_per_element_dependencies,
        }
    }
}

impl TypeDefinitions {
    fn new(description: &Description) -> Self {
        let reals = quantities(description).into_iter().map(|quantity| Type::Float64Type {
            name: quantity.name,
            quantity: quantity.name,
            unit: quantity.unit.name,
            display_unit: quantity.unit.display.map(|(name, _)| name),
            nominal: real(quantity.nominal),
        });
        let enumerations = enumerations(description).into_iter().map(|enumeration| Type::EnumerationType {
            name: enumeration.name,
            items: Item::all(enumeration),
        });
        Self { types: reals.chain(enumerations).collect() }
    }
}

impl TypedVariable {
    /// An output clock ticks when one of the `input_clocks` does: it is bound to them, and may be asked for at their
    /// ticks only.
    ///
    /// The interval of an input clock is what the parameter sample_time starts with. An importer may set either, with the
    /// same effect (section 2.4.5.1 asks for the attribute, section 2.2.8.2 has the importer set the interval then).
    fn clock(
        description: &Description,
        value_reference: usize,
        clock: &ClockVariable,
        input_clocks: &str,
        start_values: &StartValues,
    ) -> Self {
        let sample_time = description.find(SAMPLE_TIME).filter(|_| clock.is_input);
        Self::Clock(ClockAttributes {
            name: clock.name,
            value_reference,
            description: clock.description,
            causality: if clock.is_input { "input" } else { "output" },
            variability: "discrete",
            clocks: (!clock.is_input).then(|| input_clocks.to_owned()),
            priority: clock.is_input.then_some(0),
            interval_variability: if clock.is_input { "fixed" } else { "triggered" },
            interval_decimal: sample_time.and_then(|(reference, variable)| {
                roles::start(variable, start_values.of(reference, variable))
            }),
            supports_fraction: clock.is_input.then_some(true),
        })
    }

    fn new(
        description: &Description,
        value_reference: usize,
        variable: &Variable,
        start_values: &StartValues,
    ) -> Self {
        let [minimum, maximum] = roles::range(variable);
        let attributes = |declared_type| VariableAttributes {
            name: variable.name,
            value_reference,
            description: variable.description,
            causality: roles::causality(variable),
            variability: roles::variability(variable),
            initial: roles::initial(variable),
            intermediate_update: roles::may_be_set_within_a_step(description, variable).then_some(true),
            declared_type,
            minimum,
            maximum,
            start: roles::start(variable, start_values.of(value_reference, variable)),
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

/// Value references of the clocks that the importer activates.
fn input_clocks(description: &Description, edition: Edition) -> String {
    let inputs = edition.clocks(description).filter(|(_, clock)| clock.is_input);
    inputs.map(|(reference, _)| reference.to_string()).collect::<Vec<_>>().join(" ")
}

/// Clocks that the unit activates. They are bound to the input clocks, and depend on them, too: dependencies on clocks
/// have to be listed (section 2.4.8).
fn output_clocks(description: &Description, edition: Edition) -> impl Iterator<Item = Unknown> {
    let outputs = edition.clocks(description).filter(|(_, clock)| !clock.is_input);
    outputs.map(move |(value_reference, _)| {
        let dependencies = input_clocks(description, edition);
        let kinds = vec!["dependent"; dependencies.split_whitespace().count()];
        Unknown { value_reference, dependencies, dependencies_kind: Some(kinds.join(" ")) }
    })
}

impl ModelStructure {
    fn new(description: &Description, edition: Edition) -> Self {
        let unknown = |value_reference, dependencies: roles::Dependencies| Unknown {
            value_reference,
            dependencies: dependencies.list(0),
            dependencies_kind: dependencies.kind_list(),
        };
        let at_an_instant =
            |reference| unknown(reference, roles::Dependencies::at_an_instant(description, reference, true));
        Self {
            outputs: roles::outputs(description)
                .map(at_an_instant)
                .chain(output_clocks(description, edition))
                .collect(),
            derivatives: roles::derivatives(description).map(at_an_instant).collect(),
            // Output clocks are bound to input clocks, and clocked variables need not be listed (section 2.4.8).
            initial_unknowns: roles::initial_unknowns(description)
                .map(|(reference, dependencies)| unknown(reference, dependencies))
                .collect(),
            event_indicators: description.event_indicators().map(at_an_instant).collect(),
        }
    }
}
