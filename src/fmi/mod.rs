//! The C boundary: FMI 2.0 and FMI 3.0 in one shared library.

pub mod fmi2;
pub mod fmi3;
mod status;

pub use status::Status;
