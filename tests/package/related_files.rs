//! Packaged models answer the reference input that travels with them with the reference output, to the last bit.

use std::collections::BTreeSet;
use std::path::Path;

use maglev_fmu::host::{Instance, Logging};
use maglev_fmu::model::MODELS;
use maglev_fmu::package::{Form, REFERENCE_INPUT, REFERENCE_OUTPUT, RELATED_FILES};
use maglev_fmu_test::packages;

use super::xml::Element;

/// Times and values of a table.
struct Table {
    names: Vec<String>,
    rows: Vec<(f64, Vec<f64>)>,
}

fn read(path: &Path) -> Table {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(names[0], "time");
    let rows = reader.records().map(|record| {
        let numbers: Vec<f64> = record.unwrap().iter().map(|text| text.parse().unwrap()).collect();
        (numbers[0], numbers[1..].to_vec())
    });
    Table { rows: rows.collect(), names: names[1..].to_vec() }
}

fn bits(model: &Instance, names: &[String]) -> Vec<u64> {
    names.iter().map(|name| model.get_by_name(name).unwrap().to_bits()).collect()
}

fn set(model: &mut Instance, names: &[String], values: &[f64]) {
    names.iter().zip(values).for_each(|(name, value)| model.set_by_name(name, *value).unwrap());
}

/// Importers differ in whether the first row of inputs is set before the end of the initialisation.
#[test]
fn packages_give_the_reference_output_whenever_the_first_inputs_are_set() {
    for model in MODELS {
        let name = model.description.name;
        for form in Form::all_of(model.description) {
            let fmu = packages::open(form, name);
            let directory = fmu.directory().join(RELATED_FILES);
            let (inputs, outputs) =
                (read(&directory.join(REFERENCE_INPUT)), read(&directory.join(REFERENCE_OUTPUT)));
            assert_eq!(outputs.rows.len(), inputs.rows.len() + 1);
            for is_early in [false, true] {
                let mut instance = fmu.instantiate(name, Logging::On).unwrap();
                if is_early {
                    set(&mut instance, &inputs.names, &inputs.rows[0].1);
                }
                instance.initialise(0.0, None).unwrap();
                for (step, (time, expected)) in outputs.rows.iter().enumerate() {
                    let expected: Vec<u64> = expected.iter().map(|value| value.to_bits()).collect();
                    let habit = if is_early { "before" } else { "after" };
                    assert!(
                        bits(&instance, &outputs.names) == expected,
                        "{name}, {form:?}, inputs {habit} initialisation, at {time} s"
                    );
                    if let Some((begin, values)) = inputs.rows.get(step) {
                        set(&mut instance, &inputs.names, values);
                        instance.step(*begin, model.description.step_size).unwrap();
                    }
                }
            }
        }
    }
}

#[test]
fn the_manifest_names_files_of_the_package() {
    let fmu = packages::open(Form::FMI2, MODELS[0].description.name);
    let directory = fmu.directory().join(RELATED_FILES);
    let manifest = Element::parse(&std::fs::read_to_string(directory.join("fmi-ls-manifest.xml")).unwrap());
    assert_eq!(manifest.attribute("fmi-ls:fmi-ls-name"), Some("org.fmi-standard.fmi-ls-ref"));
    let related: BTreeSet<&str> =
        manifest.children.iter().map(|file| file.attribute("source").unwrap()).collect();
    for source in &related {
        assert!(directory.join(source).is_file(), "{source}");
    }
    assert!(related.contains(REFERENCE_INPUT) && related.contains(REFERENCE_OUTPUT));
}
