//! FMI 3.0: the function table of a library, and one instance behind it.

mod functions;
mod instance;

pub(super) use functions::Functions;
pub(super) use instance::FmiThree;
