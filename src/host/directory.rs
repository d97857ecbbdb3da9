//! The list of entries at the end of a zip archive, read with care: it is the part that others forge.

use std::cell::Cell;
use std::collections::HashSet;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::rc::Rc;

use zip::ZipArchive;

use super::error::{HostError, Result};
use super::limits::Limits;
use crate::causes::with_causes;

/// An archive whose list of entries was checked.
pub(super) type Zip = ZipArchive<BufReader<Metered>>;

/// Longest end record with its comment, and the ZIP64 locator before it.
const LONGEST_END: u64 = 22 + 0xffff + 20;
const ZIP64_LOCATOR: &[u8] = b"PK\x06\x07";
const CENTRAL_HEADER: &[u8] = b"PK\x01\x02";

/// A file of which a limited number of bytes may be read.
pub(super) struct Metered {
    file: File,
    left: Rc<Cell<u64>>,
}

impl Read for Metered {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        self.left.set(self.left.get().saturating_sub(read as u64));
        if self.left.get() == 0 {
            return Err(io::Error::other("its list of entries is too long"));
        }
        Ok(read)
    }
}

impl Seek for Metered {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.seek(place)
    }
}

/// Opens the archive at `path` if its entries are as many as the limits allow, have different names, and share no byte.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<Zip> {
    let cannot_open = |reason: String| HostError::OpenArchive { path: path.to_owned(), reason };
    let unreadable = |error: io::Error| cannot_open(error.to_string());
    let mut file = File::open(path).map_err(unreadable)?;
    let over = |what: &str, value: String, limit, name| HostError::OverLimit {
        subject: format!("{what} of the FMU {}", path.display()),
        value,
        limit,
        name,
    };

    let size = file.metadata().map_err(unreadable)?.len();
    let largest = limits.total_bytes.saturating_add(limits.directory_bytes());
    if size > largest {
        return Err(over("the archive", format!("{size} bytes"), limits.total_bytes, "total_bytes"));
    }
    // Both standards allow version 2.0 of the format at most, and its counts cannot ask for absurd memory.
    if has_zip64_end(&mut file, size).map_err(unreadable)? {
        return Err(cannot_open("it is a ZIP64 archive, which FMUs may not be".to_owned()));
    }

    let left = Rc::new(Cell::new(limits.directory_bytes()));
    let metered = Metered { file, left: Rc::clone(&left) };
    let opened = ZipArchive::new(BufReader::new(metered));
    if left.get() == 0 || matches!(&opened, Ok(zip) if zip.len() > limits.entries) {
        let value = opened.map_or_else(|_| "more".to_owned(), |zip| format!("{} entries", zip.len()));
        return Err(over("the list of entries", value, limits.entries as u64, "entries"));
    }
    let mut zip = opened.map_err(|error| cannot_open(with_causes(&error)))?;
    left.set(u64::MAX);

    if zip.has_duplicate_names() {
        let entry = repeated_name(path, zip.central_directory_start()).map_err(unreadable)?;
        return Err(HostError::Entry { path: path.to_owned(), entry, reason: "is there twice" });
    }
    if zip.has_overlapping_entries().map_err(|error| cannot_open(with_causes(&error)))? {
        return Err(cannot_open(
            "entries overlap: they share bytes, as only a forged archive has them".to_owned(),
        ));
    }
    Ok(zip)
}

fn has_zip64_end(file: &mut File, size: u64) -> io::Result<bool> {
    file.seek(SeekFrom::Start(size.saturating_sub(LONGEST_END)))?;
    let mut end = Vec::new();
    file.take(LONGEST_END).read_to_end(&mut end)?;
    Ok(end.windows(ZIP64_LOCATOR.len()).any(|bytes| bytes == ZIP64_LOCATOR))
}

/// The first name that the list of entries has twice; the reader of archives merges them.
fn repeated_name(path: &Path, list: u64) -> io::Result<String> {
    let mut reader = BufReader::new(File::open(path)?);
    reader.seek(SeekFrom::Start(list))?;
    let mut names = HashSet::new();
    loop {
        let mut head = [0; 46];
        reader.read_exact(&mut head)?;
        let length = |place: usize| u16::from_le_bytes([head[place], head[place + 1]]);
        if !head.starts_with(CENTRAL_HEADER) {
            return Ok("?".to_owned());
        }
        let mut name = vec![0; usize::from(length(28))];
        reader.read_exact(&mut name)?;
        reader.seek_relative(i64::from(length(30)) + i64::from(length(32)))?;
        let text = String::from_utf8_lossy(&name).into_owned();
        if !names.insert(name) {
            return Ok(text);
        }
    }
}
