//! C types of FMI 2.0 (fmi2TypesPlatform.h, fmi2FunctionTypes.h), used by the exported functions and by the host.
#![allow(non_camel_case_types, reason = "the names are those of the standard's headers")]

use core::ffi::{c_char, c_int, c_uint, c_void};

pub type fmi2Component = *mut c_void;
pub type fmi2ComponentEnvironment = *mut c_void;
pub type fmi2FMUstate = *mut c_void;
pub type fmi2ValueReference = c_uint;
pub type fmi2Real = f64;
pub type fmi2Integer = c_int;
pub type fmi2Boolean = c_int;
pub type fmi2Char = c_char;
pub type fmi2String = *const fmi2Char;
pub type fmi2Byte = c_char;
/// Returned as a plain integer: a foreign library may return anything.
pub type fmi2Status = c_int;
pub type fmi2StatusKind = c_int;
pub type fmi2Type = c_int;

pub const FMI2_TRUE: fmi2Boolean = 1;
pub const FMI2_FALSE: fmi2Boolean = 0;
pub const FMI2_MODEL_EXCHANGE: fmi2Type = 0;
pub const FMI2_CO_SIMULATION: fmi2Type = 1;

/// Values of `fmi2StatusKind`.
pub const FMI2_DO_STEP_STATUS: fmi2StatusKind = 0;
pub const FMI2_PENDING_STATUS: fmi2StatusKind = 1;
pub const FMI2_LAST_SUCCESSFUL_TIME: fmi2StatusKind = 2;
pub const FMI2_TERMINATED: fmi2StatusKind = 3;

/// The importer's logger; the message is a `printf` format, so a `%` in it must be doubled. It may throw.
pub type fmi2CallbackLogger = unsafe extern "C-unwind" fn(
    environment: fmi2ComponentEnvironment,
    instance_name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
    ...
);
pub type fmi2CallbackAllocateMemory = unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void;
pub type fmi2CallbackFreeMemory = unsafe extern "C" fn(object: *mut c_void);
pub type fmi2StepFinished = unsafe extern "C" fn(environment: fmi2ComponentEnvironment, status: fmi2Status);

/// Importers pass NULL for any of these, hence the options.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct fmi2CallbackFunctions {
    pub logger: Option<fmi2CallbackLogger>,
    pub allocate_memory: Option<fmi2CallbackAllocateMemory>,
    pub free_memory: Option<fmi2CallbackFreeMemory>,
    pub step_finished: Option<fmi2StepFinished>,
    pub component_environment: fmi2ComponentEnvironment,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct fmi2EventInfo {
    pub new_discrete_states_needed: fmi2Boolean,
    pub terminate_simulation: fmi2Boolean,
    pub nominals_of_continuous_states_changed: fmi2Boolean,
    pub values_of_continuous_states_changed: fmi2Boolean,
    pub next_event_time_defined: fmi2Boolean,
    pub next_event_time: fmi2Real,
}
