//! How the program ends.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

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
    let mut message = format!("error: {error}");
    let mut cause = error.source();
    while let Some(reason) = cause {
        message += &format!("\n  because: {reason}");
        cause = reason.source();
    }
    // A closed or full standard error leaves the exit status to tell.
    let _ = writeln!(io::stderr(), "{}", printable(&message));
    ExitCode::FAILURE
}

/// Messages quote names from files: these must not move the cursor, colour the screen or turn the direction of writing.
fn printable(message: &str) -> String {
    let is_harmless = |letter: char| letter == '\n' || !letter.escape_debug().to_string().starts_with("\\u");
    message
        .chars()
        .map(|letter| match letter {
            '\r' | '\t' | '\0' => letter.escape_debug().to_string(),
            letter if is_harmless(letter) => letter.to_string(),
            letter => letter.escape_unicode().to_string(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_cannot_steer_the_terminal() {
        let kept = "`größe\\x` is \"no\" name, it's not\n  because: 5 \u{3bc}m";
        assert_eq!(printable(kept), kept);
        let steering = "a\u{1b}[2Jb\u{202e}c\u{7f}d\re";
        assert_eq!(printable(steering), "a\\u{1b}[2Jb\\u{202e}c\\u{7f}d\\re");
    }
}
