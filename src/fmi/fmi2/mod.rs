//! FMI 2.0: C types and exported functions.

pub mod types;
