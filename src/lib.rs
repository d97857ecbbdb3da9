//! Magnetic levitation and magnetic bearings as FMUs, FMI 2.0 and FMI 3.0.

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
