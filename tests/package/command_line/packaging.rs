//! The commands `build` and `describe`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use object::Architecture;

use crate::library_file;

fn maglev_fmu(directory: &Path, arguments: &[&str], time: Option<&str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maglev-fmu"));
    command.current_dir(directory).args(arguments).env_remove("SOURCE_DATE_EPOCH");
    command.envs(time.map(|time| ("SOURCE_DATE_EPOCH", time)));
    command.output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn write_library(directory: &Path) {
    fs::rename(library_file::write_library(directory, Architecture::X86_64), directory.join("library.so"))
        .unwrap();
}

#[test]
fn build_packs_and_reports() {
    let directory = tempfile::tempdir().unwrap();
    write_library(directory.path());
    let output = maglev_fmu(directory.path(), &["build", "--library", "library.so"], Some("1234567890"));
    let report = text(&output.stdout);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(report.contains("library.so for x86_64-linux, source as of 2009-02-13T23:31:30Z"), "{report}");
    for package in ["fmi2/MagneticBearingPlant.fmu", "fmi3/MagneticBearingController.fmu", "bearing.ssp"] {
        assert!(directory.path().join("dist").join(package).is_file());
        assert!(report.replace('\\', "/").contains(package), "{report}");
    }
}

#[test]
fn without_an_epoch_the_time_is_that_of_the_commit() {
    let directory = tempfile::tempdir().unwrap();
    write_library(directory.path());
    let arguments = ["build", "--library", "library.so", "--out", "somewhere"];
    let reports = [(); 2].map(|()| text(&maglev_fmu(directory.path(), &arguments, None).stdout));
    assert_eq!(reports[0], reports[1]);
    assert!(reports[0].contains("source as of ") && reports[0].contains("somewhere"), "{}", reports[0]);
}

#[test]
fn errors_name_the_value_and_the_cause() {
    let directory = tempfile::tempdir().unwrap();
    write_library(directory.path());
    for (arguments, time, expected) in [
        (["build", "--library", "missing.so"], None, ["error: cannot read missing.so", "because: "]),
        (
            ["build", "--library", "library.so"],
            Some("yesterday"),
            ["SOURCE_DATE_EPOCH = \"yesterday\"", "expected seconds"],
        ),
    ] {
        let output = maglev_fmu(directory.path(), &arguments, time);
        assert_eq!(output.status.code(), Some(1));
        let message = text(&output.stderr);
        assert!(expected.iter().all(|part| message.contains(part)), "{message}");
        assert!(!directory.path().join("dist").exists());
    }
}

/// Guards: twelve packages of a library that no importer can use.
#[cfg(target_os = "linux")]
#[test]
fn a_program_is_no_library() {
    let directory = tempfile::tempdir().unwrap();
    let output = maglev_fmu(directory.path(), &["build", "--library", "/bin/ls"], None);
    assert_eq!(output.status.code(), Some(1));
    let message = text(&output.stderr);
    assert!(message.contains("/bin/ls is no "), "{message}");
    assert!(!directory.path().join("dist").exists());
    let endless = maglev_fmu(directory.path(), &["build", "--library", "/dev/zero"], None);
    assert!(text(&endless.stderr).contains("larger than the "), "{}", text(&endless.stderr));
}

#[test]
fn describe_writes_below_the_given_root() {
    let directory = tempfile::tempdir().unwrap();
    let output = maglev_fmu(directory.path(), &["describe"], None);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for version in ["fmi2", "fmi3"] {
        let path = directory.path().join("modelDescription").join(version).join("MagneticBearingPlant.xml");
        assert!(path.is_file());
    }
    let page = directory.path().join("docs").join("models").join("MagneticBearingController.md");
    let page = fs::read_to_string(page).unwrap();
    assert!(page.starts_with("# MagneticBearingController\n"), "{page}");
}
