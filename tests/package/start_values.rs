//! Packages with start values of their own: description and library agree, whatever an importer sets.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use maglev_fmu::host::{Fmu, Instance, Logging};
use maglev_fmu::model::MAGNETIC_BEARING_CONTROLLER as CONTROLLER;
use maglev_fmu::package::{self, Form, GenerationTime, Library};
use maglev_fmu::parameter_file::ParameterFile;
use serde_json::json;

const VALUES: [(&str, f64); 3] =
    [("controller.k1", 0.1 + 0.2), ("controller.initial_voltage", -75.0), ("observer.kind", 4.0)];

/// Packages whose controller starts with [`VALUES`], made once for all tests.
static PACKAGES: LazyLock<PathBuf> = LazyLock::new(|| {
    let file = ParameterFile::new(
        CONTROLLER.description,
        VALUES.map(|(name, value)| (name, value.into())),
        json!(null),
    )
    .unwrap();
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("package_start_values");
    let library = Library::of_this_build().unwrap();
    let time = GenerationTime::of_this_build().unwrap();
    package::build_with(&directory, &[file.start_values().unwrap()], &[library], time).unwrap();
    directory
});

fn open(packages: &Path, form: Form) -> Fmu {
    Fmu::open(&packages.join(form.directory()).join("MagneticBearingController.fmu")).unwrap()
}

fn voltage_of_first_tick(instance: &mut Instance) -> f64 {
    instance.initialise(0.0, None).unwrap();
    instance.step(0.0, 1e-3).unwrap();
    instance.get_by_name("voltage").unwrap()
}

#[test]
fn library_starts_with_what_the_description_says() {
    for form in Form::all_of(CONTROLLER.description) {
        let fmu = open(&PACKAGES, form);
        // Nothing is set.
        let mut instance = fmu.instantiate("controller", Logging::Off).unwrap();
        instance.initialise(0.0, None).unwrap();
        for variable in CONTROLLER.description.variables.iter().filter(|variable| !variable.is_calculated()) {
            let own = VALUES.iter().find(|(name, _)| *name == variable.name);
            let expected = own.map_or(variable.start, |(_, value)| *value);
            let value = instance.get_by_name(variable.name).unwrap();
            assert_eq!(value.to_bits(), expected.to_bits(), "{}", variable.name);
        }
        let xml = std::fs::read_to_string(fmu.directory().join("modelDescription.xml")).unwrap();
        let row = xml.split('<').position(|element| element.contains("name=\"controller.k1\"")).unwrap();
        let near: String = xml.split('<').skip(row).take(2).collect();
        assert!(near.contains("start=\"0.30000000000000004\""), "{near}");

        instance.reset().unwrap();
        assert_eq!(voltage_of_first_tick(&mut instance), -75.0, "after a reset");
    }
}

#[test]
fn start_values_can_still_be_set() {
    for form in Form::all_of(CONTROLLER.description) {
        let mut instance = open(&PACKAGES, form).instantiate("controller", Logging::Off).unwrap();
        instance.set_by_name("controller.initial_voltage", -20.0).unwrap();
        assert_eq!(voltage_of_first_tick(&mut instance), -20.0);
    }
}

#[test]
fn a_forged_start_value_is_refused() {
    for form in Form::all_of(CONTROLLER.description) {
        let fmu = open(&PACKAGES, form);
        let token = form.edition.token(CONTROLLER.description);
        let (reference, _) = CONTROLLER.description.find("sample_time").unwrap();
        for (tail, reason) in [
            (format!(";{reference}=-1.0"), "expected 1e-6 to 1 s"),
            (format!(";{reference}"), "expected ;value reference=value"),
        ] {
            let forged = format!("{}{tail}", token.as_str());
            let error = fmu.instantiate_with_token("forged", &forged, Logging::On).unwrap_err();
            assert!(error.to_string().contains(reason), "{error}");
        }
    }
}

#[test]
fn parameter_sets_of_the_system_agree() {
    let file = std::fs::File::open(PACKAGES.join("bearing.ssp")).unwrap();
    let mut archive = zip::ZipArchive::new(file).unwrap();
    let mut text = String::new();
    archive.by_name("resources/MagneticBearingController.ssv").unwrap().read_to_string(&mut text).unwrap();
    let of = |name: &str| {
        let from = text.find(&format!("name=\"{name}\"")).unwrap();
        text[from..].split("value=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap()
    };
    assert_eq!(of("controller.k1"), 0.1 + 0.2);
    assert_eq!(of("controller.initial_voltage"), -75.0);
    assert_eq!(of("controller.k2"), 9.94);
}
