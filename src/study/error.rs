//! Why a study failed.

use std::path::PathBuf;

use thiserror::Error;

use crate::chart::ChartError;
use crate::host::HostError;

/// Failure of an experiment or of writing its results.
#[derive(Debug, Error)]
pub enum StudyError {
    #[error(transparent)]
    Host(#[from] HostError),
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error("the search failed: {reason}")]
    Search { reason: String },
    #[error("cannot turn a table into CSV")]
    Csv(#[from] csv::Error),
    #[error("cannot turn the claims into JSON")]
    Json(#[from] serde_json::Error),
}
