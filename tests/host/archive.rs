//! The host refuses files that are no FMUs, or none for this platform, with clear errors and without panics.

use std::env::consts::DLL_EXTENSION;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use maglev_fmu::host::{Archive, Fmu, HostError};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::small_model;

const DESCRIPTION: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="Empty" instantiationToken="t">
  <CoSimulation modelIdentifier="Empty"/><ModelVariables/><ModelStructure/>
</fmiModelDescription>"#;

/// Writes an archive with these entries; the directory must outlive its use.
fn archive(entries: &[(&str, &[u8])]) -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("model.fmu");
    let mut zip = ZipWriter::new(File::create(&path).unwrap());
    for (name, content) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    (directory, path)
}

#[test]
fn an_entry_outside_the_directory_is_refused() {
    let (directory, path) =
        archive(&[("modelDescription.xml", DESCRIPTION.as_bytes()), ("a/../../escaped.txt", b"gotcha")]);
    let error = Archive::unpack(&path).unwrap_err();
    assert!(
        matches!(&error, HostError::EntryEscapes { entry, .. } if entry.contains("escaped.txt")),
        "{error}"
    );
    assert!(!directory.path().join("escaped.txt").exists());
    let temporary = std::env::temp_dir();
    assert!(!temporary.join("escaped.txt").exists());
}

#[test]
fn files_that_are_no_archives_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let absent = directory.path().join("absent.fmu");
    assert!(matches!(Fmu::open(&absent), Err(HostError::OpenArchive { path, .. }) if path == absent));
    let garbage = directory.path().join("garbage.fmu");
    std::fs::write(&garbage, b"PK\x03\x04 but not really").unwrap();
    assert!(matches!(Fmu::open(&garbage), Err(HostError::OpenArchive { .. })));

    let (_directory, path) = archive(&[("modelDescription.xml", DESCRIPTION.as_bytes())]);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    assert!(matches!(Fmu::open(&path), Err(HostError::OpenArchive { .. })));
}

#[test]
fn the_unpacked_files_go_with_the_archive() {
    let (_directory, path) =
        archive(&[("modelDescription.xml", DESCRIPTION.as_bytes()), ("resources/deep/y.txt", b"y")]);
    let unpacked = Archive::unpack(&path).unwrap();
    let root = unpacked.directory().to_owned();
    assert_eq!(std::fs::read(root.join("resources/deep/y.txt")).unwrap(), b"y");
    assert_eq!(unpacked.description().unwrap().model_name, "Empty");
    drop(unpacked);
    assert!(!root.exists());
}

#[test]
fn a_missing_or_broken_description_is_refused() {
    let (_directory, path) = archive(&[("resources/y.txt", b"y")]);
    assert!(matches!(Fmu::open(&path), Err(HostError::Description { .. })));
    let (_directory, path) = archive(&[("modelDescription.xml", b"\xff\xfe<")]);
    assert!(Fmu::open(&path).unwrap_err().to_string().contains("UTF-8"));
    let exchange_only = DESCRIPTION.replace("CoSimulation", "ModelExchange");
    let (_directory, path) = archive(&[("modelDescription.xml", exchange_only.as_bytes())]);
    assert!(matches!(Fmu::open(&path), Err(HostError::NoCoSimulation { model }) if model == "Empty"));
}

#[test]
fn a_library_for_another_platform_is_not_enough() {
    let (_directory, path) = archive(&[("modelDescription.xml", DESCRIPTION.as_bytes())]);
    let message = Fmu::open(&path).unwrap_err().to_string();
    assert!(
        message.contains("binaries/") && message.ends_with("the FMU has no binaries at all"),
        "{message}"
    );

    let (_directory, path) = archive(&[
        ("modelDescription.xml", DESCRIPTION.as_bytes()),
        ("binaries/riscv64-plan9/Empty.so", b"elsewhere"),
    ]);
    let error = Fmu::open(&path).unwrap_err();
    assert!(
        matches!(&error, HostError::NoLibrary { found, .. } if found.contains("riscv64-plan9")),
        "{error}"
    );
}

#[test]
fn a_model_identifier_cannot_lead_out_of_the_binaries() {
    let escaping =
        DESCRIPTION.replace("modelIdentifier=\"Empty\"", "modelIdentifier=\"../../resources/Empty\"");
    let library = format!("resources/Empty.{DLL_EXTENSION}");
    let (_directory, path) = archive(&[("modelDescription.xml", escaping.as_bytes()), (&library, b"x")]);
    assert!(matches!(Fmu::open(&path), Err(HostError::NoLibrary { .. })));
}

#[test]
fn a_file_that_is_no_library_is_refused() {
    let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
    let library = format!("binaries/{}-{system}/Empty.{DLL_EXTENSION}", std::env::consts::ARCH);
    let (_directory, path) =
        archive(&[("modelDescription.xml", DESCRIPTION.as_bytes()), (&library, b"not a library")]);
    let error = Fmu::open(&path).unwrap_err();
    assert!(matches!(&error, HostError::LoadLibrary { .. }), "{error}");
}

/// Guards: "dlopen failed" without what failed.
#[cfg(target_os = "linux")]
#[test]
fn the_linker_says_what_a_library_lacks() {
    let library = small_model::compile(
        "extern \"C\" { fn maglev_nowhere_to_be_found(); }\n\
         #[no_mangle] pub extern \"C\" fn fmi3GetVersion() { unsafe { maglev_nowhere_to_be_found() } }",
    );
    let error = small_model::open_with(small_model::FMI3, &library).unwrap_err();
    assert!(matches!(&error, HostError::LoadLibrary { .. }), "{error}");
    assert!(error.to_string().contains("undefined symbol: maglev_nowhere_to_be_found"), "{error}");
    let error = small_model::open_with(small_model::FMI3, b"not a library").unwrap_err().to_string();
    assert!(error.contains("file too short") || error.contains("invalid ELF header"), "{error}");
}
