//! Builds all packages.

use std::fs;
use std::path::{Path, PathBuf};

use super::{
    Form, GenerationTime, Library, PackageError, SystemForm, WrittenFile, archive, contents, system_structure,
};
use crate::file;
use crate::model::system::SYSTEMS;
use crate::model::{Description, MODELS, StartValues};

/// Writes `directory/<form>/<Model>.fmu` for all models in all their forms ([`Form::directory`]), each with all
/// `libraries`, and for all systems a package of each [`SystemForm`]: `directory/<system>.ssp`,
/// `directory/driven/<system>.ssp` and `directory/ssp2/<system>.ssp`.
///
/// The same arguments give the same bytes. An archive appears complete or not at all.
pub fn build(
    directory: &Path,
    libraries: &[Library],
    time: GenerationTime,
) -> Result<Vec<WrittenFile>, PackageError> {
    build_with(directory, &[], libraries, time)
}

/// As [`build`], with other start values for some models: their model descriptions say so, and so do their tokens, by
/// which the library knows.
pub fn build_with(
    directory: &Path,
    start_values: &[(&'static Description, StartValues)],
    libraries: &[Library],
    time: GenerationTime,
) -> Result<Vec<WrittenFile>, PackageError> {
    let mut written = Vec::new();
    for form in Form::ALL {
        let directory = directory.join(form.directory());
        fs::create_dir_all(&directory)
            .map_err(|source| PackageError::Write { path: directory.clone(), source })?;
        for model in MODELS.iter().filter(|model| form.edition.suits(model.description)) {
            let path = directory.join(model.description.name).with_extension("fmu");
            let own =
                start_values.iter().find(|(description, _)| std::ptr::eq(*description, model.description));
            let own = own.map_or(StartValues::TABLE, |(_, values)| values);
            let entries = contents(model.description, own, form, time, libraries)?;
            let bytes = archive(&entries, time)
                .map_err(|source| PackageError::Archive { path: path.clone(), source })?;
            written.push(write(path, &bytes)?);
        }
    }
    for form in SystemForm::ALL {
        let directory = directory.join(form.directory());
        fs::create_dir_all(&directory)
            .map_err(|source| PackageError::Write { path: directory.clone(), source })?;
        for system in SYSTEMS {
            let path = directory.join(system.name).with_extension("ssp");
            let entries = system_structure::contents(system, form, start_values, time, libraries)?;
            let bytes = archive(&entries, time)
                .map_err(|source| PackageError::Archive { path: path.clone(), source })?;
            written.push(write(path, &bytes)?);
        }
    }
    Ok(written)
}

/// Writes a file whole or not at all.
pub(super) fn write(path: PathBuf, contents: &[u8]) -> Result<WrittenFile, PackageError> {
    file::write(path.clone(), contents).map_err(|source| PackageError::Write { path, source })
}
