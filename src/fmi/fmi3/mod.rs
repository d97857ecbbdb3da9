//! FMI 3.0: C types and exported functions. Every function of the standard is exported.

mod clocks;
mod co_simulation;
mod event_mode;
mod legality;
mod life_cycle;
mod not_offered;
mod scheduled_execution;
mod state;
pub mod types;
mod variables;

pub use clocks::*;
pub use co_simulation::*;
pub use event_mode::*;
pub use life_cycle::*;
pub use not_offered::*;
pub use scheduled_execution::*;
pub use state::*;
pub use variables::*;
