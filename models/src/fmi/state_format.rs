//! Layout of a serialised state, and why bytes are refused.
//!
//! With all numbers in little-endian order:
//!
//! ```text
//! 0   8   mark "maglevFS"
//! 8   4   version of this format
//! 12  4   length n of the payload
//! 16  38  instantiation token of the model, which tells models and releases apart
//! 54  4   CRC-32 (IEEE) of bytes 0 to 54 and of the payload
//! 58  n   payload
//! ```

use crate::model::memory::OutOfMemory;
use crate::model::models;
use crate::model::persistence::PersistenceError;
use core::fmt;
use thiserror::Error;

pub(super) const MARK: [u8; 8] = *b"maglevFS";
/// To be raised whenever a model's fields or [`super::instance_state::InstanceState`] change.
pub(super) const VERSION: u32 = 6;

pub(super) const TOKEN: core::ops::Range<usize> = 16..54;
pub(super) const CHECKSUM: core::ops::Range<usize> = 54..58;
pub(super) const HEADER: usize = 58;

/// Bytes of the longest serialised state.
pub const LONGEST_SAVED_STATE: usize = 4096;
/// Why a state was neither saved nor restored; nothing has changed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum StateError {
    #[error("the handle is not that of a saved state: it was freed, or made elsewhere")]
    NoHandle,
    #[error("{got} bytes: expected {expected}, the size of this state")]
    Room { got: usize, expected: usize },
    #[error("{got} bytes: expected {HEADER} to {LONGEST_SAVED_STATE}")]
    Length { got: usize },
    #[error("the bytes begin with {got:02x?}: expected {MARK:02x?}, the mark of a saved state")]
    Mark { got: [u8; 8] },
    #[error("a state in version {got} of the format: expected {VERSION}")]
    Version { got: u32 },
    #[error("{got} bytes: expected {expected} according to their header")]
    Payload { got: usize, expected: usize },
    #[error("a state of {got}: expected {expected}")]
    OtherModel { got: TokenName, expected: &'static str },
    #[error("checksum {got:08x}: expected {expected:08x}, the bytes are damaged")]
    Checksum { got: u32, expected: u32 },
    #[error("a state whose phase and times are not readable")]
    InstanceState,
    #[error("a state in the phase \"{got}\", which this instance never reaches")]
    OtherPhase { got: &'static str },
    #[error(
        "a state at t = {now} s with start time {start_time} s: expected finite times, none past the stop time"
    )]
    Times { now: f64, start_time: f64 },
    #[error("a state before the first step in the phase \"{0}\"")]
    Stale(&'static str),
    #[error(transparent)]
    Model(#[from] PersistenceError),
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

/// A token as read from bytes, displayed as the name of its model where it has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TokenName(pub(super) [u8; TOKEN.end - TOKEN.start]);

impl fmt::Display for TokenName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = models().find(|model| model.description.token().as_str().as_bytes() == self.0);
        match (known, core::str::from_utf8(&self.0)) {
            (Some(model), _) => formatter.write_str(model.description.name),
            (None, Ok(token)) => write!(formatter, "another release or library, token {token}"),
            (None, Err(_)) => formatter.write_str("nothing known, its token is no text"),
        }
    }
}
