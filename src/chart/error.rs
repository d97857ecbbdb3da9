//! Why a figure was not drawn.

use thiserror::Error;

/// A drawing library refused.
#[derive(Debug, Error)]
#[error("cannot draw {figure}: {reason}")]
pub struct ChartError {
    /// Title of the figure.
    pub figure: String,
    pub reason: String,
}
