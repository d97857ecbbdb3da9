//! What is written for FMI 3.0 alone (text of 3.0.2). Variables are referred to by their value references.

use std::io;

use super::roles::{self, Dependencies};
use super::shared_elements::{
    declared_type, default_experiment, dependency_attributes, enumerations, items, log_categories,
    quantities, quantity_attributes, unit_definitions, value_attributes, variable_attributes,
};
use crate::model::sampled::{ClockVariable, SAMPLE_TIME};
use crate::model::variable::Kind;
use crate::model::{Description, Edition, StartValues};
use crate::package::Capabilities;
use crate::package::xml::{Attribute, Writer, attribute, element, empty_element, optional};

/// Value reference of the first variable.
const FIRST: usize = 0;

/// The elements of `fmiModelDescription`, in the order of the standard.
pub fn content(
    writer: &mut Writer,
    description: &Description,
    edition: Edition,
    start_values: &StartValues,
) -> io::Result<()> {
    interfaces(writer, description, edition)?;
    unit_definitions(writer, description)?;
    type_definitions(writer, description)?;
    log_categories(writer)?;
    default_experiment(writer, description)?;
    model_variables(writer, description, edition, start_values)?;
    model_structure(writer, description, edition)
}

/// `ModelExchange` (section 3.4) and `ScheduledExecution` (section 5.4) of a model that offers them, and `CoSimulation`
/// (section 4.4).
fn interfaces(writer: &mut Writer, description: &Description, edition: Edition) -> io::Result<()> {
    let can = Capabilities::of(description, edition);
    let common = common_capabilities(description, can);
    if description.offers_model_exchange() {
        let events = [
            attribute("needsCompletedIntegratorStep", can.needs_completed_integrator_step),
            attribute("providesEvaluateDiscreteStates", can.provides_evaluate_discrete_states),
        ];
        empty_element(writer, "ModelExchange", common.clone().into_iter().chain(events))?;
    }
    let early_return = can.can_return_early_after_intermediate_update;
    let stepping = [
        attribute("canHandleVariableCommunicationStepSize", can.can_handle_variable_communication_step_size),
        attribute("maxOutputDerivativeOrder", can.max_output_derivative_order),
        attribute("providesIntermediateUpdate", can.provides_intermediate_update),
        attribute("mightReturnEarlyFromDoStep", can.might_return_early_from_do_step),
        attribute("canReturnEarlyAfterIntermediateUpdate", early_return),
        attribute("hasEventMode", can.has_event_mode),
        attribute("providesEvaluateDiscreteStates", can.provides_evaluate_discrete_states),
    ];
    empty_element(writer, "CoSimulation", common.clone().into_iter().chain(stepping))?;
    if can.offers_scheduled_execution {
        empty_element(writer, "ScheduledExecution", common)?;
    }
    Ok(())
}

/// Capabilities that all interfaces tell (section 2.4.2).
fn common_capabilities(description: &Description, can: Capabilities) -> [Attribute; 8] {
    [
        attribute("modelIdentifier", description.name),
        attribute("needsExecutionTool", can.needs_execution_tool),
        attribute("canBeInstantiatedOnlyOncePerProcess", can.can_be_instantiated_only_once_per_process),
        attribute("canGetAndSetFMUState", can.can_get_and_set_fmu_state),
        attribute("canSerializeFMUState", can.can_serialize_fmu_state),
        attribute("providesDirectionalDerivatives", can.provides_directional_derivatives),
        attribute("providesAdjointDerivatives", can.provides_adjoint_derivatives),
        attribute("providesPerElementDependencies", can.provides_per_element_dependencies),
    ]
}

/// `TypeDefinitions` (section 2.4.4).
///
/// Unit, display unit, quantity and nominal value stand here and nowhere else: not every importer takes them on
/// a variable. No description does: FMPy before 0.3.24 refuses types that have one.
fn type_definitions(writer: &mut Writer, description: &Description) -> io::Result<()> {
    element(writer, "TypeDefinitions", [], |writer| {
        for quantity in quantities(description.variables) {
            let name = [attribute("name", quantity.name)];
            empty_element(writer, "Float64Type", name.into_iter().chain(quantity_attributes(quantity)))?;
        }
        for enumeration in enumerations(description) {
            let name = [attribute("name", enumeration.name)];
            element(writer, "EnumerationType", name, |writer| items(writer, enumeration))?;
        }
        Ok(())
    })
}

/// `ModelVariables` (section 2.4.7): the rows of the table, then the clocks that the edition shows.
fn model_variables(
    writer: &mut Writer,
    description: &Description,
    edition: Edition,
    start_values: &StartValues,
) -> io::Result<()> {
    element(writer, "ModelVariables", [], |writer| {
        for (reference, variable) in description.variables.iter().enumerate() {
            let type_name = match variable.kind {
                Kind::Real(_) => "Float64",
                Kind::Integer => "Int32",
                Kind::Boolean => "Boolean",
                Kind::Enumeration(_) => "Enumeration",
            };
            let may_be_set = roles::may_be_set_within_a_step(description, variable).then_some(true);
            let attributes = variable_attributes(reference, variable)
                .chain(optional("intermediateUpdate", may_be_set))
                .chain(declared_type(variable))
                .chain(value_attributes(description, reference, variable, start_values, FIRST));
            empty_element(writer, type_name, attributes)?;
        }
        edition.clocks(description).try_for_each(|(reference, clock)| {
            if clock.is_input {
                input_clock(writer, description, reference, clock, start_values)
            } else {
                output_clock(writer, description, edition, reference, clock)
            }
        })
    })
}

/// A `Clock` that the importer activates. Its interval is what the parameter sample_time starts with. An importer may set
/// either, with the same effect (section 2.4.4 asks for the attribute, section 2.2.8.2 has the importer set the interval
/// then).
fn input_clock(
    writer: &mut Writer,
    description: &Description,
    reference: usize,
    clock: &ClockVariable,
    start_values: &StartValues,
) -> io::Result<()> {
    let start = |(reference, variable)| roles::start(variable, start_values.of(reference, variable));
    let interval = description.find(SAMPLE_TIME).and_then(start);
    let attributes = clock_attributes(reference, clock, "input")
        .into_iter()
        .chain([attribute("priority", 0), attribute("intervalVariability", "fixed")])
        .chain(optional("intervalDecimal", interval))
        .chain([attribute("supportsFraction", true)]);
    empty_element(writer, "Clock", attributes)
}

/// A `Clock` that the model activates when one of the input clocks ticks: it is bound to them by the attribute `clocks`,
/// and may be asked for at their ticks only.
fn output_clock(
    writer: &mut Writer,
    description: &Description,
    edition: Edition,
    reference: usize,
    clock: &ClockVariable,
) -> io::Result<()> {
    let own = [
        attribute("clocks", depending_on_input_clocks(description, edition).list(FIRST)),
        attribute("intervalVariability", "triggered"),
    ];
    empty_element(writer, "Clock", clock_attributes(reference, clock, "output").into_iter().chain(own))
}

/// Attributes that all clocks have.
fn clock_attributes(reference: usize, clock: &ClockVariable, causality: &'static str) -> [Attribute; 5] {
    [
        attribute("name", clock.name),
        attribute("valueReference", reference),
        attribute("description", clock.description),
        attribute("causality", causality),
        attribute("variability", "discrete"),
    ]
}

/// `ModelStructure` (section 2.4.8). Output clocks are bound to input clocks, and depend on them, too: dependencies on
/// clocks have to be listed. Clocked variables need not be listed among the initial unknowns.
fn model_structure(writer: &mut Writer, description: &Description, edition: Edition) -> io::Result<()> {
    let at_an_instant = |reference| (reference, Dependencies::at_an_instant(description, reference, true));
    let output_clocks = edition.clocks(description).filter(|(_, clock)| !clock.is_input);
    let output_clocks =
        output_clocks.map(|(reference, _)| (reference, depending_on_input_clocks(description, edition)));
    element(writer, "ModelStructure", [], |writer| {
        unknowns(writer, "Output", roles::outputs(description).map(at_an_instant).chain(output_clocks))?;
        unknowns(writer, "ContinuousStateDerivative", roles::derivatives(description).map(at_an_instant))?;
        unknowns(writer, "InitialUnknown", roles::initial_unknowns(description))?;
        unknowns(writer, "EventIndicator", description.event_indicators().map(at_an_instant))
    })
}

/// Unknowns with what each depends on.
fn unknowns(
    writer: &mut Writer,
    name: &str,
    mut list: impl Iterator<Item = (usize, Dependencies)>,
) -> io::Result<()> {
    list.try_for_each(|(reference, dependencies)| {
        let reference = [attribute("valueReference", FIRST + reference)];
        empty_element(writer, name, reference.into_iter().chain(dependency_attributes(&dependencies, FIRST)))
    })
}

/// The dependencies of an output clock.
fn depending_on_input_clocks(description: &Description, edition: Edition) -> Dependencies {
    let input_clocks = edition.clocks(description).filter(|(_, clock)| clock.is_input);
    let references: Vec<usize> = input_clocks.map(|(reference, _)| reference).collect();
    let kinds = vec!["dependent"; references.len()];
    Dependencies { references, kinds }
}
