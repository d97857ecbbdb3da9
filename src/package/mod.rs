//! From a unit's variable table to a functional mock-up unit: model description, documentation, icon, archive; from the
//! table of systems to system structure packages; and from both to the pages in `docs/models`.
//!
//! Everything here is written from the tables that the shared library is built from, never by loading the library,
//! so units for another platform can be packaged as well.

mod archive;
pub mod capabilities;
mod contents;
mod documentation;
mod error;
mod generated_files;
mod generation_time;
mod icon;
mod library;
mod licenses;
mod loop_diagram;
mod markdown;
mod model_description;
mod model_page;
pub mod parameter_file;
mod platform;
mod plug;
mod reference_run;
mod related_files;
mod run_figure;
mod system_structure;
mod third_party;
mod variable_text;
mod xml;

use std::fs;
use std::path::{Path, PathBuf};

pub use crate::fmi::{FmiVersion, Form};
pub use archive::archive;
pub use capabilities::Capabilities;
pub use contents::{Entry, contents};
pub use error::PackageError;
pub use generated_files::{describe, describe_third_party, generated_files};
pub use generation_time::GenerationTime;
pub use icon::{icon_png, icon_svg};
pub use library::Library;
pub use model_description::model_description;
pub use parameter_file::ParameterFile;
pub use platform::Platform;
pub use reference_run::{ReferenceRun, Table};
pub use related_files::{DIRECTORY as RELATED_FILES, INPUT as REFERENCE_INPUT, OUTPUT as REFERENCE_OUTPUT};
pub use third_party::{PATH as THIRD_PARTY_PATH, ThirdPartyError, third_party};

pub use system_structure::{SystemForm, contents as system_contents};

use crate::file;
use crate::unit::system::SYSTEMS;
use crate::unit::{Description, StartValues, UNITS};

/// A file that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFile {
    pub path: PathBuf,
    /// \[byte\]
    pub size: usize,
}

/// Writes `directory/<form>/<Unit>.fmu` for all units in all their forms ([`Form::directory`]), each with all
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

/// As [`build`], with other start values for some units: their model descriptions say so, and so do their tokens, by
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
        for unit in UNITS.iter().filter(|unit| form.edition.suits(unit.description)) {
            let path = directory.join(unit.description.name).with_extension("fmu");
            let own =
                start_values.iter().find(|(description, _)| std::ptr::eq(*description, unit.description));
            let own = own.map_or(StartValues::TABLE, |(_, values)| values);
            let entries = contents(unit.description, own, form, time, libraries)?;
            let bytes = archive(&entries, time)
                .map_err(|source| PackageError::Archive { path: path.clone(), source })?;
            replace_file(&path, &bytes)?;
            written.push(WrittenFile { path, size: bytes.len() });
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
            replace_file(&path, &bytes)?;
            written.push(WrittenFile { path, size: bytes.len() });
        }
    }
    Ok(written)
}

/// Writes a file whole or not at all.
fn replace_file(path: &Path, contents: &[u8]) -> Result<(), PackageError> {
    file::replace(path, contents).map_err(|source| PackageError::Write { path: path.to_owned(), source })
}
