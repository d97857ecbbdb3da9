//! An FMU is a zip archive: unpacks it to a temporary directory that lives as long as the [`Archive`].

use std::fs::{self, File};
use std::io::{BufReader, copy};
use std::path::{Component, Path, PathBuf};

use tempfile::TempDir;
use zip::ZipArchive;

use super::description::ModelDescription;
use super::error::{HostError, Result};

/// An unpacked FMU; the directory is removed when this value is dropped.
#[derive(Debug)]
pub struct Archive {
    directory: TempDir,
}

impl Archive {
    /// Unpacks the archive at `path`, refusing any entry that would be written outside the temporary directory.
    ///
    /// # Errors
    /// [`HostError::OpenArchive`], [`HostError::EntryEscapes`] or [`HostError::Unpack`].
    pub fn unpack(path: &Path) -> Result<Self> {
        let cannot_open = |reason: String| HostError::OpenArchive { path: path.to_owned(), reason };
        let file = File::open(path).map_err(|error| cannot_open(error.to_string()))?;
        let mut zip =
            ZipArchive::new(BufReader::new(file)).map_err(|error| cannot_open(error.to_string()))?;
        let directory = tempfile::Builder::new()
            .prefix("fmu-")
            .tempdir()
            .map_err(|error| cannot_open(format!("no temporary directory: {error}")))?;

        for index in 0..zip.len() {
            let mut entry = zip
                .by_index(index)
                .map_err(|error| cannot_open(format!("entry number {index} is unreadable: {error}")))?;
            let name = entry
                .name()
                .map_err(|error| {
                    cannot_open(format!("the name of entry number {index} is unreadable: {error}"))
                })?
                .into_owned();
            let Some(relative) = path_inside(&name) else {
                return Err(HostError::EntryEscapes { path: path.to_owned(), entry: name });
            };
            let target = directory.path().join(relative);
            let mode = entry.unix_mode();
            let written = if name.ends_with(['/', '\\']) {
                fs::create_dir_all(&target)
            } else {
                write_file(&mut entry, &target, mode)
            };
            written.map_err(|error| HostError::Unpack {
                path: path.to_owned(),
                entry: name,
                reason: error.to_string(),
            })?;
        }
        Ok(Self { directory })
    }

    /// Root of the unpacked archive.
    pub fn directory(&self) -> &Path {
        self.directory.path()
    }

    /// Reads `modelDescription.xml`; works for an FMU that has no library for this platform, too.
    ///
    /// # Errors
    /// [`HostError::Description`] if the file is absent or not UTF-8, and those of [`ModelDescription::parse`].
    pub fn description(&self) -> Result<ModelDescription> {
        let bytes = fs::read(self.directory().join("modelDescription.xml"))
            .map_err(|error| HostError::Description { reason: error.to_string() })?;
        let text = String::from_utf8(bytes)
            .map_err(|error| HostError::Description { reason: format!("it is not UTF-8: {error}") })?;
        ModelDescription::parse(&text)
    }

    /// The directory `resources`; an FMU without one gets an empty one, because many libraries cannot take NULL.
    pub(super) fn resources(&self) -> PathBuf {
        let resources = self.directory().join("resources");
        // A failure shows up where it matters: in an FMU that opens a file in there.
        let _ = fs::create_dir_all(&resources);
        resources
    }
}

fn write_file(content: &mut impl std::io::Read, target: &Path, mode: Option<u32>) -> std::io::Result<()> {
    if let Some(parent) = target.parent() {
        fs::create_dir_all(parent)?;
    }
    let mut file = File::create(target)?;
    copy(content, &mut file)?;
    #[cfg(unix)]
    if let Some(mode) = mode {
        // Some FMUs start programs from their resources, hence the execute bits; the owner must stay able to clean up.
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(fs::Permissions::from_mode(mode & 0o777 | 0o600))?;
    }
    #[cfg(not(unix))]
    let _ = mode;
    Ok(())
}

/// The entry's place relative to the target directory, `None` if it would lie outside of it.
fn path_inside(entry: &str) -> Option<PathBuf> {
    // Some packers write the backslashes of Windows, which the zip format forbids.
    let entry = entry.replace('\\', "/");
    let mut relative = PathBuf::new();
    for component in Path::new(&entry).components() {
        match component {
            Component::Normal(part) if !entry.contains('\0') => relative.push(part),
            Component::CurDir => {}
            _ => return None,
        }
    }
    Some(relative)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_stay_inside() {
        assert_eq!(path_inside("binaries/linux64/x.so"), Some(PathBuf::from("binaries/linux64/x.so")));
        assert_eq!(path_inside("./resources\\y.txt"), Some(PathBuf::from("resources/y.txt")));
        for escaping in ["../x", "a/../../x", "/etc/passwd", "..\\x", "a\0b"] {
            assert_eq!(path_inside(escaping), None, "{escaping:?}");
        }
    }
}
