//! Start, stop and communication step. The standard has no place for a step (SSP 1.0.1 and 2.0, section 5.1), so each
//! importer that takes one from a package finds it where it looks for it.

use std::io;

use crate::model::System;
use crate::package::xml::{Writer, attribute, element, empty_element, real};

/// Namespace of libcosim's annotation.
pub const COSIM_NAMESPACE: &str = "http://opensimulationplatform.com/SSP/OSPAnnotations";
/// Namespace of OMSimulator's annotation.
pub const OMSIMULATOR_NAMESPACE: &str =
    "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd";

/// `ssd:DefaultExperiment`, with what libcosim reads.
pub fn default_experiment(writer: &mut Writer, system: &System, step_size: f64) -> io::Result<()> {
    let attributes = [attribute("startTime", real(0.0)), attribute("stopTime", real(system.stop_time()))];
    element(writer, "ssd:DefaultExperiment", attributes, |writer| {
        annotations(writer, "com.opensimulationplatform", |writer| {
            element(writer, "osp:Algorithm", [], |writer| {
                let step = attribute("baseStepSize", real(step_size));
                empty_element(writer, "osp:FixedStepAlgorithm", [step])
            })
        })
    })
}

/// What OMSimulator reads, on the system.
pub fn system_annotations(writer: &mut Writer, step_size: f64) -> io::Result<()> {
    let master = [
        // OMSimulator's name of the master that steps all models, then exchanges.
        attribute("description", "oms-ma"),
        attribute("stepSize", real(step_size)),
        // Read, though a fixed step does not use it.
        attribute("relativeTolerance", "1e-4"),
    ];
    annotations(writer, "org.openmodelica", |writer| {
        element(writer, "oms:Annotations", [], |writer| {
            element(writer, "oms:SimulationInformation", [], |writer| {
                empty_element(writer, "oms:FixedStepMaster", master)
            })
        })
    })
}

/// `ssd:Annotations` with one annotation of a vendor.
fn annotations(
    writer: &mut Writer,
    vendor: &'static str,
    content: impl FnOnce(&mut Writer) -> io::Result<()>,
) -> io::Result<()> {
    element(writer, "ssd:Annotations", [], |writer| {
        element(writer, "ssc:Annotation", [attribute("type", vendor)], content)
    })
}
