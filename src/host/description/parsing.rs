//! From the text of a `modelDescription.xml` to a [`ModelDescription`].

use std::collections::HashMap;

use serde::Deserialize;

use super::document::read;
use super::model_description::ModelDescription;
use super::{elements, fmi2, fmi3};
use crate::host::error::{HostError, Result};
use crate::host::limits::Limits;
use crate::host::variable::Variable;

/// The part of the root element that both versions share.
#[derive(Deserialize)]
struct Root {
    #[serde(rename = "@fmiVersion")]
    fmi_version: String,
}

impl ModelDescription {
    /// Parses the text of a `modelDescription.xml` within the default [`Limits`].
    ///
    /// # Errors
    /// As [`ModelDescription::parse_within`].
    pub fn parse(xml: &str) -> Result<Self> {
        Self::parse_within(xml, &Limits::default())
    }

    /// Parses the text of a `modelDescription.xml`.
    ///
    /// # Errors
    /// [`HostError::Description`] if the XML is not well-formed or incomplete, [`HostError::UnsupportedVersion`],
    /// [`HostError::Attribute`] if a number, a flag or a keyword is not one, [`HostError::Duplicate`] and
    /// [`HostError::OverLimit`].
    pub fn parse_within(xml: &str, limits: &Limits) -> Result<Self> {
        let xml = xml.trim_start_matches('\u{feff}');
        elements::check_number(xml, limits)?;
        let version = read::<Root>(xml)?.fmi_version;
        let mut description = match version.trim().split('.').next() {
            Some("2") => fmi2::parse(xml),
            Some("3") => fmi3::parse(xml),
            _ => Err(HostError::UnsupportedVersion { version }),
        }?;
        description.index = index(&description.variables)?;
        Ok(description)
    }
}

/// Places by name. Both standards ask for unique names: a second variable could not be reached by its own.
fn index(variables: &[Variable]) -> Result<HashMap<String, usize>> {
    let mut index = HashMap::with_capacity(variables.len());
    for (place, variable) in variables.iter().enumerate() {
        if let Some(first) = index.insert(variable.name.clone(), place) {
            return Err(HostError::Duplicate {
                what: format!("the name `{}`", variable.name.escape_debug()),
                first: variables[first].reference_text(),
                second: variable.reference_text(),
            });
        }
    }
    Ok(index)
}
