//! Magnetic levitation and magnetic bearings as FMUs, FMI 2.0 and FMI 3.0: the tools around the models of [`maglev_models`],
//! whose modules are those of this library, too.
//!
//! From the inside out; each knows only those above it:
//!
//! - [`chart`]: line charts. [`package`]: model descriptions, archives, systems. [`parameter_file`]: start values from files.
//! - [`host`]: loads any FMU and steps loops of two.
//! - [`study`]: the papers' experiments through the packages, judged.
//!
//! `docs/architecture.md` follows a value through them and says what to add where.

pub use maglev_models::{controller, fmi, model, observer, plant, scalar, signal};

pub mod causes;
pub mod chart;
mod file;
pub mod host;
pub mod package;
pub mod parameter_file;
pub mod study;
