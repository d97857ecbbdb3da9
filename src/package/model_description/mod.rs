//! `modelDescription.xml` of FMI 2.0 and FMI 3.0, written from a unit's variable table.

mod common;
mod fmi2;
mod fmi3;
mod roles;
mod terminals_and_icons;

pub(super) use common::{GENERATION_TOOL, enumerations, real};

use quick_xml::se::Serializer;
use serde::Serialize;
pub(super) use terminals_and_icons::terminals_and_icons;

use super::{FmiVersion, Form, GenerationTime, PackageError};
use crate::unit::{Description, StartValues};

/// The model description of a unit in one form. `time` is left out of the file that is checked in.
pub fn model_description(
    description: &'static Description,
    start_values: &StartValues,
    form: Form,
    time: Option<GenerationTime>,
) -> Result<String, PackageError> {
    let Form { version, edition } = form;
    let text = match version {
        FmiVersion::Two => {
            document("fmiModelDescription", &fmi2::ModelDescription::new(description, start_values, time))
        }
        FmiVersion::Three => document(
            "fmiModelDescription",
            &fmi3::ModelDescription::new(description, edition, start_values, time),
        ),
    };
    text.map_err(|source| PackageError::ModelDescription { unit: description.name, version, source })
}

/// An XML document with the root element `root`.
pub(super) fn document(root: &str, content: &impl Serialize) -> Result<String, quick_xml::SeError> {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut serializer = Serializer::with_root(&mut text, Some(root))?;
    serializer.indent(' ', 2);
    content.serialize(serializer)?;
    text.push('\n');
    Ok(text)
}
