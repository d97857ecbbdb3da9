//! FMI 2.0: the function table of a library, and one instance behind it.

mod callbacks;
mod functions;
mod instance;

pub(super) use functions::Functions;
pub(super) use instance::FmiTwo;
