//! Memory that may run out, which is an error and no reason to end the host.

use core::mem::size_of;

use fallible_collections::FallibleBox;
use thiserror::Error;

/// There was no memory left for something.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("out of memory: no room for {what}, {bytes} bytes")]
pub struct OutOfMemory {
    pub what: &'static str,
    pub bytes: usize,
}

/// As `Box::new`, but where that would abort the process this is an error; `what` is for its message.
pub fn try_boxed<T>(what: &'static str, value: T) -> Result<Box<T>, OutOfMemory> {
    FallibleBox::try_new(value).map_err(|_| OutOfMemory { what, bytes: size_of::<T>() })
}

/// An empty vector with room for `capacity` elements, which it takes without asking for memory again.
pub fn try_vector<T>(what: &'static str, capacity: usize) -> Result<Vec<T>, OutOfMemory> {
    let mut vector = Vec::new();
    try_reserve(what, &mut vector, capacity)?;
    Ok(vector)
}

/// Makes room for `more` elements.
pub fn try_reserve<T>(what: &'static str, vector: &mut Vec<T>, more: usize) -> Result<(), OutOfMemory> {
    let bytes = (vector.len().saturating_add(more)).saturating_mul(size_of::<T>());
    vector.try_reserve(more).map_err(|_| OutOfMemory { what, bytes })
}
