//! An FMU is a zip archive: unpacks it to a temporary directory that lives as long as the [`Archive`].

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, Read, copy};
use std::path::{Component, Path, PathBuf};

use tempfile::TempDir;
use zip::read::ZipFile;

use super::description::ModelDescription;
use super::directory::{Zip, open};
use super::error::{HostError, Result};
use super::limits::Limits;
use crate::causes::with_causes;
use crate::file;

/// An unpacked FMU; the directory is removed when this value is dropped.
#[derive(Debug)]
pub struct Archive {
    directory: TempDir,
    limits: Limits,
}

impl Archive {
    /// Unpacks the archive at `path` within the default [`Limits`].
    ///
    /// # Errors
    /// As [`Archive::unpack_within`].
    pub fn unpack(path: &Path) -> Result<Self> {
        Self::unpack_within(path, &Limits::default())
    }

    /// Unpacks the archive at `path`, refusing what is larger than the limits, entries that would be written outside
    /// the temporary directory or over another one, and links. Whatever was unpacked before a refusal is removed.
    ///
    /// # Errors
    /// [`HostError::OpenArchive`], [`HostError::OverLimit`], [`HostError::EntryEscapes`], [`HostError::Entry`] or
    /// [`HostError::Unpack`].
    pub fn unpack_within(path: &Path, limits: &Limits) -> Result<Self> {
        Self::unpack_below(&std::env::temp_dir(), path, limits)
    }

    fn unpack_below(parent: &Path, path: &Path, limits: &Limits) -> Result<Self> {
        let zip = open(path, limits)?;
        let directory = tempfile::Builder::new().prefix("fmu-").tempdir_in(parent).map_err(|error| {
            let reason = format!("no temporary directory: {error}");
            HostError::OpenArchive { path: path.to_owned(), reason }
        })?;
        Unpacking { path, limits, root: directory.path(), names: HashSet::new(), made: 0, written: 0 }
            .run(zip)?;
        Ok(Self { directory, limits: *limits })
    }

    /// Root of the unpacked archive.
    pub fn directory(&self) -> &Path {
        self.directory.path()
    }

    /// Reads `modelDescription.xml`; works for an FMU that has no library for this platform, too.
    ///
    /// # Errors
    /// [`HostError::Description`] if the file is absent, too large or not UTF-8, and those of
    /// [`ModelDescription::parse_within`].
    pub fn description(&self) -> Result<ModelDescription> {
        let unreadable = |reason: String| HostError::Description { reason };
        let path = self.directory().join("modelDescription.xml");
        let limit = self.limits.description_bytes;
        let size = fs::metadata(&path).map_err(|error| unreadable(error.to_string()))?.len();
        if size > limit {
            let value = format!("{size} bytes");
            return Err(HostError::OverLimit {
                subject: "modelDescription.xml".to_owned(),
                value,
                limit,
                name: "description_bytes",
            });
        }
        let bytes = file::read_at_most(&path, limit).map_err(|error| unreadable(error.to_string()))?;
        let text =
            String::from_utf8(bytes).map_err(|error| unreadable(format!("it is not UTF-8: {error}")))?;
        ModelDescription::parse_within(&text, &self.limits)
    }

    /// The directory `resources`; an FMU without one gets an empty one, because many libraries cannot take NULL.
    pub(super) fn resources(&self) -> PathBuf {
        let resources = self.directory().join("resources");
        // A failure shows up where it matters: in an FMU that opens a file in there.
        let _ = fs::create_dir_all(&resources);
        resources
    }
}

/// An archive on its way to a directory.
struct Unpacking<'a> {
    path: &'a Path,
    limits: &'a Limits,
    root: &'a Path,
    /// Of the files so far, in lower case: some file systems take names that differ in case only for one.
    names: HashSet<String>,
    /// Files and directories so far.
    made: usize,
    /// Bytes of the files so far.
    written: u64,
}

impl Unpacking<'_> {
    fn run(&mut self, mut zip: Zip) -> Result<()> {
        for index in 0..zip.len() {
            let unreadable = |error| HostError::OpenArchive {
                path: self.path.to_owned(),
                reason: format!("entry number {index} is unreadable: {}", with_causes(&error)),
            };
            let mut entry = zip.by_index(index).map_err(unreadable)?;
            let name = entry.name().map_err(unreadable)?.into_owned();
            let Some(relative) = path_inside(&name) else {
                return Err(HostError::EntryEscapes { path: self.path.to_owned(), entry: name });
            };
            if entry.is_symlink() {
                return Err(self.refused(&name, "is a link, which may lead anywhere"));
            }
            self.count(&name, &relative)?;
            let target = self.root.join(&relative);
            let written = if name.ends_with(['/', '\\']) {
                fs::create_dir_all(&target)
            } else {
                if !self.names.insert(relative.to_string_lossy().to_lowercase()) {
                    return Err(self.refused(&name, "is there twice, or differs from another in case only"));
                }
                self.write(&mut entry, &name, &target)?
            };
            written.map_err(|error| HostError::Unpack {
                path: self.path.to_owned(),
                entry: name,
                reason: with_causes(&error),
            })?;
        }
        Ok(())
    }

    /// Counts what is to be made for an entry: the file or directory itself and those on the way that are not there yet.
    fn count(&mut self, name: &str, relative: &Path) -> Result<()> {
        let over = |subject: String, value: String, limit: usize, name: &'static str| HostError::OverLimit {
            subject: format!("{subject} of the FMU {}", self.path.display()),
            value,
            limit: limit as u64,
            name,
        };
        let Limits { entries, levels, .. } = *self.limits;
        let depth = relative.components().count();
        if depth > levels {
            let begin: String = name.chars().take(40).collect();
            let subject = format!("`{}...`", begin.escape_debug());
            return Err(over(subject, format!("a path of {depth} names"), levels, "levels"));
        }
        let is_missing = |path: &&Path| !self.root.join(path).exists();
        let made = self.made + relative.ancestors().take_while(is_missing).count();
        if made > entries {
            let subject = "files and directories".to_owned();
            return Err(over(subject, format!("more than {entries}"), entries, "entries"));
        }
        self.made = made;
        Ok(())
    }

    /// Writes as much of the entry as the limits allow, and refuses it if that was not all.
    fn write<R: Read + ?Sized>(
        &mut self,
        entry: &mut ZipFile<'_, R>,
        name: &str,
        target: &Path,
    ) -> Result<io::Result<()>> {
        let left = self.limits.total_bytes - self.written;
        let mode = entry.unix_mode();
        let written = match write_file(
            &mut entry.take(self.limits.entry_bytes.min(left).saturating_add(1)),
            target,
            mode,
        ) {
            Ok(written) => written,
            Err(error) => return Ok(Err(error)),
        };
        let (is_over, subject, limit, field) = if written > self.limits.entry_bytes {
            (true, format!("`{}`", name.escape_debug()), self.limits.entry_bytes, "entry_bytes")
        } else {
            (written > left, "all its entries together".to_owned(), self.limits.total_bytes, "total_bytes")
        };
        if is_over {
            return Err(HostError::OverLimit {
                subject: format!("{subject} of the FMU {}", self.path.display()),
                value: format!("more than {limit} bytes"),
                limit,
                name: field,
            });
        }
        self.written += written;
        Ok(Ok(()))
    }

    fn refused(&self, name: &str, reason: &'static str) -> HostError {
        HostError::Entry { path: self.path.to_owned(), entry: name.to_owned(), reason }
    }
}

fn write_file(content: &mut impl Read, target: &Path, mode: Option<u32>) -> io::Result<u64> {
    if let Some(parent) = target.parent() {
        fs::create_dir_all(parent)?;
    }
    let mut file = File::create(target)?;
    let written = copy(content, &mut file)?;
    #[cfg(unix)]
    if let Some(mode) = mode {
        // Some FMUs start programs from their resources, hence the execute bits; the owner must stay able to clean up.
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(fs::Permissions::from_mode(mode & 0o777 | 0o600))?;
    }
    #[cfg(not(unix))]
    let _ = mode;
    Ok(written)
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

    /// Guards: a part of a refused archive that stays on the disk.
    #[test]
    fn nothing_is_left_of_a_refused_archive() {
        use std::io::Write;
        use zip::write::{SimpleFileOptions, ZipWriter};

        let directory = tempfile::tempdir().unwrap();
        let (path, parent) = (directory.path().join("model.fmu"), directory.path().join("temporary"));
        fs::create_dir(&parent).unwrap();
        let mut zip = ZipWriter::new(File::create(&path).unwrap());
        for name in ["resources/small", "resources/large"] {
            zip.start_file(name, SimpleFileOptions::default()).unwrap();
            zip.write_all(&[0; 100]).unwrap();
        }
        zip.finish().unwrap();
        let unpacked = Archive::unpack_below(&parent, &path, &Limits::default()).unwrap();
        assert_eq!(fs::read_dir(&parent).unwrap().count(), 1);
        drop(unpacked);
        let limits = Limits { total_bytes: 150, ..Limits::default() };
        assert!(matches!(Archive::unpack_below(&parent, &path, &limits), Err(HostError::OverLimit { .. })));
        assert_eq!(fs::read_dir(&parent).unwrap().count(), 0);
    }
}
