//! FMI 3.0: C types and exported functions. Every function of the standard is exported.

mod clocks;
mod co_simulation;
mod derivatives;
mod event_mode;
mod legality;
mod life_cycle;
mod model_exchange;
mod not_offered;
mod scheduled_execution;
mod state;
pub mod types;
mod variables;

pub use clocks::*;
pub use co_simulation::*;
pub use derivatives::*;
pub use event_mode::*;
pub use life_cycle::*;
pub use model_exchange::*;
pub use not_offered::*;
pub use scheduled_execution::*;
pub use state::*;
pub use variables::*;
