//! What travels in `extra/` beside the model itself: a reference input and the output that belongs to it.
//!
//! Layout and manifest follow the draft 1.0.0-alpha.1 of the layered standard FMI-LS-REF (Modelica Association,
//! fmi-ls-ref), which holds for FMI 2.0 and FMI 3.0. The draft names the roles of files but no format for signals:
//! here they are comma-separated values with one row per communication point.

use super::reference_run::ReferenceRun;
use super::xml::{attribute, document, empty_element};

/// Directory that the layered standard prescribes.
pub const DIRECTORY: &str = "extra/org.fmi-standard.fmi-ls-ref";
pub const INPUT: &str = "reference-input.csv";
pub const OUTPUT: &str = "reference-output.csv";

/// Paths in the package and contents of the reference input, the reference output and their manifest.
pub fn related_files(run: &ReferenceRun) -> [(String, String); 3] {
    let files = [
        ("fmi-ls-manifest.xml", manifest(run.step_size)),
        (INPUT, run.inputs.csv()),
        (OUTPUT, run.outputs.csv()),
    ];
    files.map(|(name, text)| (format!("{DIRECTORY}/{name}"), text))
}

/// The manifest, with the communication step \[s\] of the reference run.
fn manifest(step_size: f64) -> String {
    let attributes = [
        attribute("xmlns:fmi-ls", "http://fmi-standard.org/fmi-ls-manifest"),
        attribute("fmi-ls:fmi-ls-name", "org.fmi-standard.fmi-ls-ref"),
        attribute("fmi-ls:fmi-ls-version", "1.0.0-alpha.1"),
        attribute(
            "fmi-ls:fmi-ls-description",
            "Layered Standard providing information on related files included in an FMU.",
        ),
    ];
    let inputs = format!(
        "Inputs, each row held over the co-simulation step of {step_size:?} s that begins at its time; parameters \
         have their start values"
    );
    let outputs = format!(
        "Outputs after initialization and after each step of {step_size:?} s with {INPUT}, to the last bit"
    );
    let page = "What is modelled, the variables and how to wire it".to_owned();
    let related = [
        ("text/csv", INPUT, "testcase", inputs),
        ("text/csv", OUTPUT, "result", outputs),
        ("text/html", "../../documentation/index.html", "document", page),
    ];
    document("fmiReferences", attributes, |writer| {
        related.into_iter().try_for_each(|(media_type, source, role, description)| {
            let attributes = [
                attribute("type", media_type),
                attribute("source", source),
                attribute("role", role),
                attribute("description", description),
            ];
            empty_element(writer, "Related", attributes)
        })
    })
}
