//! Why a parameter file was refused.

use std::path::PathBuf;

use serde_json::Value;
use thiserror::Error;

use crate::causes::printable;
use crate::model::start_values::StartValueError;
use crate::model::{ModelError, models};

/// Why a parameter file was refused.
#[derive(Debug, Error)]
pub enum ParameterFileError {
    #[error("cannot read {}", .path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{} is no parameter file: {reason}", .path.display())]
    Syntax { path: PathBuf, reason: String },
    #[error("{} is in UTF-16, expected UTF-8", .path.display())]
    Encoding { path: PathBuf },
    #[error("there is no model {}, expected one of {}", name.escape_debug(), model_names())]
    UnknownModel { name: String },
    #[error("{} = {}: expected {expected}", name.escape_debug(), printable(&value.to_string()))]
    WrongKind { name: String, value: Value, expected: String },
    #[error("{} is given in {}: expected {expected}", name.escape_debug(), printable(&given.to_string()))]
    WrongUnit { name: String, given: Value, expected: String },
    #[error("{} has a unit and no value", name.escape_debug())]
    UnitWithoutValue { name: String },
    #[error(transparent)]
    StartValue(#[from] StartValueError),
    #[error(transparent)]
    DoNotFit(#[from] ModelError),
    #[error("cannot write {}", .path.display())]
    Write { path: PathBuf, source: std::io::Error },
}

fn model_names() -> String {
    models().map(|model| model.description.name).collect::<Vec<_>>().join(", ")
}
