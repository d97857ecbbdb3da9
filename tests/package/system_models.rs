//! Models inside system structure packages, and the parameter sets beside them, start as the loop needs it.

use std::collections::BTreeSet;
use std::io::{Cursor, Read};

use maglev_fmu::model::system::{BEARING, systems};
use maglev_fmu::model::variable::{Causality, Kind};
use maglev_fmu::model::{Description, Edition, StartValues};
use maglev_fmu::package::SystemForm;
use zip::ZipArchive;

use super::built_packages::{bytes, packages_with, path, ssp_version, system_file};
use super::xml::Element;

/// The model description of a model in a package of a system.
fn description_inside(fmu: Vec<u8>) -> Element {
    let mut archive = ZipArchive::new(Cursor::new(fmu)).unwrap();
    let mut description = String::new();
    archive.by_name("modelDescription.xml").unwrap().read_to_string(&mut description).unwrap();
    Element::parse(&description)
}

/// Where a model is in a package of a system.
fn inside(model: &Description) -> String {
    format!("resources/{}.fmu", model.name)
}

fn token(description: &Element) -> &str {
    description.attribute("guid").or(description.attribute("instantiationToken")).unwrap()
}

/// Importers ignore parameter sets or take no enumerations, so the models have to start by themselves as they should.
#[test]
fn systems_hold_models_that_start_as_the_loop_needs() {
    for form in SystemForm::ALL {
        for system in systems() {
            let document =
                |member: &str| Element::parse(&String::from_utf8(system_file(form, system, member)).unwrap());
            let structure = document("SystemStructure.ssd");
            for model in [system.plant, system.controller] {
                let starts = system.start_values(model.description).unwrap();
                let inside = description_inside(system_file(form, system, &inside(model.description)));
                let version = if form == SystemForm::Two { "3.0" } else { "2.0" };
                assert_eq!(inside.attribute("fmiVersion"), Some(version));
                assert_eq!(token(&inside), starts.token(model.description, Edition::Plain));
                let mut components = structure.child("ssd:System").child("ssd:Elements").children.iter();
                let name = Some(model.description.name);
                let component = components.find(|element| element.attribute("name") == name).unwrap();
                let bindings = &component.child("ssd:ParameterBindings").children;
                assert_eq!(bindings.len(), 1);
                let parameters = document(bindings[0].attribute("source").unwrap());
                assert_eq!(parameters.attribute("version"), Some(ssp_version(form)));
                check_parameters(&parameters, model.description, &starts, form);
            }
        }
    }
}

#[test]
fn start_values_of_the_user_go_before_those_of_the_system() {
    let model = BEARING.controller.description;
    let mut wanted = StartValues::default();
    wanted.set(model, "observer.voltage_source", 1.0).unwrap();
    wanted.set(model, "controller.k1", 2.0).unwrap();
    let directory = packages_with(&[(model, wanted.clone())]);
    let expected = BEARING.start_values_with(model, &wanted).unwrap();
    assert!(expected.token(model, Edition::Plain).contains("=2.0"));
    for form in SystemForm::ALL {
        let fmu = bytes(&path(directory.path(), form, &BEARING), &inside(model));
        assert_eq!(token(&description_inside(fmu)), expected.token(model, Edition::Plain));
    }
}

/// Guards: packages with another sample time that named the step of the table.
#[test]
fn another_sample_time_brings_its_own_step() {
    let model = BEARING.controller.description;
    let mut wanted = StartValues::default();
    wanted.set(model, "sample_time", 5e-4).unwrap();
    let directory = packages_with(&[(model, wanted.clone())]);
    let expected = BEARING.start_values_with(model, &wanted).unwrap();
    for form in SystemForm::ALL {
        let package = path(directory.path(), form, &BEARING);
        assert_eq!(
            token(&description_inside(bytes(&package, &inside(model)))),
            expected.token(model, Edition::Plain)
        );
        let structure = String::from_utf8(bytes(&package, "SystemStructure.ssd")).unwrap();
        for step in ["baseStepSize=\"0.0005\"", "stepSize=\"0.0005\""] {
            assert!(structure.contains(step), "{structure}");
        }
    }
}

fn check_parameters(set: &Element, description: &Description, starts: &StartValues, form: SystemForm) {
    let [real, integer] =
        if form == SystemForm::Two { ["ssv:Float64", "ssv:Int32"] } else { ["ssv:Real", "ssv:Integer"] };
    let units: BTreeSet<&str> =
        set.child("ssv:Units").children.iter().map(|unit| unit.attribute("name").unwrap()).collect();
    let parameters = &set.child("ssv:Parameters").children;
    for parameter in parameters {
        let name = parameter.attribute("name").unwrap();
        let (reference, variable) = description.find(name).unwrap();
        let start = starts.of(reference, variable);
        assert_eq!(variable.causality, Causality::Parameter);
        let typed = &parameter.children[0];
        let value = typed.attribute("value").unwrap();
        match variable.kind {
            Kind::Real(quantity) => {
                assert_eq!((typed.name.as_str(), value.parse()), (real, Ok(start)), "{name}");
                assert_eq!(typed.attribute("unit"), Some(quantity.unit.name));
                assert!(units.contains(quantity.unit.name));
            }
            Kind::Integer => {
                assert_eq!((typed.name.as_str(), value.parse()), (integer, Ok(start)), "{name}");
            }
            _ => {
                assert_eq!((typed.name.as_str(), value == "true"), ("ssv:Boolean", start != 0.0), "{name}");
            }
        }
    }
    let is_in_set = |kind: Kind| matches!(kind, Kind::Real(_) | Kind::Integer | Kind::Boolean);
    let rows = description.variables.iter();
    let expected = rows.filter(|row| row.causality == Causality::Parameter && is_in_set(row.kind)).count();
    assert_eq!(parameters.len(), expected);
}
