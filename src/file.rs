//! Files that are written whole or not at all, and read up to a limit.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// A file that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFile {
    pub path: PathBuf,
    /// \[byte\]
    pub size: usize,
}

/// As [`replace`], and says what was written.
pub(crate) fn write(path: PathBuf, contents: &[u8]) -> io::Result<WrittenFile> {
    replace(&path, contents)?;
    Ok(WrittenFile { path, size: contents.len() })
}

/// Writes a file under another name beside it first, so that a failure, such as a full disk, leaves the old file or
/// none, but never a part of the new one. A link stays a link, and a device or pipe is written to.
pub(crate) fn replace(path: &Path, contents: &[u8]) -> io::Result<()> {
    let old = match fs::metadata(path) {
        Ok(old) if !old.is_file() => return OpenOptions::new().write(true).open(path)?.write_all(contents),
        Ok(old) => Some(old),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let Some(old) = old else { return write_beside(path, new_file_permissions(), contents) };
    // A file that may not be written is not replaced either.
    OpenOptions::new().write(true).open(path)?;
    write_beside(&fs::canonicalize(path)?, Some(old.permissions()), contents)
}

fn write_beside(path: &Path, permissions: Option<Permissions>, contents: &[u8]) -> io::Result<()> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    if let Some(permissions) = permissions {
        builder.permissions(permissions);
    }
    let file = builder.tempfile_in(directory.unwrap_or(Path::new(".")))?;
    // Of the file itself, whose errors do not mention the other name.
    file.as_file().write_all(contents)?;
    // Some file systems tell of a full disk only when the data are on it.
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// As for any new file: the process's umask takes away what it should.
#[cfg(unix)]
fn new_file_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn new_file_permissions() -> Option<Permissions> {
    None
}

/// The bytes of a file that has at most `limit` of them: what a user names may be a device without end.
pub(crate) fn read_at_most(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let reason = format!("it is larger than the {limit} bytes that such a file may have");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_replaced_and_nothing_else_is_left() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        for contents in [b"first".as_slice(), b"second"] {
            replace(&path, contents).unwrap();
            assert_eq!(fs::read(&path).unwrap(), contents);
        }
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    /// Guards: a file that is cut where the disk was full. Renaming onto a directory fails like it, at the end.
    #[test]
    fn what_cannot_be_written_leaves_no_part() {
        let directory = tempfile::tempdir().unwrap();
        let blocked = directory.path().join("blocked");
        fs::create_dir(&blocked).unwrap();
        assert!(write_beside(&blocked, None, b"contents").is_err());
        assert!(replace(&blocked, b"contents").is_err());
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let (target, link) = (directory.path().join("target"), directory.path().join("link"));
        fs::write(&target, "old").unwrap();
        fs::set_permissions(&target, Permissions::from_mode(0o640)).unwrap();
        symlink(&target, &link).unwrap();
        replace(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"new");
        assert_eq!(fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o640);
    }

    /// Guards: as root, renaming onto a device would replace it for the whole machine.
    #[cfg(target_os = "linux")]
    #[test]
    fn devices_stay_devices() {
        use std::os::unix::fs::FileTypeExt;
        let full = Path::new("/dev/full");
        assert_eq!(replace(full, b"contents").unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert!(fs::metadata(full).unwrap().file_type().is_char_device());
    }

    #[test]
    fn reading_ends_at_the_limit() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("file");
        fs::write(&path, [7; 10]).unwrap();
        assert_eq!(read_at_most(&path, 10).unwrap(), [7; 10]);
        let error = read_at_most(&path, 9).unwrap_err();
        assert!(error.to_string().contains("larger than the 9 bytes"), "{error}");
        #[cfg(target_os = "linux")]
        assert!(read_at_most(Path::new("/dev/zero"), 1000).is_err());
    }
}
