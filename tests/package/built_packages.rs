//! What is in packages, of this build or, of models that a test adds, as they would be, without a library; and packages with
//! other start values, around a file that passes for a library.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use maglev_fmu::model::system::{SYSTEMS, System};
use maglev_fmu::model::{Description, MODELS, ModelType, StartValues};
use maglev_fmu::package::{
    Entry, FmiVersion, Form, GenerationTime, Library, SystemForm, build_with, contents, system_contents,
};
use maglev_fmu_test::packages;
use object::Architecture;
use tempfile::TempDir;
use zip::ZipArchive;

use super::library_file::write_library;

/// All packages, of some models with other start values.
pub fn packages_with(start_values: &[(&'static Description, StartValues)]) -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    let library = write_library(directory.path(), Architecture::X86_64);
    let libraries = [Library::read(&library).unwrap()];
    build_with(directory.path(), start_values, &libraries, TIME).unwrap();
    directory
}

const TIME: GenerationTime = GenerationTime::from_epoch_seconds(1_234_567_890);

/// A file of the package of a model.
pub fn model_file(version: FmiVersion, model: &'static ModelType, member: &str) -> String {
    let (name, form) = (model.description.name, Form::from(version));
    if MODELS.iter().any(|own| std::ptr::eq(*own, model)) {
        return text(&packages::directory().join(form.directory()).join(name).with_extension("fmu"), member);
    }
    let entries = contents(model.description, StartValues::TABLE, form, TIME, &[]).unwrap();
    String::from_utf8(find(entries, member)).unwrap()
}

/// A file of the package of a system.
pub fn system_file(form: SystemForm, system: &'static System, member: &str) -> Vec<u8> {
    if SYSTEMS.iter().any(|own| std::ptr::eq(*own, system)) {
        return bytes(&path(packages::directory(), form, system), member);
    }
    find(system_contents(system, form, &[], TIME, &[]).unwrap(), member)
}

fn find(entries: Vec<Entry>, member: &str) -> Vec<u8> {
    entries.into_iter().find(|entry| entry.path == member).unwrap().bytes.into_owned()
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
