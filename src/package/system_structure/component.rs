//! The units of a system.

use super::form::SystemForm;
use crate::unit::UnitType;
use crate::unit::system::System;
use crate::unit::variable::{Causality, Kind, Variable};

/// Instance of a unit in a system.
pub struct Component {
    /// The unit's. Importers that cut names at dots would take `controller.kp` for a variable of `controller`.
    pub name: &'static str,
    pub unit: &'static UnitType,
    /// Wires that end here: output of the other unit and own input.
    pub wired: &'static [(&'static str, &'static str)],
}

impl Component {
    /// Controller and plant, in the order in which a master that steps one after the other should take them.
    pub fn all_of(system: &System) -> [Self; 2] {
        [(system.controller, system.sensing), (system.plant, system.actuation)].map(|(unit, wired)| Self {
            name: unit.description.name,
            unit,
            wired,
        })
    }

    /// Path of the unit in the package of the system.
    pub fn unit_path(&self) -> String {
        format!("resources/{}.fmu", self.name)
    }

    /// Path of the unit's parameter set in the package of the system.
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

    /// Outputs that the system passes on: what the unit computes in continuous quantities.
    pub fn shown_outputs(&self) -> impl Iterator<Item = &'static Variable> {
        self.variables().filter(|variable| {
            variable.causality == Causality::Output && matches!(variable.kind, Kind::Real(_))
        })
    }

    /// Variables of the types that every importer has.
    fn variables(&self) -> impl Iterator<Item = &'static Variable> + use<> {
        let variables = self.unit.description.variables.iter();
        variables.filter(|variable| !matches!(variable.kind, Kind::Enumeration(_)))
    }

    /// Whether a wire of the loop ends at the input.
    fn is_wired(&self, variable: &Variable) -> bool {
        self.wired.iter().any(|(_, input)| *input == variable.name)
    }
}
