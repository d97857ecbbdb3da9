//! The ZIP archive, within what the standards allow: deflate, no encryption, version 2.0 of the format at most.

use std::io::{Cursor, Write};

use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::contents::Entry;
use super::generation_time::{CivilTime, GenerationTime};

/// Packs `entries` in the given order; every entry carries the time `time`.
pub fn archive(entries: &[Entry], time: GenerationTime) -> ZipResult<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(9))
        .last_modified_time(archive_time(time));
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        let permissions = if entry.executable { 0o755 } else { 0o644 };
        writer.start_file(entry.path.as_str(), options.unix_permissions(permissions))?;
        writer.write_all(&entry.bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}

/// Archives know no time before 1980.
fn archive_time(time: GenerationTime) -> DateTime {
    let CivilTime { year, month, day, hour, minute, second } = time.civil();
    DateTime::from_date_and_time(year, month, day, hour, minute, second).unwrap_or_default()
}
