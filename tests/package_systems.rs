//! Terminals of the units and system structure packages say what the table of systems says.
#![cfg(feature = "tools")]

mod library_file;
#[allow(dead_code, reason = "each test uses a part")]
mod package_xml;

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use maglev_fmu::package::{FmiVersion, GenerationTime, Library, build};
use maglev_fmu::unit::system::{SYSTEMS, System};
use maglev_fmu::unit::variable::{Causality, Kind};
use maglev_fmu::unit::{Description, UNITS};
use object::Architecture;
use package_xml::Element;
use tempfile::TempDir;
use zip::ZipArchive;

/// All packages, with a file that passes for a library.
fn packages() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    let libraries =
        [Library::read(&library_file::write_library(directory.path(), Architecture::X86_64)).unwrap()];
    build(directory.path(), &libraries, GenerationTime::from_epoch_seconds(1_234_567_890)).unwrap();
    directory
}

fn text(package: &Path, member: &str) -> String {
    let mut archive = ZipArchive::new(File::open(package).unwrap()).unwrap();
    let mut text = String::new();
    archive.by_name(member).unwrap().read_to_string(&mut text).unwrap();
    text
}

/// Variable to member of a terminal.
fn members(terminal: &Element) -> BTreeMap<&str, &str> {
    let members: BTreeMap<&str, &str> = terminal
        .children_named("TerminalMemberVariable")
        .map(|member| (member.attribute("variableName").unwrap(), member.attribute("memberName").unwrap()))
        .collect();
    assert_eq!(members.len(), terminal.children.len());
    members
}

#[test]
fn terminals_of_a_loop_fit_each_other() {
    let directory = packages();
    for version in FmiVersion::ALL {
        let terminals: BTreeMap<&str, Element> = UNITS
            .iter()
            .map(|unit| {
                let name = unit.description.name;
                let package = directory.path().join(version.directory()).join(name).with_extension("fmu");
                (name, Element::parse(&text(&package, "terminalsAndIcons/terminalsAndIcons.xml")))
            })
            .collect();
        for System { name, plant, controller, sensing, actuation } in SYSTEMS {
            let [plant, controller] = [plant, controller].map(|unit| {
                let all = terminals[unit.description.name].child("Terminals");
                let mut found = all.children_named("Terminal");
                found.find(|terminal| terminal.attribute("name") == Some(*name)).unwrap()
            });
            for attribute in ["matchingRule", "terminalKind"] {
                assert!(plant.attribute(attribute).is_some());
                assert_eq!(plant.attribute(attribute), controller.attribute(attribute));
            }
            let (plant, controller) = (members(plant), members(controller));
            let wires =
                sensing.iter().copied().chain(actuation.iter().map(|(output, input)| (*input, *output)));
            let wires: BTreeSet<_> = wires.collect();
            assert_eq!((plant.len(), controller.len()), (wires.len(), wires.len()));
            for (of_plant, of_controller) in wires {
                assert_eq!(plant[of_plant], controller[of_controller], "{of_plant} to {of_controller}");
            }
        }
    }
}

/// Component called `name` of a system structure.
fn component<'a>(structure: &'a Element, name: &str) -> &'a Element {
    let mut components = structure.child("ssd:System").child("ssd:Elements").children.iter();
    components.find(|component| component.attribute("name") == Some(name)).unwrap()
}

/// Unit of measure, if any, and kind of a connector.
fn connector<'a>(component: &'a Element, name: &str) -> (Option<&'a str>, &'a str) {
    let mut connectors = component.child("ssd:Connectors").children.iter();
    let connector = connectors.find(|connector| connector.attribute("name") == Some(name)).unwrap();
    (connector.children[0].attribute("unit"), connector.attribute("kind").unwrap())
}

#[test]
fn systems_are_wired_as_the_table_says() {
    let directory = packages();
    for system in SYSTEMS {
        let package = directory.path().join(system.name).with_extension("ssp");
        let structure = Element::parse(&text(&package, "SystemStructure.ssd"));
        assert_eq!(structure.attribute("version"), Some("1.0"));
        let [plant, controller] = ["plant", "controller"].map(|name| component(&structure, name));
        let connections = structure.child("ssd:System").child("ssd:Connections");
        let connections: BTreeSet<[&str; 4]> = connections
            .children
            .iter()
            .map(|wire| {
                ["startElement", "startConnector", "endElement", "endConnector"]
                    .map(|end| wire.attribute(end).unwrap())
            })
            .collect();
        let sensing = system.sensing.iter().map(|(output, input)| ["plant", output, "controller", input]);
        let actuation = system.actuation.iter().map(|(output, input)| ["controller", output, "plant", input]);
        assert_eq!(connections, sensing.chain(actuation).collect());
        let units: BTreeSet<&str> = structure
            .child("ssd:Units")
            .children
            .iter()
            .map(|unit| unit.attribute("name").unwrap())
            .collect();
        for [start, output, end, input] in connections {
            let (from, to) = if start == "plant" { (plant, controller) } else { (controller, plant) };
            assert_ne!(start, end);
            let ((of_output, kind_of_output), (of_input, kind_of_input)) =
                (connector(from, output), connector(to, input));
            assert_eq!((kind_of_output, kind_of_input), ("output", "input"));
            assert_eq!(of_output, of_input, "{output} to {input}");
            assert!(units.contains(of_output.unwrap()));
        }
        // All inputs are wired; the standard asks for no others.
        for component in [plant, controller] {
            let inputs = component.child("ssd:Connectors").children.iter();
            let inputs = inputs.filter(|connector| connector.attribute("kind") == Some("input")).count();
            let wires =
                if component.attribute("name") == Some("plant") { system.actuation } else { system.sensing };
            assert_eq!(inputs, wires.len());
        }
    }
}

#[test]
fn systems_hold_the_units_and_their_start_values() {
    let directory = packages();
    for system in SYSTEMS {
        let package = directory.path().join(system.name).with_extension("ssp");
        let structure = Element::parse(&text(&package, "SystemStructure.ssd"));
        let mut archive = ZipArchive::new(File::open(&package).unwrap()).unwrap();
        for (name, unit) in [("plant", system.plant), ("controller", system.controller)] {
            let component = component(&structure, name);
            let mut inside = Vec::new();
            archive
                .by_name(component.attribute("source").unwrap())
                .unwrap()
                .read_to_end(&mut inside)
                .unwrap();
            let fmu = directory.path().join("fmi2").join(unit.description.name).with_extension("fmu");
            assert!(inside == fs::read(fmu).unwrap());
            let bindings = &component.child("ssd:ParameterBindings").children;
            assert_eq!(bindings.len(), 1);
            let parameters = Element::parse(&text(&package, bindings[0].attribute("source").unwrap()));
            check_parameters(&parameters, unit.description);
        }
    }
}

fn check_parameters(set: &Element, description: &Description) {
    let units: BTreeSet<&str> =
        set.child("ssv:Units").children.iter().map(|unit| unit.attribute("name").unwrap()).collect();
    let parameters = &set.child("ssv:Parameters").children;
    for parameter in parameters {
        let name = parameter.attribute("name").unwrap();
        let (_, variable) = description.find(name).unwrap();
        assert_eq!(variable.causality, Causality::Parameter);
        let typed = &parameter.children[0];
        let value = typed.attribute("value").unwrap();
        match variable.kind {
            Kind::Real(quantity) => {
                assert_eq!((typed.name.as_str(), value.parse()), ("ssv:Real", Ok(variable.start)), "{name}");
                assert_eq!(typed.attribute("unit"), Some(quantity.unit.name));
                assert!(units.contains(quantity.unit.name));
            }
            Kind::Integer => {
                assert_eq!(
                    (typed.name.as_str(), value.parse()),
                    ("ssv:Integer", Ok(variable.start)),
                    "{name}"
                );
            }
            _ => assert_eq!(
                (typed.name.as_str(), value == "true"),
                ("ssv:Boolean", variable.start != 0.0),
                "{name}"
            ),
        }
    }
    let is_in_set = |kind: Kind| matches!(kind, Kind::Real(_) | Kind::Integer | Kind::Boolean);
    let rows = description.variables.iter();
    let expected = rows.filter(|row| row.causality == Causality::Parameter && is_in_set(row.kind)).count();
    assert_eq!(parameters.len(), expected);
}
