//! State estimators, one per file.

pub mod newton;
