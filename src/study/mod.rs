//! Experiments: what the papers show, reproduced through the packaged models, with claims, tables and pictures.
//!
//! An experiment opens packages with the [`crate::host`], runs them, and hands back figures and claims; everything
//! that is written to disk goes through [`output`].

pub mod ball;
pub mod ball_monte_carlo;
pub mod bearing;
pub mod bearing_observers;
pub mod claim;
mod error;
mod experiments;
mod findings;
mod interval;
mod loop_packages;
mod metrics;
pub mod output;
pub mod report;
pub mod rig;
mod rig_observers;
mod run;
mod sweep;
pub mod tuning;

pub use error::StudyError;
pub use experiments::{EXPERIMENTS, Experiment, Progress};
pub use findings::{FigureWithData, Findings, Summary, Table};
