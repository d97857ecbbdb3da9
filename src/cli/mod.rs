//! Subcommands, one file each.

mod build;
mod describe;

use std::error::Error;
use std::path::Path;

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
    println!("{:>9.1} kB  {}", *size as f64 / 1e3, Path::display(path));
}
