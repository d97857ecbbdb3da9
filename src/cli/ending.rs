//! How the program ends.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use maglev_fmu::causes::printable;

use super::output::OutputError;

/// What a shell reports for a program that a closed pipe has ended. The work was not finished, so it is no success, and
/// nobody is left to tell.
const CLOSED_PIPE: u8 = 128 + 13;

/// Prints what went wrong and its causes, and returns the exit status: 0, 1 after an error, 141 quietly if standard output
/// is a pipe that the reader has closed.
pub fn status(outcome: Result<(), Box<dyn Error>>) -> ExitCode {
    let Err(error) = outcome else { return ExitCode::SUCCESS };
    if OutputError::is_closed_pipe(&*error) {
        return ExitCode::from(CLOSED_PIPE);
    }
    let mut message = format!("error: {}", printable(&error.to_string()));
    let mut cause = error.source();
    while let Some(reason) = cause {
        message += &format!("\n  because: {}", printable(&reason.to_string()));
        cause = reason.source();
    }
    // A closed or full standard error leaves the exit status to tell.
    let _ = writeln!(io::stderr(), "{message}");
    ExitCode::FAILURE
}
