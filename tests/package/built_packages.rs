//! What is in packages, and packages with other start values, around a file that passes for a library.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use maglev_fmu::package::{GenerationTime, Library, SystemForm, build_with};
use maglev_fmu::unit::system::System;
use maglev_fmu::unit::{Description, StartValues};
use object::Architecture;
use tempfile::TempDir;
use zip::ZipArchive;

use super::library_file::write_library;

/// All packages, of some units with other start values.
pub fn packages_with(start_values: &[(&'static Description, StartValues)]) -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    let library = write_library(directory.path(), Architecture::X86_64);
    let libraries = [Library::read(&library).unwrap()];
    let time = GenerationTime::from_epoch_seconds(1_234_567_890);
    build_with(directory.path(), start_values, &libraries, time).unwrap();
    directory
}

/// Path of a system's package.
pub fn path(directory: &Path, form: SystemForm, system: &System) -> PathBuf {
    directory.join(form.directory()).join(system.name).with_extension("ssp")
}

pub fn bytes(package: &Path, member: &str) -> Vec<u8> {
    let mut archive = ZipArchive::new(File::open(package).unwrap()).unwrap();
    let mut bytes = Vec::new();
    archive.by_name(member).unwrap().read_to_end(&mut bytes).unwrap();
    bytes
}

pub fn text(package: &Path, member: &str) -> String {
    String::from_utf8(bytes(package, member)).unwrap()
}

/// The attribute `version` of the files of a form.
pub fn ssp_version(form: SystemForm) -> &'static str {
    if form == SystemForm::Two { "2.0" } else { "1.0" }
}
