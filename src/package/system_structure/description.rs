//! `SystemStructure.ssd` (SSP 1.0.1 and 2.0, section 5).

use std::io;

use super::component::Component;
use super::connectors::{component_connectors, connections, system_connectors};
use super::experiment::{COSIM_NAMESPACE, OMSIMULATOR_NAMESPACE, default_experiment, system_annotations};
use super::form::SystemForm;
use super::type_definitions::{self, units};
use crate::model::system::System;
use crate::package::GenerationTime;
use crate::package::xml::{Writer, attribute, document, element, empty_element, origin};

/// Namespace of the elements with the prefix `ssd`.
const NAMESPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";

/// The document `ssd:SystemStructureDescription`, with a communication step \[s\].
pub fn system_structure_description(
    system: &System,
    form: SystemForm,
    step_size: f64,
    time: GenerationTime,
) -> String {
    let attributes = [
        attribute("xmlns:ssd", NAMESPACE),
        attribute("xmlns:ssc", type_definitions::NAMESPACE),
        // Declared here: libcosim takes a declaration on the annotation for part of it.
        attribute("xmlns:osp", COSIM_NAMESPACE),
        attribute("xmlns:oms", OMSIMULATOR_NAMESPACE),
        attribute("version", form.version()),
        attribute("name", system.name),
    ];
    let components = Component::all_of(system);
    document("ssd:SystemStructureDescription", attributes.into_iter().chain(origin(Some(time))), |writer| {
        system_element(writer, system, &components, form, step_size)?;
        let connectors = components.iter().flat_map(|component| component.connectable(form));
        units(writer, "ssd:Units", connectors)?;
        default_experiment(writer, system, step_size)
    })
}

/// `ssd:System`: the components and what connects them.
fn system_element(
    writer: &mut Writer,
    system: &System,
    components: &[Component; 2],
    form: SystemForm,
    step_size: f64,
) -> io::Result<()> {
    let [plant, controller] = [system.plant, system.controller].map(|model| model.description.name);
    let attributes =
        [attribute("name", system.name), attribute("description", format!("{plant} with {controller}"))];
    element(writer, "ssd:System", attributes, |writer| {
        if form.has_system_connectors() {
            system_connectors(writer, components, form)?;
        }
        element(writer, "ssd:Elements", [], |writer| {
            let mut columns = components.iter().zip(0..);
            columns.try_for_each(|(component, column)| component_element(writer, component, column, form))
        })?;
        connections(writer, components, form)?;
        system_annotations(writer, step_size)
    })
}

/// `ssd:Component`, drawn in one of the columns of the diagram. In the geometry, y points upwards.
fn component_element(
    writer: &mut Writer,
    component: &Component,
    column: u32,
    form: SystemForm,
) -> io::Result<()> {
    let attributes = [
        attribute("name", component.name),
        attribute("description", component.model.description.summary),
        attribute("type", "application/x-fmu-sharedlibrary"),
        attribute("source", component.model_path()),
        attribute("implementation", "CoSimulation"),
    ];
    let left = 300 * column;
    let corners =
        [attribute("x1", left), attribute("y1", 0), attribute("x2", left + 200), attribute("y2", 200)];
    let parameters = [
        attribute("type", "application/x-ssp-parameter-set"),
        attribute("source", component.parameters_path()),
    ];
    element(writer, "ssd:Component", attributes, |writer| {
        component_connectors(writer, component, form)?;
        empty_element(writer, "ssd:ElementGeometry", corners)?;
        element(writer, "ssd:ParameterBindings", [], |writer| {
            empty_element(writer, "ssd:ParameterBinding", parameters)
        })
    })
}
