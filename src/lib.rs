//! Magnetic levitation and magnetic bearings as FMUs, FMI 2.0 and FMI 3.0.
//!
//! From the inside out; each knows only those above it:
//!
//! - [`scalar`]: numbers that equations are computed with: `f64`, dual numbers, numbers that trace dependencies.
//! - [`plant`]: physics in continuous time, one file per rig. [`signal`]: noise, resolution, filters, references.
//!   [`observer`]: estimators. [`controller`]: control laws.
//! - [`model`]: what is exported: the tables of variables of plants and controllers, and how they are stepped.
//! - [`fmi`]: the C boundary of both standards.
//!
//! With the feature `tools`, for the program and its tests:
//!
//! - [`chart`]: line charts. [`package`]: model descriptions, archives, systems. [`parameter_file`]: start values from files.
//! - [`host`]: loads any FMU and steps loops of two.
//! - [`study`]: the papers' experiments through the packages, judged.
//!
//! `docs/architecture.md` follows a value through them and says what to add where.

#[cfg(feature = "tools")]
pub mod causes;
#[cfg(feature = "tools")]
pub mod chart;
pub mod controller;
mod exchange_order;
#[cfg(feature = "tools")]
mod file;
pub mod fmi;
#[cfg(feature = "tools")]
pub mod host;
pub mod model;
pub mod observer;
#[cfg(feature = "tools")]
pub mod package;
#[cfg(feature = "tools")]
pub mod parameter_file;
pub mod plant;
pub mod scalar;
pub mod signal;
#[cfg(feature = "tools")]
pub mod study;
