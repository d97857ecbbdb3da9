//! The one way from C into an instance, and back to the importer's logger.
//!
//! A call has two parts. Within the first the model computes, in a floating-point environment of its own, a panic is
//! caught, and messages are collected. In the second they are sent: the logger may throw or jump away over what is on
//! the stack by then, which is plain memory, and finds the instance as the call has left it. Other callbacks are called
//! between two such calls.

use core::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::floating_point::in_default_environment;
use super::instantiation::Request;
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
    // SAFETY: `handle` is null or a live instance that nobody else uses, by this function's own contract.
    unsafe { run(handle, function, |instance| in_default_environment(|| body(instance))) }
}

/// As [`enter`], for a body that copies numbers and compares none, or sees to the floating-point environment itself.
///
/// # Safety
/// As [`enter`].
#[inline]
pub(super) unsafe fn enter_to_copy(
    handle: *mut c_void,
    function: &Function,
    body: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> i32 {
    // SAFETY: `handle` is null or a live instance that nobody else uses, by this function's own contract.
    unsafe { run(handle, function, body) }
}

/// # Safety
/// As [`enter`].
#[inline]
unsafe fn run(
    handle: *mut c_void,
    function: &Function,
    body: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> i32 {
    let handle = handle.cast::<Instance>();
    // SAFETY: null is handled by `as_mut`; anything else is a live instance that nobody else uses during the call.
    let Some(instance) = (unsafe { handle.as_mut() }) else {
        return Status::Error as i32;
    };
    let status = catch_unwind(AssertUnwindSafe(|| {
        let outcome = match instance.require(function) {
            Ok(()) => body(instance),
            Err(error) => Err(error),
        };
        match outcome {
            Ok(()) => Status::Ok,
            Err(error) => refuse(instance, function, &error),
        }
    }));
    let status = match status {
        Ok(status) => status,
        Err(_) => lose(instance, function),
    };
    if !instance.logger.outbox.is_empty() {
        // SAFETY: a live instance; the reference above is not used again.
        unsafe { deliver(handle) };
    }
    status as i32
}

#[cold]
fn refuse(instance: &mut Instance, function: &Function, error: &CallError) -> Status {
    let status = error.status();
    // Numbers are compared and rounded to be written.
    in_default_environment(|| instance.logger.refusal(status, format_args!("{}: {error}", function.name)));
    status
}

#[cold]
fn lose(instance: &mut Instance, function: &Function) -> Status {
    instance.state.phase = Phase::Fatal;
    let name = function.name;
    let message = format_args!("{name}: internal error, the instance is lost and can only be freed");
    instance.logger.refusal(Status::Fatal, message);
    Status::Fatal
}

/// Result of `body`, which computes in the default floating-point environment; `None` if it panicked.
#[inline]
fn guarded<R>(body: impl FnOnce() -> R) -> Option<R> {
    catch_unwind(AssertUnwindSafe(|| in_default_environment(body))).ok()
}

/// Sends what an instance has to say. What the importer leaves unread by not coming back follows the next call.
///
/// # Safety
/// A live instance to which no reference is alive.
#[cold]
unsafe fn deliver(handle: *mut Instance) {
    loop {
        // SAFETY: `handle` is a live instance; this reference is the only one and ends before the importer is called.
        let logger = unsafe { &mut (*handle).logger };
        let (callback, name) = (logger.callback, logger.instance_name());
        let Some(message) = logger.outbox.take() else { return };
        // SAFETY: both standards demand that the callback and its environment stay valid until the instance is freed.
        unsafe { callback.send(name, &message) };
    }
}

/// Makes the instance that is asked for and hands it to the importer; null and a message if there is none.
///
/// # Safety
/// The callback in `request` may be called with its environment, as both standards demand of importers.
#[allow(clippy::result_large_err, reason = "messages lie on the stack, for there may be no heap left")]
pub(super) unsafe fn create(
    request: &Request<'_>,
    configure: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> *mut c_void {
    let callback = request.callback;
    let name = request.name.unwrap_or(c"").as_ptr();
    let announced = guarded(|| request.announce());
    let message = match announced {
        Some(Ok(message)) => {
            if request.logging_on {
                // An instance would be out of reach for ever if the importer did not come back: it is made after this.
                // SAFETY: the importer has passed `callback` with the call that is being answered, so it may be
                // called.
                unsafe { callback.send(name, &message) };
            }
            match guarded(|| request.make(configure).map(Box::into_raw)) {
                Some(Ok(instance)) => return instance.cast(),
                Some(Err(message)) => message,
                None => request.failure(),
            }
        }
        Some(Err(message)) => message,
        None => request.failure(),
    };
    // SAFETY: the importer has passed `callback` with the call that is being answered, so it may be called.
    unsafe { callback.send(name, &message) };
    core::ptr::null_mut()
}

/// Takes an instance back and drops it; null is ignored.
///
/// # Safety
/// As for [`enter`]; the handle is dead afterwards.
pub(super) unsafe fn free(handle: *mut c_void) {
    if !handle.is_null() {
        // SAFETY: made by `create` and freed once, as the standards demand. Dropping plain memory cannot panic.
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
    // SAFETY: not null, and `length` values long, for the importer has told the length of its own array.
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
    // SAFETY: not null, `length` values long, for the importer has told the length of its own array, and not used by
    // it during the call.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, length) })
}

/// Writes a result where the importer asked for it; null means it did not.
///
/// # Safety
/// `pointer` is null or points to a writable value.
#[inline]
pub(super) unsafe fn report<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: not null, so a variable of the importer that waits for this result.
        unsafe { pointer.write(value) };
    }
}
