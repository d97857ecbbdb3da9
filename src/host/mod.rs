//! The importer's side: opens any co-simulation FMU of FMI 2.0 or FMI 3.0 and steps it, alone or in a loop of two.
//!
//! ```no_run
//! use maglev_fmu::host::{Fmu, Logging};
//!
//! let fmu = Fmu::open("Plant.fmu".as_ref())?;
//! let mut plant = fmu.instantiate("plant", Logging::On)?;
//! plant.set_by_name("mass", 0.5)?;
//! plant.initialise(0.0, None)?;
//! let position = plant.variable("position")?;
//! for step in 0..1000 {
//!     plant.step(f64::from(step) * 1e-4, 1e-4)?;
//! }
//! println!("{} m", plant.get(position)?);
//! # Ok::<(), maglev_fmu::host::HostError>(())
//! ```
//!
//! From the outside in: [`Fmu`] and [`Instance`] are what a user holds, [`ControlLoop`] is the master,
//! [`ModelDescription`] is the XML in one form for both versions; `fmi2` and `fmi3` hold the two C function tables.
//! The module knows the C ABI and the XML only, so it drives anybody's FMU.

mod archive;
mod by_name;
mod component;
mod description;
mod directory;
mod error;
mod fmi2;
mod fmi3;
mod fmu;
mod instance;
mod library;
mod limits;
mod loaded;
mod master;
mod message_log;
mod refusal;
mod route;
mod saved_state;
mod trace;
mod value;
mod variable;

pub use crate::fmi::FmiVersion;
pub use archive::Archive;
pub use description::{CoSimulation, DefaultExperiment, EnumerationItem, ModelDescription};
pub use error::{HostError, ReportedStatus, Result};
pub use fmu::Fmu;
pub use instance::{Instance, Logging};
pub use limits::Limits;
pub use maglev_models::ExchangeOrder;
pub use master::ControlLoop;
pub use message_log::LogMessage;
pub use saved_state::SavedState;
pub use trace::Trace;
pub use value::{Handle, Value};
pub use variable::{Causality, Kind, Storage, Variability, Variable};
