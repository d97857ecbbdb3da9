//! FMI 3.0: saving and restoring the state of an instance.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output};
use crate::fmi::state_handle::{deserialise_state, free_state, get_state, state_behind};

/// Saves the state; into the memory of `*state` if that is not null, otherwise into new memory.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or points to null or to a living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetFMUState(
    instance: fmi3Instance,
    state: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or points to null or to a living
    // state, as the standard demands of importers.
    unsafe { enter(instance, &may::GET_FMU_STATE, |instance| get_state(instance, state)) }
}

/// Goes on from a saved state, which stays valid.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or a living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetFMUState(instance: fmi3Instance, state: fmi3FMUState) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, as the standard
    // demands of importers.
    unsafe { enter(instance, &may::SET_FMU_STATE, |instance| Ok(instance.restore(state_behind(state)?)?)) }
}

/// Frees a state and sets `*state` to null; null, in either place, is ignored.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or points to null or to a living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3FreeFMUState(
    instance: fmi3Instance,
    state: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or points to null or to a living
    // state, as the standard demands of importers.
    unsafe { enter(instance, &may::FREE_FMU_STATE, |_| free_state(state)) }
}

/// Bytes that a state needs when serialised.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or a living state, `size` null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SerializedFMUStateSize(
    instance: fmi3Instance,
    state: fmi3FMUState,
    size: *mut usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, `size` null or
    // writable, as the standard demands of importers.
    unsafe {
        enter(instance, &may::SERIALIZED_FMU_STATE_SIZE, |_| {
            output(size, 1, "size")?[0] = state_behind(state)?.size();
            Ok(())
        })
    }
}

/// Writes a state as bytes.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or a living state, `bytes` holds `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SerializeFMUState(
    instance: fmi3Instance,
    state: fmi3FMUState,
    bytes: *mut fmi3Byte,
    size: usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, `bytes` holds
    // `size` bytes, as the standard demands of importers.
    unsafe {
        enter(instance, &may::SERIALIZE_FMU_STATE, |_| {
            Ok(state_behind(state)?.serialise(output(bytes, size, "serializedState")?)?)
        })
    }
}

/// Makes a state from bytes, if they are those of a state that [`fmi3SetFMUState`] would take.
///
/// # Safety
/// A live handle, used by one thread at a time; `bytes` holds `size` bytes, `state` is null or points to null or to a
/// living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3DeserializeFMUState(
    instance: fmi3Instance,
    bytes: *const fmi3Byte,
    size: usize,
    state: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `bytes` holds `size` bytes, `state` is null or
    // points to null or to a living state, as the standard demands of importers.
    unsafe {
        enter(instance, &may::DESERIALIZE_FMU_STATE, |instance| {
            deserialise_state(instance, input(bytes, size, "serializedState")?, state)
        })
    }
}
