//! The levitated ball under wrong parameters and noise: who keeps it up, and how well.

mod campaign;
mod candidate;
mod claims;
mod experiment;
mod figures;
mod spread;
mod trial;
mod tuning;

pub use experiment::{Extent, run, run_extent};
