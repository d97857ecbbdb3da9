//! From a unit's variable table to a functional mock-up unit: model description, documentation, icon, archive; and from
//! the table of systems to system structure packages.
//!
//! Everything here is written from the tables that the shared library is built from, never by loading the library,
//! so units for another platform can be packaged as well.

mod archive;
pub mod capabilities;
mod checked_in;
mod contents;
mod documentation;
mod error;
mod generation_time;
mod icon;
mod library;
mod licenses;
mod loop_diagram;
mod model_description;
pub mod parameter_file;
mod platform;
mod plug;
mod reference_run;
mod related_files;
mod run_figure;
mod system_structure;
mod variable_text;

use std::fs;
use std::path::{Path, PathBuf};

pub use crate::fmi::FmiVersion;
pub use archive::archive;
pub use capabilities::Capabilities;
pub use checked_in::{Readme, checked_in_files, describe, readme_with_tables};
pub use contents::{Entry, contents};
pub use error::PackageError;
pub use generation_time::GenerationTime;
pub use icon::{icon_png, icon_svg};
pub use library::Library;
pub use model_description::model_description;
pub use parameter_file::ParameterFile;
pub use platform::Platform;
pub use reference_run::{ReferenceRun, Table};
pub use related_files::{DIRECTORY as RELATED_FILES, INPUT as REFERENCE_INPUT, OUTPUT as REFERENCE_OUTPUT};

pub use system_structure::Edition;

use crate::unit::system::SYSTEMS;
use crate::unit::{Description, StartValues, UNITS};

/// A file that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFile {
    pub path: PathBuf,
    /// \[byte\]
    pub size: usize,
}

/// Writes `directory/fmi2/<Unit>.fmu` and `directory/fmi3/<Unit>.fmu` for all units, each with all `libraries`, and
/// for all systems a package of each [`Edition`]: `directory/<system>.ssp`, `directory/driven/<system>.ssp` and
/// `directory/ssp2/<system>.ssp`.
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
    for version in FmiVersion::ALL {
        let directory = directory.join(version.directory());
        fs::create_dir_all(&directory)
            .map_err(|source| PackageError::Write { path: directory.clone(), source })?;
        for unit in UNITS {
            let path = directory.join(unit.description.name).with_extension("fmu");
            let own =
                start_values.iter().find(|(description, _)| std::ptr::eq(*description, unit.description));
            let own = own.map_or(StartValues::TABLE, |(_, values)| values);
            let entries = contents(unit.description, own, version, time, libraries)?;
            let bytes = archive(&entries, time)
                .map_err(|source| PackageError::Archive { path: path.clone(), source })?;
            replace_file(&path, &bytes)?;
            written.push(WrittenFile { path, size: bytes.len() });
        }
    }
    for edition in Edition::ALL {
        let directory = directory.join(edition.directory());
        fs::create_dir_all(&directory)
            .map_err(|source| PackageError::Write { path: directory.clone(), source })?;
        for system in SYSTEMS {
            let path = directory.join(system.name).with_extension("ssp");
            let entries = system_structure::contents(system, edition, start_values, time, libraries)?;
            let bytes = archive(&entries, time)
                .map_err(|source| PackageError::Archive { path: path.clone(), source })?;
            replace_file(&path, &bytes)?;
            written.push(WrittenFile { path, size: bytes.len() });
        }
    }
    Ok(written)
}

/// Writes a file under another name first, so that a failure leaves the old file or none.
fn replace_file(path: &Path, contents: &[u8]) -> Result<(), PackageError> {
    let failed = |source| PackageError::Write { path: path.to_owned(), source };
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The process's umask takes away what it should.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(path.parent().unwrap_or(Path::new("."))).map_err(failed)?;
    fs::write(file.path(), contents).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}
