//! Connectors of components and of the system itself, and what connects them (SSP 1.0.1 and 2.0, section 5).

use std::io;

use super::component::Component;
use super::form::SystemForm;
use super::type_definitions::data_type;
use crate::model::variable::{Causality, Variable};
use crate::package::xml::{Writer, attribute, element, empty_element, optional};

/// A variable and the name of its connector.
type Named = (String, &'static Variable);

/// `ssd:Connectors` of a component: its inputs and outputs.
pub fn component_connectors(writer: &mut Writer, component: &Component, form: SystemForm) -> io::Result<()> {
    let named = component.connectable(form).map(|variable| (variable.name.to_owned(), variable));
    let (inputs, outputs) = named.partition(|(_, variable)| variable.causality == Causality::Input);
    connectors(writer, inputs, outputs, form)
}

/// `ssd:Connectors` of the system: the inputs that the loop leaves open, and what both models compute in continuous
/// quantities.
pub fn system_connectors(
    writer: &mut Writer,
    components: &[Component; 2],
    form: SystemForm,
) -> io::Result<()> {
    let named = |variable| (system_name(variable), variable);
    let inputs = components.iter().flat_map(Component::open_inputs).map(named).collect();
    let outputs = components.iter().flat_map(Component::shown_outputs).map(named).collect();
    connectors(writer, inputs, outputs, form)
}

/// Inputs on the left edge, outputs on the right.
fn connectors(
    writer: &mut Writer,
    inputs: Vec<Named>,
    outputs: Vec<Named>,
    form: SystemForm,
) -> io::Result<()> {
    element(writer, "ssd:Connectors", [], |writer| {
        for (kind, x, side) in [("input", 0, inputs), ("output", 1, outputs)] {
            let count = side.len() as f64;
            for (place, (name, variable)) in side.into_iter().enumerate() {
                let attributes = [
                    attribute("name", name),
                    attribute("description", variable.description),
                    attribute("kind", kind),
                ];
                // Both coordinates from 0 to 1, y upwards.
                let y = 1.0 - (place as f64 + 0.5) / count;
                element(writer, "ssd:Connector", attributes, |writer| {
                    data_type(writer, "ssc", variable, None, form)?;
                    let geometry = [attribute("x", x), attribute("y", y)];
                    empty_element(writer, "ssd:ConnectorGeometry", geometry)
                })?;
            }
        }
        Ok(())
    })
}

/// `ssd:Connections`: the wires of the loop, then those from and to the system's own connectors.
pub fn connections(writer: &mut Writer, components: &[Component; 2], form: SystemForm) -> io::Result<()> {
    let [controller, plant] = components;
    element(writer, "ssd:Connections", [], |writer| {
        for (from, to) in [(plant, controller), (controller, plant)] {
            for (output, input) in to.wired {
                connection(writer, (Some(from), output), (Some(to), input))?;
            }
        }
        if !form.has_system_connectors() {
            return Ok(());
        }
        for component in components {
            for input in component.open_inputs() {
                connection(writer, (None, &system_name(input)), (Some(component), input.name))?;
            }
        }
        for component in components {
            for output in component.shown_outputs() {
                connection(writer, (Some(component), output.name), (None, &system_name(output)))?;
            }
        }
        Ok(())
    })
}

/// `ssd:Connection` between two ends, each the connector of a component or, without one, of the system.
fn connection(
    writer: &mut Writer,
    (start_component, start_connector): (Option<&Component>, &str),
    (end_component, end_connector): (Option<&Component>, &str),
) -> io::Result<()> {
    let name = |component: &Component| component.name;
    let attributes = [
        optional("startElement", start_component.map(name)),
        Some(attribute("startConnector", start_connector)),
        optional("endElement", end_component.map(name)),
        Some(attribute("endConnector", end_connector)),
    ];
    empty_element(writer, "ssd:Connection", attributes.into_iter().flatten())
}

/// Name of the system's connector for a variable. A dot in it would stand between an element and its connector.
fn system_name(variable: &Variable) -> String {
    variable.name.replace('.', "_")
}
