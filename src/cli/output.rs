//! Standard output, with every failure to write it told.

use std::error::Error;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use maglev_fmu::package::WrittenFile;

/// Standard output could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output")]
pub struct OutputError(#[from] io::Error);

impl OutputError {
    /// The reader has closed the pipe: it has seen enough, such as `head`.
    pub fn is_closed_pipe(error: &(dyn Error + 'static)) -> bool {
        let output: Option<&Self> = error.downcast_ref();
        output.is_some_and(|OutputError(reason)| reason.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Standard output as a file: the library's own handle takes one that cannot be written for one that nobody wants to read.
fn standard_output() -> io::Result<File> {
    #[cfg(unix)]
    let handle = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned()?;
    #[cfg(windows)]
    let handle = std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned()?;
    Ok(handle.into())
}

/// Prints a line.
pub fn say(line: fmt::Arguments<'_>) -> Result<(), OutputError> {
    // At once, so that lines are whole.
    Ok(standard_output()?.write_all(format!("{line}\n").as_bytes())?)
}

/// Tells the user about a file.
pub fn report(WrittenFile { path, size }: &WrittenFile) -> Result<(), OutputError> {
    say(format_args!("{:>9.1} kB  {}", *size as f64 / 1e3, path.display()))
}

/// Type of an option: a file beside which others are put, under its name with other endings. No file belongs beside a
/// device.
pub fn with_room_beside(path: PathBuf) -> Result<PathBuf, String> {
    let expected = "expected a regular file, since other files are written next to it";
    if fs::metadata(&path).is_ok_and(|known| !known.is_file()) {
        return Err(format!("a directory, device or pipe: {expected}"));
    }
    let directory = path.parent().and_then(|parent| fs::canonicalize(parent).ok());
    match directory {
        Some(directory) if directory == Path::new("/dev") => Err(format!("among devices: {expected}")),
        _ => Ok(path),
    }
}

/// Many lines, written in blocks.
pub struct Lines(BufWriter<File>);

impl Lines {
    pub fn new() -> Result<Self, OutputError> {
        Ok(Self(BufWriter::new(standard_output()?)))
    }

    pub fn say(&mut self, line: fmt::Arguments<'_>) -> Result<(), OutputError> {
        Ok(writeln!(self.0, "{line}")?)
    }

    /// Writes what is left; without it, a failure at the end would go unseen.
    pub fn finish(mut self) -> Result<(), OutputError> {
        Ok(self.0.flush()?)
    }
}
