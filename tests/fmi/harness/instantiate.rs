//! Making instances, every choice open.

use core::ffi::{c_char, c_void};
use core::ptr;

use maglev_fmu::fmi::fmi2::fmi2Instantiate;
use maglev_fmu::fmi::fmi2::types::{
    FMI2_CO_SIMULATION, fmi2Boolean, fmi2CallbackFunctions, fmi2CallbackLogger,
};
use maglev_fmu::fmi::fmi3::fmi3InstantiateCoSimulation;
use maglev_fmu::fmi::fmi3::types::{fmi3Boolean, fmi3LogMessageCallback};

use super::{Standard, fmi2_logger, fmi3_logger};

/// Calls the co-simulation instantiate function with the recording logger. The callback table of FMI 2.0 is gone
/// when this returns, as that standard allows.
///
/// # Safety
/// Null or C strings, and the address of a [`Recorder`] that outlives the instance.
pub unsafe fn instantiate(
    standard: Standard,
    name: *const c_char,
    token: *const c_char,
    environment: *mut c_void,
    logging_on: bool,
) -> *mut c_void {
    // SAFETY: the caller's promise.
    unsafe {
        instantiate_with(
            standard,
            name,
            token,
            ptr::null(),
            environment,
            Some(fmi2_logger()),
            Some(fmi3_logger),
            logging_on,
        )
    }
}

/// As [`instantiate`], with every choice open.
///
/// # Safety
/// As [`instantiate`]; the loggers understand the environment.
#[expect(clippy::too_many_arguments, reason = "as many as the standards have")]
pub unsafe fn instantiate_with(
    standard: Standard,
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    environment: *mut c_void,
    logger2: Option<fmi2CallbackLogger>,
    logger3: Option<fmi3LogMessageCallback>,
    logging_on: bool,
) -> *mut c_void {
    // SAFETY: the caller's promise.
    unsafe {
        match standard {
            Standard::Fmi2 => {
                let functions = fmi2CallbackFunctions {
                    logger: logger2,
                    allocate_memory: None,
                    free_memory: None,
                    step_finished: None,
                    component_environment: environment,
                };
                let logging_on = fmi2Boolean::from(logging_on);
                fmi2Instantiate(name, FMI2_CO_SIMULATION, token, resources, &functions, 0, logging_on)
            }
            Standard::Fmi3 => fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                0,
                fmi3Boolean::from(logging_on),
                0,
                0,
                ptr::null(),
                0,
                environment,
                logger3,
                None,
            ),
        }
    }
}
