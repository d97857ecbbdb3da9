//! Terminals of the models and system structure packages say what the table of systems says.

use std::collections::{BTreeMap, BTreeSet};

use maglev_fmu::model::models;
use maglev_fmu::model::system::{System, systems};
use maglev_fmu::model::variable::{Causality, Kind};
use maglev_fmu::package::{FmiVersion, SystemForm};

use super::built_packages::{model_file, ssp_version, system_file};
use super::xml::Element;

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
    for version in FmiVersion::ALL {
        let terminals: BTreeMap<&str, Element> = models()
            .map(|model| {
                let file = model_file(version, model, "terminalsAndIcons/terminalsAndIcons.xml");
                (model.description.name, Element::parse(&file))
            })
            .collect();
        for System { name, plant, controller, sensing, actuation, .. } in systems() {
            let [plant, controller] = [plant, controller].map(|model| {
                let all = terminals[model.description.name].child("Terminals");
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

/// Whether packages of a form have connectors of the system itself.
fn is_driven(form: SystemForm) -> bool {
    form != SystemForm::Closed
}

fn structure(form: SystemForm, system: &'static System) -> Element {
    Element::parse(&String::from_utf8(system_file(form, system, "SystemStructure.ssd")).unwrap())
}

/// Component called `name` of a system structure.
fn component<'a>(structure: &'a Element, name: &str) -> &'a Element {
    let mut components = structure.child("ssd:System").child("ssd:Elements").children.iter();
    components.find(|component| component.attribute("name") == Some(name)).unwrap()
}

/// Unit of measure, if any, and kind of a connector of a component or system.
fn connector<'a>(element: &'a Element, name: &str) -> (Option<&'a str>, &'a str) {
    let mut connectors = element.child("ssd:Connectors").children.iter();
    let connector = connectors.find(|connector| connector.attribute("name") == Some(name)).unwrap();
    (connector.children[0].attribute("unit"), connector.attribute("kind").unwrap())
}

/// Start element, start connector, end element, end connector; no element is the system.
type Wire = [Option<String>; 4];

fn wires(structure: &Element) -> Vec<Wire> {
    let connections = structure.child("ssd:System").child("ssd:Connections");
    let ends = ["startElement", "startConnector", "endElement", "endConnector"];
    let wire = |wire: &Element| ends.map(|end| wire.attribute(end).map(str::to_owned));
    connections.children.iter().map(wire).collect()
}

#[test]
fn systems_are_wired_as_the_table_says() {
    for form in SystemForm::ALL {
        for system in systems() {
            let structure = structure(form, system);
            assert_eq!(structure.attribute("version"), Some(ssp_version(form)));
            let [plant, controller] = [system.plant, system.controller].map(|model| model.description.name);
            let inner: BTreeSet<Wire> = wires(&structure)
                .into_iter()
                .filter(|[start, _, end, _]| start.is_some() && end.is_some())
                .collect();
            let wire = |from: &str, output: &str, to: &str, input: &str| {
                [from, output, to, input].map(|part| Some(part.to_owned()))
            };
            let sensing = system.sensing.iter().map(|(output, input)| wire(plant, output, controller, input));
            let actuation =
                system.actuation.iter().map(|(output, input)| wire(controller, output, plant, input));
            assert_eq!(inner, sensing.chain(actuation).collect());
            check_ends(&structure);
        }
    }
}

/// Both ends of every wire exist, fit, and have a unit of measure that is defined; every input that is a connector is
/// the end of one wire, which FMPy needs.
fn check_ends(structure: &Element) {
    let system = structure.child("ssd:System");
    let owner = |element: &Option<String>| element.as_ref().map_or(system, |name| component(structure, name));
    let units = structure.child("ssd:Units").children.iter();
    let units: BTreeSet<&str> = units.map(|unit| unit.attribute("name").unwrap()).collect();
    let mut reached = BTreeMap::new();
    let all = wires(structure);
    for wire @ [start, output, end, input] in &all {
        let (output, input) = (output.as_ref().unwrap(), input.as_ref().unwrap());
        let (from, to) = (connector(owner(start), output), connector(owner(end), input));
        assert_eq!(from.1, if start.is_some() { "output" } else { "input" }, "{wire:?}");
        assert_eq!(to.1, if end.is_some() { "input" } else { "output" }, "{wire:?}");
        assert_eq!(from.0, to.0, "{wire:?}");
        assert!(units.contains(from.0.unwrap()), "{wire:?}");
        *reached.entry((end.clone(), input.clone())).or_insert(0) += 1;
    }
    assert!(reached.values().all(|count| *count == 1), "{reached:?}");
    for component in &system.child("ssd:Elements").children {
        for connector in &component.child("ssd:Connectors").children {
            if connector.attribute("kind") == Some("input") {
                let [element, name] =
                    [component, connector].map(|part| part.attribute("name").unwrap().to_owned());
                assert!(reached.contains_key(&(Some(element), name.clone())), "{name}");
            }
        }
    }
}

#[test]
fn what_the_loop_leaves_open_is_a_connector_of_the_system() {
    for form in SystemForm::ALL.into_iter().filter(|form| is_driven(*form)) {
        for system in systems() {
            let structure = structure(form, system);
            let all = wires(&structure);
            let inputs: BTreeSet<_> =
                all.iter().filter(|wire| wire[0].is_none()).map(|wire| (&wire[2], &wire[3])).collect();
            let outputs: BTreeSet<_> =
                all.iter().filter(|wire| wire[2].is_none()).map(|wire| (&wire[0], &wire[1])).collect();
            let ends = [(system.controller, system.sensing), (system.plant, system.actuation)];
            let of = |causality: Causality| {
                ends.into_iter().flat_map(move |(model, wired)| {
                    let rows = model.description.variables.iter();
                    let is_real = |kind| matches!(kind, Kind::Real(_));
                    let rows = rows.filter(move |row| row.causality == causality && is_real(row.kind));
                    let is_free = move |name| !wired.iter().any(|(_, input)| *input == name);
                    let rows =
                        rows.filter(move |row| row.causality == Causality::Output || is_free(row.name));
                    rows.map(move |row| (model.description.name, row.name))
                })
            };
            let owned = |(element, name): (&str, &str)| (Some(element.to_owned()), Some(name.to_owned()));
            let expected: BTreeSet<_> = of(Causality::Input).map(owned).collect();
            assert_eq!(inputs, expected.iter().map(|(a, b)| (a, b)).collect(), "{}", system.name);
            let expected: BTreeSet<_> = of(Causality::Output).map(owned).collect();
            assert_eq!(outputs, expected.iter().map(|(a, b)| (a, b)).collect(), "{}", system.name);
            let names = structure.child("ssd:System").child("ssd:Connectors").children.iter();
            assert_eq!(names.len(), inputs.len() + outputs.len());
        }
    }
}

/// Some importers refuse wires from and to the system itself.
#[test]
fn closed_packages_have_no_connectors_of_the_system() {
    for system in systems() {
        let structure = structure(SystemForm::Closed, system);
        assert!(wires(&structure).iter().all(|wire| wire.iter().all(Option::is_some)));
        assert_eq!(structure.child("ssd:System").children_named("ssd:Connectors").count(), 0);
    }
}

/// Importers that cut names at dots take a variable `controller.kp` for one of an element `controller`.
#[test]
fn no_variable_begins_with_the_name_of_an_element() {
    for system in systems() {
        let structure = structure(SystemForm::Closed, system);
        for element in &structure.child("ssd:System").child("ssd:Elements").children {
            let name = element.attribute("name").unwrap();
            for model in [system.plant, system.controller] {
                let rows = model.description.variables.iter();
                assert!(rows.into_iter().all(|row| row.name.split('.').next() != Some(name)), "{name}");
            }
        }
    }
}

#[test]
fn the_step_is_where_importers_look_for_it() {
    for form in SystemForm::ALL {
        for system in systems() {
            let structure = structure(form, system);
            let experiment = structure.child("ssd:DefaultExperiment");
            let number =
                |element: &Element, name: &str| element.attribute(name).unwrap().parse::<f64>().unwrap();
            let for_cosim = experiment.child("ssd:Annotations").child("ssc:Annotation");
            assert_eq!(for_cosim.attribute("type"), Some("com.opensimulationplatform"));
            let step = for_cosim.child("osp:Algorithm").child("osp:FixedStepAlgorithm");
            assert_eq!(number(step, "baseStepSize"), system.step_size());
            let annotations = structure.child("ssd:System").child("ssd:Annotations");
            let for_omsimulator = annotations.child("ssc:Annotation");
            assert_eq!(for_omsimulator.attribute("type"), Some("org.openmodelica"));
            let information = for_omsimulator.child("oms:Annotations").child("oms:SimulationInformation");
            let master = information.child("oms:FixedStepMaster");
            assert_eq!(number(master, "stepSize"), system.step_size());
            assert_eq!(number(experiment, "stopTime"), system.stop_time());
        }
    }
}
