//! FMI 3.0: C types and exported functions.

pub mod types;
