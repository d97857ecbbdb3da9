//! FMI 2.0: C types and exported functions. Every function of the standard is exported.

mod co_simulation;
mod derivatives;
mod legality;
mod life_cycle;
mod model_exchange;
mod state;
pub mod types;
mod variables;

pub use co_simulation::*;
pub use derivatives::*;
pub use life_cycle::*;
pub use model_exchange::*;
pub use state::*;
pub use variables::*;
