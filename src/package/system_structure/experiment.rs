//! Start, stop and communication step. The standard has no place for a step (SSP 1.0.1 and 2.0, section 5.1), so each
//! importer that takes one from a package finds it where it looks for it.

use serde::Serialize;

use crate::package::model_description::real;
use crate::unit::System;

/// Namespace of libcosim's annotation.
pub const COSIM_NAMESPACE: &str = "http://opensimulationplatform.com/SSP/OSPAnnotations";
/// Namespace of OMSimulator's annotation.
pub const OMSIMULATOR_NAMESPACE: &str =
    "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd";

#[derive(Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    start_time: String,
    #[serde(rename = "@stopTime")]
    stop_time: String,
    #[serde(rename = "ssd:Annotations")]
    annotations: Annotations<ForCosim>,
}

/// What OMSimulator reads, on the system.
pub type SystemAnnotations = Annotations<ForOmSimulator>;

#[derive(Serialize)]
pub struct Annotations<Content> {
    #[serde(rename = "ssc:Annotation")]
    annotation: Annotation<Content>,
}

#[derive(Serialize)]
struct Annotation<Content> {
    #[serde(rename = "@type")]
    annotation_type: &'static str,
    #[serde(rename = "$value")]
    content: Content,
}

#[derive(Serialize)]
enum ForCosim {
    #[serde(rename = "osp:Algorithm")]
    Algorithm {
        #[serde(rename = "osp:FixedStepAlgorithm")]
        fixed_step: CosimStep,
    },
}

#[derive(Serialize)]
struct CosimStep {
    #[serde(rename = "@baseStepSize")]
    base_step_size: String,
}

#[derive(Serialize)]
pub enum ForOmSimulator {
    #[serde(rename = "oms:Annotations")]
    Annotations {
        #[serde(rename = "oms:SimulationInformation")]
        information: SimulationInformation,
    },
}

#[derive(Serialize)]
pub struct SimulationInformation {
    #[serde(rename = "oms:FixedStepMaster")]
    master: FixedStepMaster,
}

#[derive(Serialize)]
struct FixedStepMaster {
    /// OMSimulator's name of the master that steps all units, then exchanges.
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "@stepSize")]
    step_size: String,
    /// Read, though a fixed step does not use it.
    #[serde(rename = "@relativeTolerance")]
    relative_tolerance: &'static str,
}

impl DefaultExperiment {
    pub fn new(system: &System) -> Self {
        let fixed_step = CosimStep { base_step_size: real(system.step_size()) };
        let content = ForCosim::Algorithm { fixed_step };
        let annotation = Annotation { annotation_type: "com.opensimulationplatform", content };
        Self {
            start_time: real(0.0),
            stop_time: real(system.stop_time()),
            annotations: Annotations { annotation },
        }
    }
}

impl SystemAnnotations {
    pub fn new(system: &System) -> Self {
        let master = FixedStepMaster {
            description: "oms-ma",
            step_size: real(system.step_size()),
            relative_tolerance: "1e-4",
        };
        let content = ForOmSimulator::Annotations { information: SimulationInformation { master } };
        Self { annotation: Annotation { annotation_type: "org.openmodelica", content } }
    }
}
