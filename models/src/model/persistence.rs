//! Models as bytes: all that is needed to go on later, elsewhere, bit for bit.
//!
//! The bytes are those of `postcard`: fields in the order of their declaration, floating-point numbers by their bits,
//! so that -0 and every NaN survive. They carry no version of their own; whoever stores them adds one.

use super::Model;
use super::value::ValueError;
use super::variable::Causality;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Why a model was not read from bytes; it is left as it was.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PersistenceError {
    #[error("{model} does not fit into {capacity} bytes")]
    NoRoom { model: &'static str, capacity: usize },
    #[error("not a valid serialised {model} state ({length} bytes)")]
    Malformed { model: &'static str, length: usize },
    #[error("not a valid serialised {model} state: {length} bytes, {excess} too many")]
    TooLong { model: &'static str, length: usize, excess: usize },
    #[error("not a valid {model} state: {value}")]
    Value { model: &'static str, value: ValueError },
    #[error("not a valid {model} state: the internal state is inconsistent with the parameters")]
    Inconsistent { model: &'static str },
}

/// Saving and restoring, the same for every model that is plain memory.
pub trait Persistent {
    /// Writes the model to the beginning of `target` and returns the number of bytes.
    fn save(&self, target: &mut [u8]) -> Result<usize, PersistenceError>;

    /// Becomes the model that was saved to `source`; `is_initialised` if that one was.
    fn restore(&mut self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError>;

    /// Whether [`Persistent::restore`] would work.
    fn verify(&self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError>;
}

impl<M: Model + Serialize + DeserializeOwned> Persistent for M {
    fn save(&self, target: &mut [u8]) -> Result<usize, PersistenceError> {
        let capacity = target.len();
        match postcard::to_slice(self, target) {
            Ok(written) => Ok(written.len()),
            Err(_) => Err(PersistenceError::NoRoom { model: self.description().name, capacity }),
        }
    }

    fn restore(&mut self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError> {
        *self = read(self.description().name, source, is_initialised)?;
        Ok(())
    }

    fn verify(&self, source: &[u8], is_initialised: bool) -> Result<(), PersistenceError> {
        read::<M>(self.description().name, source, is_initialised).map(drop)
    }
}

/// Reads a model called `name`. What a table says of time, parameters and inputs holds for every model that could have been
/// saved, so anything else is refused.
fn read<M: Model + DeserializeOwned>(
    name: &'static str,
    source: &[u8],
    is_initialised: bool,
) -> Result<M, PersistenceError> {
    let length = source.len();
    let (model, rest) = postcard::take_from_bytes::<M>(source)
        .map_err(|_| PersistenceError::Malformed { model: name, length })?;
    if !rest.is_empty() {
        return Err(PersistenceError::TooLong { model: name, length, excess: rest.len() });
    }
    for (variable, value) in model.description().variables.iter().zip(model.values()) {
        if !variable.is_calculated() || variable.causality == Causality::Independent {
            variable.check(*value).map_err(|value| PersistenceError::Value { model: name, value })?;
        }
    }
    if !model.is_consistent(is_initialised) {
        return Err(PersistenceError::Inconsistent { model: name });
    }
    Ok(model)
}
