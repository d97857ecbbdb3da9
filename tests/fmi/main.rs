//! The C boundary from outside: the exported functions of both standards, called as an importer calls them.

mod harness;

mod allowed_calls_fmi2;
mod allowed_calls_fmi3;
mod instantiation;
mod life_cycle;
mod logging;
#[cfg(feature = "tools")]
mod symbols;
