//! Units as bytes: all that is needed to go on later, elsewhere, bit for bit.
//!
//! The bytes are those of `postcard`: fields in the order of their declaration, floating-point numbers by their bits,
//! so that -0 and every NaN survive. They carry no version of their own; whoever stores them adds one.

use super::Unit;
use super::value::ValueError;
use super::variable::Causality;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Why a unit was not read from bytes; it is left as it was.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PersistenceError {
    #[error("{unit} does not fit into {capacity} bytes")]
    NoRoom { unit: &'static str, capacity: usize },
    #[error("these {length} bytes are no {unit}")]
    Malformed { unit: &'static str, length: usize },
    #[error("these {length} bytes are no {unit}: {excess} of them are too many")]
    TooLong { unit: &'static str, length: usize, excess: usize },
    #[error("a {unit} with {value}")]
    Value { unit: &'static str, value: ValueError },
    #[error("a {unit} whose internal state does not belong to its parameters")]
    Inconsistent { unit: &'static str },
}

/// Saving and restoring, the same for every unit that is plain memory.
pub trait Persistent {
    /// Writes the unit to the beginning of `target` and returns the number of bytes.
    fn save(&self, target: &mut [u8]) -> Result<usize, PersistenceError>;

    /// Becomes the unit that was saved to `source`; `is_initialised` if that one was.
    fn restore(&mut self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError>;

    /// Whether [`Persistent::restore`] would work.
    fn verify(&self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError>;
}

impl<U: Unit + Serialize + DeserializeOwned> Persistent for U {
    fn save(&self, target: &mut [u8]) -> Result<usize, PersistenceError> {
        let capacity = target.len();
        match postcard::to_slice(self, target) {
            Ok(written) => Ok(written.len()),
            Err(_) => Err(PersistenceError::NoRoom { unit: self.description().name, capacity }),
        }
    }

    fn restore(&mut self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError> {
        *self = read(self.description().name, source, is_initialised)?;
        Ok(())
    }

    fn verify(&self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError> {
        read::<U>(self.description().name, source, is_initialised).map(drop)
    }
}

/// Reads a unit called `name`. What a table says of time, parameters and inputs holds for every unit that could have been
/// saved, so anything else is refused.
fn read<U: Unit + DeserializeOwned>(
    name: &'static str,
    source: &[u8],
    is_initialised: bool,
) -> Result<U, PersistenceError> {
    let length = source.len();
    let (unit, rest) = postcard::take_from_bytes::<U>(source)
        .map_err(|_| PersistenceError::Malformed { unit: name, length })?;
    if !rest.is_empty() {
        return Err(PersistenceError::TooLong { unit: name, length, excess: rest.len() });
    }
    for (variable, value) in unit.description().variables.iter().zip(unit.values()) {
        if !variable.is_calculated() || variable.causality == Causality::Independent {
            variable.check(*value).map_err(|value| PersistenceError::Value { unit: name, value })?;
        }
    }
    if !unit.is_consistent(is_initialised) {
        return Err(PersistenceError::Inconsistent { unit: name });
    }
    Ok(unit)
}
