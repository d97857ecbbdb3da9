//! `modelDescription.xml` of FMI 2.0 and FMI 3.0 in one form.

mod attributes;
mod elements;
mod fmi2;
mod fmi3;
mod variable;

use std::collections::HashMap;

use serde::Deserialize;

use super::error::{HostError, Result};
use super::limits::Limits;
use crate::causes::with_causes;
use crate::fmi::FmiVersion;

pub use variable::{Causality, Kind, Storage, Variability, Variable};

/// The co-simulation interface of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct CoSimulation {
    /// File name of the shared library without extension.
    pub model_identifier: String,
    /// Communication steps may differ in size.
    pub can_handle_variable_step: bool,
    /// Internal step of the unit in seconds, FMI 3.0 only.
    pub fixed_internal_step_size: Option<f64>,
    /// The unit's state can be saved and restored.
    pub can_get_and_set_state: bool,
    /// The unit knows event mode, FMI 3.0 only; the host does not use it.
    pub has_event_mode: bool,
    /// The unit is a front end to a program that has to be installed.
    pub needs_execution_tool: bool,
    /// At most one instance per process.
    pub only_one_instance_per_process: bool,
}

/// What the author of the FMU suggests to simulate; all in seconds but the tolerance, which is relative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DefaultExperiment {
    pub start_time: Option<f64>,
    pub stop_time: Option<f64>,
    pub tolerance: Option<f64>,
    pub step_size: Option<f64>,
}

/// One item of an enumeration type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EnumerationItem {
    pub name: String,
    pub value: i64,
}

/// What an importer has to know about an FMU.
#[derive(Clone, Debug)]
pub struct ModelDescription {
    pub fmi_version: FmiVersion,
    pub model_name: String,
    /// `instantiationToken` of FMI 3.0, `guid` of FMI 2.0.
    pub instantiation_token: String,
    /// `None` if the FMU is for model exchange or scheduled execution only.
    pub co_simulation: Option<CoSimulation>,
    /// In the order of the file; an alias of FMI 3.0 follows the variable it stands for.
    pub variables: Vec<Variable>,
    pub default_experiment: DefaultExperiment,
    enumerations: HashMap<String, Vec<EnumerationItem>>,
    index: HashMap<String, usize>,
}

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

    /// The variable called `name`.
    ///
    /// # Errors
    /// [`HostError::UnknownVariable`], with a similar name if there is one.
    pub fn variable(&self, name: &str) -> Result<&Variable> {
        self.index.get(name).map(|&place| &self.variables[place]).ok_or_else(|| HostError::UnknownVariable {
            model: self.model_name.clone(),
            variable: name.to_owned(),
            similar: self.similar_name(name),
        })
    }

    /// The items of the variable's enumeration type; empty for other kinds.
    pub fn enumeration_items(&self, variable: &Variable) -> &[EnumerationItem] {
        let declared = variable.declared_type.as_ref().filter(|_| variable.kind == Kind::Enumeration);
        declared.and_then(|name| self.enumerations.get(&**name)).map_or(&[], Vec::as_slice)
    }

    /// The items of the enumeration type called `type_name`, `None` if there is no such type.
    pub fn enumeration(&self, type_name: &str) -> Option<&[EnumerationItem]> {
        self.enumerations.get(type_name).map(Vec::as_slice)
    }

    /// A name that differs only in case, underscores, or by containing what was asked for.
    fn similar_name(&self, name: &str) -> Option<String> {
        let plain = |text: &str| {
            text.chars().filter(|letter| letter.is_alphanumeric()).collect::<String>().to_lowercase()
        };
        let wanted = plain(name);
        if wanted.is_empty() {
            return None;
        }
        let names = || self.variables.iter().map(|variable| &variable.name);
        names()
            .find(|candidate| plain(candidate) == wanted)
            .or_else(|| names().find(|candidate| plain(candidate).contains(&wanted)))
            .cloned()
    }
}

fn read<'xml, T: Deserialize<'xml>>(xml: &'xml str) -> Result<T> {
    quick_xml::de::from_str(xml).map_err(|error| HostError::Description { reason: with_causes(&error) })
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
