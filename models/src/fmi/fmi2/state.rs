//! FMI 2.0: saving and restoring the state of an instance.
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
pub unsafe extern "C-unwind" fn fmi2GetFMUstate(
    component: fmi2Component,
    state: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or points to null or to a living
    // state, as the standard demands of importers.
    unsafe { enter(component, &may::GET_FMU_STATE, |instance| get_state(instance, state)) }
}

/// Goes on from a saved state, which stays valid.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or a living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetFMUstate(component: fmi2Component, state: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, as the standard
    // demands of importers.
    unsafe { enter(component, &may::SET_FMU_STATE, |instance| Ok(instance.restore(state_behind(state)?)?)) }
}

/// Frees a state and sets `*state` to null; null, in either place, is ignored.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or points to null or to a living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2FreeFMUstate(
    component: fmi2Component,
    state: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or points to null or to a living
    // state, as the standard demands of importers.
    unsafe { enter(component, &may::FREE_FMU_STATE, |_| free_state(state)) }
}

/// Bytes that a state needs when serialised.
///
/// # Safety
/// A live handle, used by one thread at a time; `state` is null or a living state, `size` null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SerializedFMUstateSize(
    component: fmi2Component,
    state: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, `size` null or
    // writable, as the standard demands of importers.
    unsafe {
        enter(component, &may::SERIALIZED_FMU_STATE_SIZE, |_| {
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
pub unsafe extern "C-unwind" fn fmi2SerializeFMUstate(
    component: fmi2Component,
    state: fmi2FMUstate,
    bytes: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `state` is null or a living state, `bytes` holds
    // `size` bytes, as the standard demands of importers.
    unsafe {
        enter(component, &may::SERIALIZE_FMU_STATE, |_| {
            Ok(state_behind(state)?.serialise(output(bytes.cast(), size, "serializedState")?)?)
        })
    }
}

/// Makes a state from bytes, if they are those of a state that [`fmi2SetFMUstate`] would take.
///
/// # Safety
/// A live handle, used by one thread at a time; `bytes` holds `size` bytes, `state` is null or points to null or to a
/// living state.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2DeSerializeFMUstate(
    component: fmi2Component,
    bytes: *const fmi2Byte,
    size: usize,
    state: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `bytes` holds `size` bytes, `state` is null or
    // points to null or to a living state, as the standard demands of importers.
    unsafe {
        enter(component, &may::DESERIALIZE_FMU_STATE, |instance| {
            deserialise_state(instance, input(bytes.cast(), size, "serializedState")?, state)
        })
    }
}
