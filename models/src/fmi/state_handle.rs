//! Handles of saved states, `fmi2FMUstate` and `fmi3FMUState`, which the standards define alike.

use core::ffi::c_void;

use super::{CallError, Instance, SavedState, StateError};
use crate::model::memory::try_boxed;

/// The state behind a handle.
///
/// # Safety
/// `state` is null, or a state that this library made and that was not freed. Others are recognised by their
/// alignment and their first bytes, which catches mistakes but no malice.
pub(super) unsafe fn state_behind<'a>(state: *mut c_void) -> Result<&'a SavedState, CallError> {
    // SAFETY: `state` is null or a state of this library that was not freed, so what `living` accepts may be read.
    unsafe { living(state).map(|state| &*state) }
}

/// Saves the state of `instance` into the memory behind `*target`, new memory if that is null.
///
/// # Safety
/// `target` is null or points to a handle as for [`state_behind`].
pub(super) unsafe fn get_state(instance: &mut Instance, target: *mut *mut c_void) -> Result<(), CallError> {
    // SAFETY: `target` is null, which `as_mut` handles, or points to a handle that the importer owns.
    let target = unsafe { target.as_mut() }.ok_or(CallError::NullPointer("FMUState"))?;
    if !target.is_null() {
        // SAFETY: `*target` was made by [`on_the_heap`] and not freed; no other reference to it exists during the
        // call.
        return Ok(instance.save(unsafe { &mut *living(*target)? })?);
    }
    let mut state = SavedState::new(instance.model.description());
    instance.save(&mut state)?;
    *target = on_the_heap(state)?;
    Ok(())
}

/// Makes a state from bytes, in the memory behind `*target`, in new memory if that is null.
///
/// # Safety
/// As [`get_state`].
pub(super) unsafe fn deserialise_state(
    instance: &Instance,
    bytes: &[u8],
    target: *mut *mut c_void,
) -> Result<(), CallError> {
    // SAFETY: `target` is null, which `as_mut` handles, or points to a handle that the importer owns.
    let target = unsafe { target.as_mut() }.ok_or(CallError::NullPointer("FMUState"))?;
    let state = SavedState::deserialise(bytes, instance.model.description())?;
    instance.verify(&state)?;
    if target.is_null() {
        *target = on_the_heap(state)?;
    } else {
        // SAFETY: `*target` was made by [`on_the_heap`] and not freed; no other reference to it exists during the
        // call.
        unsafe { *living(*target)? = state };
    }
    Ok(())
}

/// A handle of `state`, freed by [`free_state`].
fn on_the_heap(state: SavedState) -> Result<*mut c_void, StateError> {
    Ok(Box::into_raw(try_boxed("a saved state", state)?).cast())
}

/// Frees a state; null is ignored.
///
/// # Safety
/// As [`get_state`]; the handle is dead afterwards.
pub(super) unsafe fn free_state(target: *mut *mut c_void) -> Result<(), CallError> {
    // SAFETY: `target` is null, which `as_mut` handles, or points to a handle that the importer owns.
    let Some(target) = (unsafe { target.as_mut() }).filter(|target| !target.is_null()) else {
        return Ok(());
    };
    // SAFETY: made by [`on_the_heap`] and freed once: the handle becomes null below, and a copy of it is no longer
    // alive.
    unsafe {
        let state = living(*target)?;
        (*state).invalidate();
        drop(Box::from_raw(state));
    }
    *target = core::ptr::null_mut();
    Ok(())
}

/// # Safety
/// As [`state_behind`].
unsafe fn living(state: *mut c_void) -> Result<*mut SavedState, CallError> {
    if state.is_null() {
        return Err(CallError::NullPointer("FMUState"));
    }
    let state = state.cast::<SavedState>();
    // SAFETY: not null and aligned, and memory that was a state of this library until it is freed.
    if state.is_aligned() && unsafe { (*state).is_alive() } {
        Ok(state)
    } else {
        Err(StateError::NoHandle.into())
    }
}
