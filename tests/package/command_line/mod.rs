//! The program `maglev-fmu`.

#[cfg(unix)]
mod output;
mod packaging;
mod parameters;
