//! What an FMU of FMI 2.0 may call: the logger and the C library's memory.

use std::ffi::c_void;
use std::mem::transmute;
use std::ptr::NonNull;
use std::sync::Arc;

use crate::fmi::fmi2::types::*;
use crate::host::message_log::MessageLog;

/// The callback table of one instance, which must not move.
pub(super) struct Callbacks(NonNull<fmi2CallbackFunctions>);

impl Callbacks {
    /// Callbacks that log to `message_log`, which has to outlive the instance.
    pub(super) fn new(message_log: &Arc<MessageLog>) -> Self {
        let callbacks = Box::new(fmi2CallbackFunctions {
            logger: Some(variadic_logger()),
            allocate_memory: Some(calloc),
            free_memory: Some(free),
            step_finished: None,
            component_environment: Arc::as_ptr(message_log).cast_mut().cast(),
        });
        // A raw pointer from here on: the FMU keeps it and reads through it until it is freed.
        Self(NonNull::from(Box::leak(callbacks)))
    }

    pub(super) fn as_ptr(&self) -> *const fmi2CallbackFunctions {
        self.0.as_ptr()
    }
}

impl Drop for Callbacks {
    fn drop(&mut self) {
        // SAFETY: the pointer came from `Box::leak`, and the instance that used it is gone.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

unsafe extern "C" {
    // The C library's own, which the standard suggests and every program of the standard library links.
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(object: *mut c_void);
}

/// Collects a message; the arguments after the format string stay unread. Never unwinds, whatever its type allows.
unsafe extern "C-unwind" fn log(
    environment: fmi2ComponentEnvironment,
    _instance_name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
) {
    // SAFETY: the environment is the message_log of a living instance, the strings are C strings or NULL.
    unsafe {
        MessageLog::append(environment.cast_const().cast(), status, category, message, |text| {
            text.replace("%%", "%")
        });
    }
}

fn variadic_logger() -> fmi2CallbackLogger {
    type FixedArguments =
        unsafe extern "C-unwind" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String);
    // SAFETY: stable Rust cannot define a variadic function. On the C ABIs of the supported platforms (System V
    // x86-64, Windows x64, AAPCS64 and Apple's variant of it) the named arguments of a variadic call, all of them
    // pointers and one int here, lie where those of an ordinary call lie, and the caller cleans up the rest.
    // `log` reads the named arguments only, so it cannot tell the difference.
    unsafe { transmute::<FixedArguments, fmi2CallbackLogger>(log) }
}
