//! The C boundary: FMI 2.0 and FMI 3.0 in one shared library.
//!
//! Every exported function reads the same: enter the boundary (null, phase, panic, floating-point environment), convert
//! the arguments, act on the [`Instance`], map the error to a status and a log message. All `unsafe` of the library lives
//! here.

mod access;
mod boundary;
mod communication;
mod derivatives;
mod earliest_time;
mod error;
mod event_mode;
mod floating_point;
pub mod fmi2;
pub mod fmi3;
mod form;
mod fraction;
mod function_names;
mod instance;
mod instance_state;
mod instantiation;
mod interface;
mod intermediate_update;
mod log;
mod log_categories;
mod message;
mod model_exchange;
mod phase;
mod saved_state;
mod state_format;
mod state_handle;
mod status;
mod ticking;
mod time_rounding;
mod version;

pub use communication::CommunicationPoint;
pub use error::CallError;
pub use form::Form;
pub use function_names::function_names;
pub use instance::Instance;
pub use interface::Interface;
pub use log::{Callback, Logger};
pub use log_categories::LOG_CATEGORIES;
pub use phase::{Function, Phase};
pub use saved_state::SavedState;
pub use state_format::{LONGEST_SAVED_STATE, StateError};
pub use status::Status;
pub use version::FmiVersion;
