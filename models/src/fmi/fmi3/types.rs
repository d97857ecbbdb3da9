//! C types of FMI 3.0 (fmi3PlatformTypes.h, fmi3FunctionTypes.h), used by the exported functions and by the host.
#![allow(non_camel_case_types, reason = "the names are those of the standard's headers")]

use core::ffi::{c_char, c_int, c_void};

pub type fmi3Instance = *mut c_void;
pub type fmi3InstanceEnvironment = *mut c_void;
pub type fmi3FMUState = *mut c_void;
pub type fmi3ValueReference = u32;
pub type fmi3Float64 = f64;
/// C `bool`; taken as a byte, because a foreign caller may pass other values than 0 and 1.
pub type fmi3Boolean = u8;
pub type fmi3String = *const c_char;
pub type fmi3Byte = u8;
pub type fmi3Binary = *const fmi3Byte;
pub type fmi3Clock = u8;
/// Returned as a plain integer: a foreign library may return anything.
pub type fmi3Status = c_int;
pub type fmi3DependencyKind = c_int;
pub type fmi3IntervalQualifier = c_int;

/// Values of `fmi3IntervalQualifier`.
pub const FMI3_INTERVAL_UNCHANGED: fmi3IntervalQualifier = 1;
pub const FMI3_INTERVAL_CHANGED: fmi3IntervalQualifier = 2;

pub const FMI3_TRUE: fmi3Boolean = 1;
pub const FMI3_FALSE: fmi3Boolean = 0;

/// The callbacks below may throw: what comes through goes on to the importer.
pub type fmi3LogMessageCallback = unsafe extern "C-unwind" fn(
    environment: fmi3InstanceEnvironment,
    status: fmi3Status,
    category: fmi3String,
    message: fmi3String,
);
pub type fmi3ClockUpdateCallback = unsafe extern "C-unwind" fn(environment: fmi3InstanceEnvironment);
pub type fmi3IntermediateUpdateCallback = unsafe extern "C-unwind" fn(
    environment: fmi3InstanceEnvironment,
    time: fmi3Float64,
    variable_set_requested: fmi3Boolean,
    variable_get_allowed: fmi3Boolean,
    step_finished: fmi3Boolean,
    can_return_early: fmi3Boolean,
    early_return_requested: *mut fmi3Boolean,
    early_return_time: *mut fmi3Float64,
);
pub type fmi3LockPreemptionCallback = unsafe extern "C" fn();
pub type fmi3UnlockPreemptionCallback = unsafe extern "C" fn();
