//! What travels in `extra/` beside the unit itself: a reference input and the output that belongs to it.
//!
//! Layout and manifest follow the draft 1.0.0-alpha.1 of the layered standard FMI-LS-REF (Modelica Association,
//! fmi-ls-ref), which holds for FMI 2.0 and FMI 3.0. The draft names the roles of files but no format for signals:
//! here they are comma-separated values with one row per communication point.

use serde::Serialize;

use super::PackageError;
use super::model_description::document;
use super::reference_run::ReferenceRun;
use crate::unit::Description;

/// Directory that the layered standard prescribes.
pub const DIRECTORY: &str = "extra/org.fmi-standard.fmi-ls-ref";
pub const INPUT: &str = "reference-input.csv";
pub const OUTPUT: &str = "reference-output.csv";

#[derive(Serialize)]
struct References {
    #[serde(rename = "@xmlns:fmi-ls")]
    namespace: &'static str,
    #[serde(rename = "@fmi-ls:fmi-ls-name")]
    name: &'static str,
    #[serde(rename = "@fmi-ls:fmi-ls-version")]
    version: &'static str,
    #[serde(rename = "@fmi-ls:fmi-ls-description")]
    description: &'static str,
    #[serde(rename = "Related")]
    related: Vec<Related>,
}

#[derive(Serialize)]
struct Related {
    #[serde(rename = "@type")]
    media_type: &'static str,
    #[serde(rename = "@source")]
    source: &'static str,
    #[serde(rename = "@role")]
    role: &'static str,
    #[serde(rename = "@description")]
    description: String,
}

/// Paths in the package and contents of the reference input, the reference output and their manifest.
pub fn related_files(
    description: &'static Description,
    run: &ReferenceRun,
) -> Result<[(String, String); 3], PackageError> {
    let step_size = run.step_size;
    let manifest = References {
        namespace: "http://fmi-standard.org/fmi-ls-manifest",
        name: "org.fmi-standard.fmi-ls-ref",
        version: "1.0.0-alpha.1",
        description: "Layered Standard providing information on related files included in an FMU.",
        related: vec![
            Related {
                media_type: "text/csv",
                source: INPUT,
                role: "testcase",
                description: format!(
                    "Inputs, each row held over the co-simulation step of {step_size:?} s that begins at its time; \
                     parameters have their start values"
                ),
            },
            Related {
                media_type: "text/csv",
                source: OUTPUT,
                role: "result",
                description: format!(
                    "Outputs after initialization and after each step of {step_size:?} s with {INPUT}, to the last bit"
                ),
            },
            Related {
                media_type: "text/html",
                source: "../../documentation/index.html",
                role: "document",
                description: "What the unit models, its variables and how to wire it".to_owned(),
            },
        ],
    };
    let manifest = document("fmiReferences", &manifest)
        .map_err(|source| PackageError::Manifest { unit: description.name, source })?;
    Ok([("fmi-ls-manifest.xml", manifest), (INPUT, run.inputs.csv()), (OUTPUT, run.outputs.csv())]
        .map(|(name, text)| (format!("{DIRECTORY}/{name}"), text)))
}
