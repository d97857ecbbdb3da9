//! System structure packages (SSP 1.0.1): a plant and its controller, wired, with a file of parameters for each.
//!
//! Prefixes of namespaces are those of the standard's text; not every importer resolves others. The units are those
//! for FMI 2.0, which SSP 1.0 knows. Connections run from unit to unit, and only wired inputs are connectors: not
//! every importer takes connectors of the system itself, or inputs that nothing is connected to.

mod description;
mod parameters;

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::contents::{Entry, diagram_name, owned};
use super::documentation::STYLE;
use super::loop_diagram::loop_diagram;
use super::model_description::document;
use super::{Form, GenerationTime, PackageError};
use crate::unit::system::System;
use crate::unit::{StartValues, UnitType};

const COMMON: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const DESCRIPTION: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const PARAMETER_VALUES: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
const VERSION: &str = "1.0";

/// Form of the units in a system.
pub const FORM: Form = Form::FMI2;

/// Instance of a unit in a system.
struct Component {
    name: &'static str,
    unit: &'static UnitType,
    /// Wires that end here: output of the other unit and own input.
    wired: &'static [(&'static str, &'static str)],
}

impl Component {
    /// Controller and plant, in the order in which a master that steps one after the other should take them.
    fn all_of(system: &System) -> [Self; 2] {
        [
            Self { name: "controller", unit: system.controller, wired: system.sensing },
            Self { name: "plant", unit: system.plant, wired: system.actuation },
        ]
    }

    fn unit_path(&self) -> String {
        format!("resources/{}.fmu", self.unit.description.name)
    }

    fn parameters_path(&self) -> String {
        format!("resources/{}.ssv", self.name)
    }
}

/// All files of the package of one system, sorted by path. `units` are the packages of all units by name, made in the
/// form [`FORM`], with their start values.
pub fn contents<'a>(
    system: &'static System,
    time: GenerationTime,
    units: &'a BTreeMap<&str, (Vec<u8>, &StartValues)>,
) -> Result<Vec<Entry<'a>>, PackageError> {
    let in_words = |source| PackageError::SystemStructure { system: system.name, source };
    let structure = description::SystemStructureDescription::new(system, time);
    let structure = document("ssd:SystemStructureDescription", &structure).map_err(in_words)?;
    let mut entries = vec![
        Entry::document("SystemStructure.ssd".to_owned(), owned(structure)),
        Entry::document("documentation/index.html".to_owned(), owned(page(system, time))),
        Entry::document(
            format!("documentation/{}", diagram_name(system.name)),
            owned(loop_diagram(system, None)),
        ),
    ];
    for component in Component::all_of(system) {
        let description = component.unit.description;
        let (unit, start_values) = units
            .get(description.name)
            .ok_or(PackageError::UnknownUnit { system: system.name, unit: description.name })?;
        entries.push(Entry::document(component.unit_path(), Cow::Borrowed(unit)));
        let parameters = parameters::ParameterSet::new(system, description, start_values, time);
        let text = document("ssv:ParameterSet", &parameters).map_err(in_words)?;
        entries.push(Entry::document(component.parameters_path(), owned(text)));
    }
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(entries)
}

/// First page of the documentation.
fn page(system: &System, time: GenerationTime) -> String {
    let diagram = diagram_name(system.name);
    let [controller, plant] = [system.controller, system.plant].map(|unit| unit.description);
    let (controller_file, plant_file) = (controller.name, plant.name);
    format!(
        "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<title>{name}</title>
<style>
{STYLE}</style>
</head>
<body>
<h1>{name}</h1>
<p><img src=\"{diagram}\" alt=\"{controller_file} and {plant_file} in a loop\"></p>
<p><code>controller</code>: {}. <code>plant</code>: {}. Their own documentation is inside
<code>resources/{controller_file}.fmu</code> and <code>resources/{plant_file}.fmu</code>.</p>
<p>Suggested communication step: {:?} s. A master that steps both at once and then exchanges values delays what acts on
the plant by one step; choose <code>observer.voltage_source = applied</code> there.</p>
<p>Parameters are in <code>resources/controller.ssv</code> and <code>resources/plant.ssv</code>, at their start values
and ready to be changed. Choices (enumerations) are not among them, since not every importer takes these files with
enumerations; set them in the tool.</p>
<p>Written by maglev-fmu {}, source as of {time}.</p>
</body>
</html>
",
        controller.summary,
        plant.summary,
        controller.step_size.min(plant.step_size),
        env!("CARGO_PKG_VERSION"),
        name = system.name,
    )
}
