//! Parameters that do not fit together are refused by every command that takes some, in the words of the model's own check.

use std::fs;
use std::path::Path;
use std::process::Command;

use maglev_fmu::model::ModelType;
use maglev_fmu::model::system::System;
use maglev_fmu::parameter_file::ParameterFile;
use object::Architecture;
use serde_json::json;

use crate::library_file;

/// System, whether its plant or its controller, and values that do not fit together.
type Misfit = (&'static str, &'static str, &'static [(&'static str, f64)]);

const MISFITS: [Misfit; 5] = [
    ("ball", "controller", &[("observer.prefilter[1]", 200.0), ("observer.prefilter[2]", 200.0)]),
    ("rig", "controller", &[("controller.kind", 2.0), ("controller.input_gain", 0.0)]),
    ("rig", "plant", &[("sensor.sample_time", 1e-9)]),
    ("ball", "plant", &[("sensor.sample_time", 1e-9)]),
    ("bearing", "plant", &[("sensor.sample_time", 1e-9)]),
];

fn model(system: &str, role: &str) -> &'static ModelType {
    let system = System::find(system).unwrap();
    if role == "plant" { system.plant } else { system.controller }
}

/// What the model itself says of the values.
fn refusal(model: &ModelType, values: &[(&str, f64)]) -> String {
    let mut made = (model.create)();
    for (name, value) in values {
        let (reference, variable) = model.description.find(name).unwrap();
        variable.check(*value).unwrap();
        made.values_mut()[reference] = *value;
    }
    made.check_parameters().unwrap_err().to_string()
}

/// Status and standard error of the program.
fn maglev_fmu(directory: &Path, arguments: &[String]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maglev-fmu"));
    let output = command.current_dir(directory).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// Guards: the last one taken without a word.
#[test]
fn a_name_given_twice_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = ["trace", "ball", "--steps", "1", "--plant", "mass=0.1", "--plant", "mass=0.2"];
    let (status, message) = maglev_fmu(directory.path(), &arguments.map(str::to_owned));
    assert_eq!((status, message.as_str()), (Some(1), "error: mass is given twice\n"));
}

/// Guards: the limit of the controller, which the plant refused in turn.
#[test]
fn a_trace_names_a_step_that_both_models_accept() {
    let directory = tempfile::tempdir().unwrap();
    for system in ["bearing", "ball", "rig"] {
        let trace = |step: &str| {
            let arguments = ["trace", system, "--steps", "1", "--step-size", step];
            maglev_fmu(directory.path(), &arguments.map(str::to_owned))
        };
        let (status, message) = trace("1e5");
        assert_eq!(status, Some(1));
        let (_, rest) = message.split_once("expected at most ").expect("a limit");
        let (limit, _) = rest.split_once(" s").unwrap();
        // Half of it, for all of it computes for a second.
        let half = limit.parse::<f64>().unwrap() / 2.0;
        assert_eq!(trace(&half.to_string()), (Some(0), String::new()), "{system}: {limit}");
    }
}

/// Guards: a key that writes a line of its own into the message.
#[test]
fn keys_are_told_in_one_line() {
    let directory = tempfile::tempdir().unwrap();
    let model = json!("MaglevRigController");
    for file in [
        json!({ "model": model, "values": {}, "a\nerror: b\r\u{1b}[2J": 1 }),
        json!({ "model": model, "values": { "a\nerror: b\r\u{1b}[2J": 1 } }),
        json!({ "model": "a\nerror: b\r\u{1b}[2J", "values": {} }),
    ] {
        fs::write(directory.path().join("file.json"), file.to_string()).unwrap();
        let (status, message) = maglev_fmu(directory.path(), &words("build --parameters file.json"));
        assert_eq!(status, Some(1));
        assert!(message.contains(r"a\nerror: b\r\u{1b}[2J"), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

fn words(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}

#[test]
fn a_trace_starts_with_parameters_that_fit() {
    let directory = tempfile::tempdir().unwrap();
    for (system, role, values) in MISFITS {
        let mut arguments = words(&format!("trace {system} --steps 1"));
        for (name, value) in values {
            let assignment = match *name {
                "controller.kind" => format!("{name}=disturbance_rejection"),
                _ => format!("{name}={value:e}"),
            };
            arguments.extend([format!("--{role}"), assignment]);
        }
        let said = refusal(model(system, role), values);
        assert_eq!(maglev_fmu(directory.path(), &arguments), (Some(1), format!("error: {said}\n")));
    }
}

/// Guards: packages whose models can never be initialised.
#[test]
fn no_package_starts_with_parameters_that_do_not_fit() {
    let directory = tempfile::tempdir().unwrap();
    let library = library_file::write_library(directory.path(), Architecture::X86_64);
    for (system, role, values) in MISFITS {
        let model = model(system, role);
        let said = refusal(model, values);
        let values: serde_json::Map<_, _> =
            values.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect();
        let file = json!({ "model": model.description.name, "values": &values });
        fs::write(directory.path().join("misfit.json"), file.to_string()).unwrap();
        let arguments = format!("build --parameters misfit.json --library {}", library.display());
        let expected = (Some(1), format!("error: misfit.json: {said}\n"));
        assert_eq!(maglev_fmu(directory.path(), &words(&arguments)), expected);
        assert!(!directory.path().join("dist").exists());

        let assignments = values.iter().map(|(name, value)| (name.as_str(), value.clone()));
        let refused = ParameterFile::new(model.description, assignments, json!(null)).unwrap_err();
        assert_eq!(refused.to_string(), said, "a file that could not be read again");
    }
}
