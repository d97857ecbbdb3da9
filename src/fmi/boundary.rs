//! The one way from C into an instance.

use core::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{CallError, Function, Instance, Phase, Status};

/// Runs `body` on the instance behind `handle` if `function` may be called now; turns refusals into a log message
/// and the status of the error, a panic into [`Status::Fatal`] and an instance that can only be freed.
///
/// # Safety
/// `handle` is null or came from an instantiate function of this library, was not freed, and no other call uses it
/// at the same time, as both standards demand of importers.
#[inline]
pub(super) unsafe fn enter(
    handle: *mut c_void,
    function: &Function,
    body: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> i32 {
    // SAFETY: null is handled by `as_mut`; otherwise the caller's promise.
    let Some(instance) = (unsafe { handle.cast::<Instance>().as_mut() }) else {
        return Status::Error as i32;
    };
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        instance.require(function)?;
        body(instance)
    }));
    match outcome {
        Ok(Ok(())) => Status::Ok as i32,
        Ok(Err(error)) => {
            let status = error.status();
            instance.logger.refusal(status, format_args!("{}: {error}", function.name));
            status as i32
        }
        Err(_) => {
            instance.phase = Phase::Fatal;
            instance.logger.fatal(format_args!(
                "{}: internal error, the instance is lost and can only be freed",
                function.name
            ));
            Status::Fatal as i32
        }
    }
}

/// Runs `make` and hands its instance to the importer; null if there is none.
pub(super) fn create(make: impl FnOnce() -> Option<Instance>) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(make)).unwrap_or_default();
    made.map_or(core::ptr::null_mut(), |instance| Box::into_raw(Box::new(instance)).cast())
}

/// Takes an instance back and drops it; null is ignored.
///
/// # Safety
/// As for [`enter`]; the handle is dead afterwards.
pub(super) unsafe fn free(handle: *mut c_void) {
    if !handle.is_null() {
        // SAFETY: made by `create`, freed once, by the caller's promise. Dropping plain memory cannot panic.
        drop(unsafe { Box::from_raw(handle.cast::<Instance>()) });
    }
}

/// The array at `pointer`; null is fine when it is empty.
///
/// # Safety
/// `pointer` is null or points to `length` readable values for as long as the result is used.
#[inline]
pub(super) unsafe fn input<'a, T>(
    pointer: *const T,
    length: usize,
    name: &'static str,
) -> Result<&'a [T], CallError> {
    if length == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(CallError::NullPointer(name));
    }
    // SAFETY: not null, and long enough by the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts(pointer, length) })
}

/// The array at `pointer`, to be written; null is fine when it is empty.
///
/// # Safety
/// `pointer` is null or points to `length` writable values that nothing else uses meanwhile.
#[inline]
pub(super) unsafe fn output<'a, T>(
    pointer: *mut T,
    length: usize,
    name: &'static str,
) -> Result<&'a mut [T], CallError> {
    if length == 0 {
        return Ok(&mut []);
    }
    if pointer.is_null() {
        return Err(CallError::NullPointer(name));
    }
    // SAFETY: not null, long enough and ours alone by the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, length) })
}

/// Writes a result where the importer asked for it; null means it did not.
///
/// # Safety
/// `pointer` is null or points to a writable value.
#[inline]
pub(super) unsafe fn report<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: not null, writable by the caller's promise.
        unsafe { pointer.write(value) };
    }
}
