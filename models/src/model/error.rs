//! Why a model refuses to run.

use super::value::{Readable, ValueError};
use thiserror::Error;

/// Why a model refused to run; it is left as it was before the call.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ModelError {
    #[error("an input with a slope leaves its range within the step: {0}")]
    InputLeavesRange(ValueError),
    #[error("{name} would become {value} {unit} within the step: expected a finite number")]
    Diverged { name: &'static str, value: f64, unit: &'static str },
    #[error(
        "a step of {duration} s: expected at most {limit} s, about a second of computing with these parameters",
        duration = Readable(*duration), limit = Readable(*limit)
    )]
    StepTooLong { duration: f64, limit: f64 },
    #[error(
        "a step of {duration} s: expected at most longest_step = {limit} s",
        duration = Readable(*duration), limit = Readable(*limit)
    )]
    BeyondLongestStep { duration: f64, limit: f64 },
    #[error(
        "{first} and {second} are both {value} {unit}: expected numbers that differ by a millionth or more",
        value = Readable(*value)
    )]
    Equal { first: &'static str, second: &'static str, value: f64, unit: &'static str },
    #[error(
        "startTime = {start_time} s: expected -{limit} to {limit} s, so that ticks every {period} s can be counted",
        start_time = Readable(*start_time), limit = Readable(*limit)
    )]
    StartOutOfReach { start_time: f64, period: f64, limit: f64 },
    #[error("{name} = {value} {unit}: expected {expected}", value = Readable(*value))]
    Unusable { name: &'static str, value: f64, unit: &'static str, expected: &'static str },
}

impl ModelError {
    /// The longest step that is accepted \[s\], if a step was refused for its length.
    pub fn longest_step(&self) -> Option<f64> {
        match self {
            Self::StepTooLong { limit, .. } | Self::BeyondLongestStep { limit, .. } => Some(*limit),
            _ => None,
        }
    }
}
