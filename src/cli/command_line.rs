//! The command line: its subcommands and its exit status.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use maglev_fmu::study::EXPERIMENTS;

use super::output::OutputError;
use super::{build, describe, ending, reproduce, trace, tune};

/// Magnetic levitation and magnetic bearings as FMUs, FMI 2.0 and FMI 3.0.
///
/// Without a command: builds the models into dist, reproduces everything into results and prints the verdicts.
/// Ends with status 0, 1 after an error, 2 for a wrong command line, and 141, quietly, when the reader of standard output has closed the pipe.
#[derive(Debug, Parser)]
#[command(version)]
pub struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Build(build::Build),
    Reproduce(reproduce::Reproduce),
    Describe(describe::Describe),
    Trace(trace::Trace),
    Tune(tune::Tune),
}

/// Does what was asked for. The exit status is 0, 1 after an error, 2 for a wrong command line, and 141 if standard output
/// is a pipe that was closed.
pub fn main() -> ExitCode {
    match CommandLine::try_parse() {
        Ok(command_line) => ending::status(command_line.run()),
        Err(answer) => match print(&answer) {
            Err(error) if !answer.use_stderr() => ending::status(Err(error.into())),
            _ => ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(1)),
        },
    }
}

/// Help, the version, or what is wrong with the command line.
fn print(answer: &clap::Error) -> Result<(), OutputError> {
    answer.print()?;
    Ok(io::stdout().flush()?)
}

impl CommandLine {
    fn run(self) -> Result<(), Box<dyn Error>> {
        match self.command {
            None => {
                let build = build::Build::default();
                build.run()?;
                reproduce::reproduce(EXPERIMENTS.iter(), build.out(), reproduce::RESULTS.as_ref())
            }
            Some(Command::Build(command)) => command.run(),
            Some(Command::Reproduce(command)) => command.run(),
            Some(Command::Describe(command)) => command.run(),
            Some(Command::Trace(command)) => command.run(),
            Some(Command::Tune(command)) => command.run(),
        }
    }
}
