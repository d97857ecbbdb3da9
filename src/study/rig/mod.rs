//! The maglev rig's paper (Humaidi et al. 2018): Table 5, figures 3 and 5, the tuning, and the claims.

mod claims;
mod experiment;
mod figures;
pub mod observers;
mod ranking;
pub mod recording;
mod searches;
pub mod simulation;

pub use experiment::run;
