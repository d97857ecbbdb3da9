//! Parameter files: values for the variables of one model, with where they come from.
//!
//! ```json
//! {
//!   "model": "MaglevRigController",
//!   "values": { "observer.kind": 1, "observer.bandwidth": 180.0 },
//!   "units": { "observer.kind": "item linear", "observer.bandwidth": "rad/s" },
//!   "provenance": { "program": "maglev-fmu 0.1.0" }
//! }
//! ```
//!
//! `values` is what importers call start values; items of enumerations are written by number, since not every importer
//! knows their names, and read by number or name. `units` is for people and, where given, must be right. `provenance`
//! is anything.

mod contents;
mod error;
mod reading;
mod unique_keys;

pub use contents::ParameterFile;
pub use error::ParameterFileError;
pub use reading::LARGEST;
