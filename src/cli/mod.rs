//! Subcommands, one file each.

mod build;
mod command_line;
mod describe;
mod ending;
mod output;
mod reproduce;
mod trace;
mod tune;

pub use command_line::main;
