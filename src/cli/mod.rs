//! Subcommands, one file each.

mod build;
mod describe;
mod reproduce;
mod trace;
mod tune;

use std::error::Error;
use std::fmt;
use std::io::{self, Write};

use clap::{Parser, Subcommand};
use maglev_fmu::package::WrittenFile;
use maglev_fmu::study::EXPERIMENTS;

/// Magnetic levitation and magnetic bearings as FMI 2.0 and FMI 3.0 units.
///
/// Without a command: builds the units into dist, reproduces everything into results and prints the verdicts.
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

impl CommandLine {
    /// Does what was asked for.
    pub fn run(self) -> Result<(), Box<dyn Error>> {
        match self.command {
            None => {
                let build = build::Build::default();
                build.run()?;
                reproduce::reproduce(EXPERIMENTS.iter(), build.out(), reproduce::RESULTS.as_ref())
            }
            Some(Command::Build(command)) => command.run(),
            Some(Command::Reproduce(command)) => command.run(),
            Some(Command::Describe(command)) => Ok(command.run()?),
            Some(Command::Trace(command)) => command.run(),
            Some(Command::Tune(command)) => command.run(),
        }
    }
}

/// Tells the user about a file.
fn report(WrittenFile { path, size }: &WrittenFile) {
    say(format_args!("{:>9.1} kB  {}", *size as f64 / 1e3, path.display()));
}

/// Prints a line. A reader that has seen enough, such as `head`, is no reason to fail.
fn say(line: fmt::Arguments<'_>) {
    let _ = writeln!(io::stdout(), "{line}");
}
