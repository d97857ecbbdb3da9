//! System structure packages (SSP 1.0.1 and 2.0): a plant and its controller, wired, ready to run.
//!
//! Importers step both units at once and then exchange, most start their wires at zero, and few apply the parameter
//! sets that a package binds. So the start values of [`System::start_values`] are inside the packaged units, which are
//! not those that stand alone. An input is a connector only if something is connected to it, for not every importer
//! takes others. Prefixes of namespaces are those of the standard's text; not every importer
//! resolves others.

mod connectors;
mod description;
mod experiment;
mod page;
mod parameters;

use super::contents::{Entry, diagram_name, owned};
use super::loop_diagram::loop_diagram;
use super::model_description::document;
use super::{Form, GenerationTime, Library, PackageError, archive};
use crate::unit::system::System;
use crate::unit::{Description, StartValues, UnitType};

const COMMON: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const DESCRIPTION: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const PARAMETER_VALUES: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// What a system is packaged for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemForm {
    /// SSP 1.0 without connectors of the system, since some importers refuse connections to and from it; what the loop
    /// leaves open keeps its start value unless an importer sets it by itself.
    Closed,
    /// SSP 1.0 with connectors of the system.
    Driven,
    /// SSP 2.0 with connectors of the system, and with units for FMI 3.0, which SSP 1.0 does not know.
    Two,
}

impl SystemForm {
    pub const ALL: [Self; 3] = [Self::Closed, Self::Driven, Self::Two];

    /// Directory of the packages, below that of all packages.
    pub fn directory(self) -> &'static str {
        match self {
            Self::Closed => "",
            Self::Driven => "driven",
            Self::Two => "ssp2",
        }
    }

    /// The attribute `version`.
    fn version(self) -> &'static str {
        match self {
            Self::Closed | Self::Driven => "1.0",
            Self::Two => "2.0",
        }
    }

    /// Of the units.
    fn of_units(self) -> Form {
        match self {
            Self::Closed | Self::Driven => Form::FMI2,
            Self::Two => Form::FMI3,
        }
    }

    fn has_system_connectors(self) -> bool {
        self != Self::Closed
    }
}

/// Instance of a unit in a system.
struct Component {
    /// The unit's. Importers that cut names at dots would take `controller.kp` for a variable of `controller`.
    name: &'static str,
    unit: &'static UnitType,
    /// Wires that end here: output of the other unit and own input.
    wired: &'static [(&'static str, &'static str)],
}

impl Component {
    /// Controller and plant, in the order in which a master that steps one after the other should take them.
    fn all_of(system: &System) -> [Self; 2] {
        [(system.controller, system.sensing), (system.plant, system.actuation)].map(|(unit, wired)| Self {
            name: unit.description.name,
            unit,
            wired,
        })
    }

    fn unit_path(&self) -> String {
        format!("resources/{}.fmu", self.name)
    }

    fn parameters_path(&self) -> String {
        format!("resources/{}.ssv", self.name)
    }
}

/// All files of the package of one system, sorted by path. `start_values` are those that somebody wants other than
/// the system's.
pub fn contents(
    system: &'static System,
    form: SystemForm,
    start_values: &[(&'static Description, StartValues)],
    time: GenerationTime,
    libraries: &[Library],
) -> Result<Vec<Entry<'static>>, PackageError> {
    let in_words = |source| PackageError::SystemStructure { system: system.name, source };
    let structure = description::SystemStructureDescription::new(system, form, time);
    let structure = document("ssd:SystemStructureDescription", &structure).map_err(in_words)?;
    let mut entries = vec![
        Entry::document("SystemStructure.ssd".to_owned(), owned(structure)),
        Entry::document("documentation/index.html".to_owned(), owned(page::page(system, form, time))),
        Entry::document(
            format!("documentation/{}", diagram_name(system.name)),
            owned(loop_diagram(system, None)),
        ),
    ];
    for component in Component::all_of(system) {
        let description = component.unit.description;
        let mut values = system
            .start_values(description)
            .map_err(|source| PackageError::SystemStart { system: system.name, source })?;
        if let Some((_, wanted)) = start_values.iter().find(|(unit, _)| std::ptr::eq(*unit, description)) {
            values = values
                .overridden_by(wanted)
                .map_err(|source| PackageError::SystemStart { system: system.name, source: source.into() })?;
        }
        let unit = unit_package(description, &values, form.of_units(), time, libraries)?;
        entries.push(Entry::document(component.unit_path(), unit.into()));
        let parameters = parameters::ParameterSet::new(system, description, &values, form, time);
        let text = document("ssv:ParameterSet", &parameters).map_err(in_words)?;
        entries.push(Entry::document(component.parameters_path(), owned(text)));
    }
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(entries)
}

/// The package of a unit as it goes into a system.
fn unit_package(
    description: &'static Description,
    start_values: &StartValues,
    form: Form,
    time: GenerationTime,
    libraries: &[Library],
) -> Result<Vec<u8>, PackageError> {
    let entries = super::contents(description, start_values, form, time, libraries)?;
    let path = || std::path::Path::new(description.name).with_extension("fmu");
    archive(&entries, time).map_err(|source| PackageError::Archive { path: path(), source })
}
