//! What an importer has to know about an FMU, of either version of the standard.

use std::collections::HashMap;

use crate::fmi::FmiVersion;
use crate::host::error::{HostError, Result};
use crate::host::variable::{Kind, Variable};

/// The co-simulation interface of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct CoSimulation {
    /// File name of the shared library without extension.
    pub model_identifier: String,
    /// Communication steps may differ in size.
    pub can_handle_variable_step: bool,
    /// Internal step of the model in seconds, FMI 3.0 only.
    pub fixed_internal_step_size: Option<f64>,
    /// The model's state can be saved and restored.
    pub can_get_and_set_state: bool,
    /// The model knows event mode, FMI 3.0 only; the host does not use it.
    pub has_event_mode: bool,
    /// The model is a front end to a program that has to be installed.
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
    pub(super) enumerations: HashMap<String, Vec<EnumerationItem>>,
    /// Places of the variables by name.
    pub(super) index: HashMap<String, usize>,
}

impl ModelDescription {
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
