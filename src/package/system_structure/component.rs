//! The models of a system.

use super::form::SystemForm;
use crate::model::ModelType;
use crate::model::system::System;
use crate::model::variable::{Causality, Kind, Variable};

/// Instance of a model in a system.
pub struct Component {
    /// The model's. Importers that cut names at dots would take `controller.kp` for a variable of `controller`.
    pub name: &'static str,
    pub model: &'static ModelType,
    /// Wires that end here: output of the other model and own input.
    pub wired: &'static [(&'static str, &'static str)],
}

impl Component {
    /// Controller and plant, in the order in which a master that steps one after the other should take them.
    pub fn all_of(system: &System) -> [Self; 2] {
        [(system.controller, system.sensing), (system.plant, system.actuation)].map(|(model, wired)| Self {
            name: model.description.name,
            model,
            wired,
        })
    }

    /// Path of the model in the package of the system.
    pub fn model_path(&self) -> String {
        format!("resources/{}.fmu", self.name)
    }

    /// Path of the model's parameter set in the package of the system.
    pub fn parameters_path(&self) -> String {
        format!("resources/{}.ssv", self.name)
    }

    /// Variables that are connectors: outputs, and inputs that something is connected to.
    pub fn connectable(&self, form: SystemForm) -> impl Iterator<Item = &'static Variable> {
        self.variables().filter(move |variable| match variable.causality {
            Causality::Input => form.has_system_connectors() || self.is_wired(variable),
            causality => causality == Causality::Output,
        })
    }

    /// Inputs that no wire of the loop ends at.
    pub fn open_inputs(&self) -> impl Iterator<Item = &'static Variable> {
        self.variables().filter(|variable| variable.causality == Causality::Input && !self.is_wired(variable))
    }

    /// Outputs that the system passes on: what the model computes in continuous quantities.
    pub fn shown_outputs(&self) -> impl Iterator<Item = &'static Variable> {
        self.variables().filter(|variable| {
            variable.causality == Causality::Output && matches!(variable.kind, Kind::Real(_))
        })
    }

    /// Variables of the types that every importer has.
    fn variables(&self) -> impl Iterator<Item = &'static Variable> + use<> {
        let variables = self.model.description.variables.iter();
        variables.filter(|variable| !matches!(variable.kind, Kind::Enumeration(_)))
    }

    /// Whether a wire of the loop ends at the input.
    fn is_wired(&self, variable: &Variable) -> bool {
        self.wired.iter().any(|(_, input)| *input == variable.name)
    }
}
