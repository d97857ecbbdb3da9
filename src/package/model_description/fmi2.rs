//! What is written for FMI 2.0 alone (text of 2.0.5). Variables are referred to by their place in the list.

use std::io;

use super::roles::{self, Dependencies};
use super::shared_elements::{
    declared_type, default_experiment, dependency_attributes, enumerations, items, log_categories,
    quantities, quantity_attributes, unit_definitions, value_attributes, variable_attributes,
};
use crate::model::variable::Kind;
use crate::model::{Description, Edition, StartValues};
use crate::package::Capabilities;
use crate::package::xml::{Attribute, Writer, attribute, element, empty_element, optional};

/// Place of the first variable.
const FIRST: usize = 1;

/// The elements of `fmiModelDescription`, in the order of the standard.
pub fn content(writer: &mut Writer, description: &Description, start_values: &StartValues) -> io::Result<()> {
    interfaces(writer, description)?;
    unit_definitions(writer, description)?;
    type_definitions(writer, description)?;
    log_categories(writer)?;
    default_experiment(writer, description)?;
    model_variables(writer, description, start_values)?;
    model_structure(writer, description)
}

/// `ModelExchange` (section 3.3.1) of a model that offers it, and `CoSimulation` (section 4.3.1).
fn interfaces(writer: &mut Writer, description: &Description) -> io::Result<()> {
    let can = Capabilities::of(description, Edition::Plain);
    let identity = [
        attribute("modelIdentifier", description.name),
        attribute("needsExecutionTool", can.needs_execution_tool),
    ];
    if description.offers_model_exchange() {
        let not_needed = !can.needs_completed_integrator_step;
        let attributes = identity
            .clone()
            .into_iter()
            .chain([attribute("completedIntegratorStepNotNeeded", not_needed)])
            .chain(common_capabilities(can));
        empty_element(writer, "ModelExchange", attributes)?;
    }
    let stepping = [
        attribute("canHandleVariableCommunicationStepSize", can.can_handle_variable_communication_step_size),
        attribute("canInterpolateInputs", can.can_interpolate_inputs),
        attribute("maxOutputDerivativeOrder", can.max_output_derivative_order),
        // The standard's own spelling.
        attribute("canRunAsynchronuously", can.can_run_asynchronously),
    ];
    let attributes = identity.into_iter().chain(stepping).chain(common_capabilities(can));
    empty_element(writer, "CoSimulation", attributes)
}

/// Capabilities that both interfaces tell.
fn common_capabilities(can: Capabilities) -> [Attribute; 5] {
    [
        attribute("canBeInstantiatedOnlyOncePerProcess", can.can_be_instantiated_only_once_per_process),
        attribute("canNotUseMemoryManagementFunctions", can.can_not_use_memory_management_functions),
        attribute("canGetAndSetFMUstate", can.can_get_and_set_fmu_state),
        attribute("canSerializeFMUstate", can.can_serialize_fmu_state),
        attribute("providesDirectionalDerivative", can.provides_directional_derivatives),
    ]
}

/// `TypeDefinitions` (section 2.2.3).
fn type_definitions(writer: &mut Writer, description: &Description) -> io::Result<()> {
    let head = |name, description| [attribute("name", name), attribute("description", description)];
    element(writer, "TypeDefinitions", [], |writer| {
        for quantity in quantities(description.variables) {
            element(writer, "SimpleType", head(quantity.name, quantity.description), |writer| {
                empty_element(writer, "Real", quantity_attributes(quantity))
            })?;
        }
        for enumeration in enumerations(description) {
            element(writer, "SimpleType", head(enumeration.name, enumeration.description), |writer| {
                element(writer, "Enumeration", [], |writer| items(writer, enumeration))
            })?;
        }
        Ok(())
    })
}

/// `ModelVariables` (section 2.2.7). The unit of measure is repeated from the type for importers that do not look there.
fn model_variables(
    writer: &mut Writer,
    description: &Description,
    start_values: &StartValues,
) -> io::Result<()> {
    element(writer, "ModelVariables", [], |writer| {
        description.variables.iter().enumerate().try_for_each(|(reference, variable)| {
            let (type_name, unit) = match variable.kind {
                Kind::Real(quantity) => ("Real", Some(quantity.unit.name)),
                Kind::Integer => ("Integer", None),
                Kind::Boolean => ("Boolean", None),
                Kind::Enumeration(_) => ("Enumeration", None),
            };
            let value = declared_type(variable)
                .into_iter()
                .chain(optional("unit", unit))
                .chain(value_attributes(description, reference, variable, start_values, FIRST));
            element(writer, "ScalarVariable", variable_attributes(reference, variable), |writer| {
                empty_element(writer, type_name, value)
            })
        })
    })
}

/// `ModelStructure` (section 2.2.8).
fn model_structure(writer: &mut Writer, description: &Description) -> io::Result<()> {
    let at_an_instant = |reference| (reference, Dependencies::at_an_instant(description, reference, false));
    element(writer, "ModelStructure", [], |writer| {
        unknowns(writer, "Outputs", roles::outputs(description).map(at_an_instant))?;
        if description.offers_model_exchange() {
            unknowns(writer, "Derivatives", roles::derivatives(description).map(at_an_instant))?;
        }
        unknowns(writer, "InitialUnknowns", roles::initial_unknowns(description))
    })
}

/// A list of unknowns with what each depends on.
fn unknowns(
    writer: &mut Writer,
    name: &str,
    mut list: impl Iterator<Item = (usize, Dependencies)>,
) -> io::Result<()> {
    element(writer, name, [], |writer| {
        list.try_for_each(|(reference, dependencies)| {
            let index = [attribute("index", FIRST + reference)];
            let attributes = index.into_iter().chain(dependency_attributes(&dependencies, FIRST));
            empty_element(writer, "Unknown", attributes)
        })
    })
}
