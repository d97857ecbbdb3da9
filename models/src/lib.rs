//! The library that every FMU holds: magnetic levitation and magnetic bearings, FMI 2.0 and FMI 3.0.
//!
//! From the inside out; each knows only those above it:
//!
//! - [`scalar`]: numbers that equations are computed with: `f64`, dual numbers, numbers that trace dependencies.
//! - [`plant`]: physics in continuous time, one file per rig. [`signal`]: noise, resolution, filters, references.
//!   [`observer`]: estimators. [`controller`]: control laws.
//! - [`model`]: what is exported: the tables of variables of plants and controllers, and how they are stepped.
//! - [`fmi`]: the C boundary of both standards.
//!
//! `docs/architecture.md` follows a value through them and says what to add where.

/// What the file of the shared library is called, without what a platform puts before and after it.
pub const LIBRARY_NAME: &str = env!("CARGO_CRATE_NAME");

pub mod controller;
mod exchange_order;
pub mod fmi;
pub mod model;
pub mod observer;
pub mod plant;
pub mod scalar;
pub mod signal;

pub use exchange_order::ExchangeOrder;
