//! Subcommands, one file each.

mod build;
mod describe;

use std::error::Error;
use std::fmt;
use std::io::{self, Write};

use clap::{Parser, Subcommand};
use maglev_fmu::package::WrittenFile;

/// Magnetic levitation and magnetic bearings as FMI 2.0 and FMI 3.0 units.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Build(build::Build),
    Describe(describe::Describe),
}

impl CommandLine {
    /// Does what was asked for.
    pub fn run(self) -> Result<(), Box<dyn Error>> {
        match self.command {
            Command::Build(command) => command.run()?,
            Command::Describe(command) => command.run()?,
        }
        Ok(())
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
