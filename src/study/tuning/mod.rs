//! Tuning of the maglev rig's observers by particle swarm.

pub mod candidate;
mod figure;
pub mod noise_aware;
pub mod paper_objective;
mod search;
pub mod settings;
pub mod swarm;

pub use figure::convergence;
pub use search::{Objective, Tuned, tune};
