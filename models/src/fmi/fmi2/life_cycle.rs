//! FMI 2.0: version, logging, creation, initialisation, end.
#![allow(non_snake_case, reason = "the names are the standard's")]

use core::ffi::c_char;

use super::legality as may;
use super::types::*;
use crate::fmi::Interface;
use crate::fmi::boundary::{create, enter, free, input};
use crate::fmi::instantiation::Request;
use crate::fmi::log::{Callback, c_string, set_debug_logging};

/// Name of the platform's type definitions, always "default".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// "2.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Switches log categories; no category means all.
///
/// # Safety
/// As the standard demands: a live handle used by one thread at a time, `categories` with `count` C strings.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetDebugLogging(
    component: fmi2Component,
    logging_on: fmi2Boolean,
    count: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, `categories` with `count` C strings, as the
    // standard demands of importers.
    unsafe {
        enter(component, &may::SET_DEBUG_LOGGING, |instance| {
            set_debug_logging(
                &mut instance.logger,
                logging_on != FMI2_FALSE,
                input(categories, count, "categories")?,
            )
        })
    }
}

/// Makes an instance of the model that `guid` selects; null and a log message if there is none.
///
/// # Safety
/// Strings are null or end with NUL; `functions` is null or valid, and its logger stays callable while the instance
/// lives.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2Instantiate(
    instance_name: fmi2String,
    fmu_type: fmi2Type,
    guid: fmi2String,
    _resource_location: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    logging_on: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: `functions` is null, as some importers pass it, or points to callbacks that stay valid during the call.
    let callback = unsafe { functions.as_ref() }
        .and_then(|functions| Some(Callback::Fmi2(functions.logger?, functions.component_environment)))
        .unwrap_or(Callback::None);
    let interface = match fmu_type {
        FMI2_CO_SIMULATION => Ok(Interface::CoSimulation),
        FMI2_MODEL_EXCHANGE => Ok(Interface::ModelExchange),
        _ => Err("an unknown fmi2Type"),
    };
    // SAFETY: strings are null or end with NUL; `functions` is null or valid, and its logger stays callable while the
    // instance lives, as the standard demands of importers.
    unsafe {
        let request = Request {
            function: "fmi2Instantiate",
            name: c_string(instance_name),
            token: c_string(guid),
            callback,
            logging_on: logging_on != FMI2_FALSE,
            interface,
        };
        create(&request, |_| Ok(()))
    }
}

/// Frees an instance; null is ignored.
///
/// # Safety
/// `component` is null or a live handle, dead afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: fmi2Component) {
    // SAFETY: `component` is null or a live handle, dead afterwards, as the standard demands of importers.
    unsafe { free(component) }
}

/// Start and stop time of the experiment \[s\]; the tolerance has no meaning for a model solved in closed form.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetupExperiment(
    component: fmi2Component,
    _tolerance_defined: fmi2Boolean,
    _tolerance: fmi2Real,
    start_time: fmi2Real,
    stop_time_defined: fmi2Boolean,
    stop_time: fmi2Real,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(component, &may::SETUP_EXPERIMENT, |instance| {
            instance.set_experiment(start_time, (stop_time_defined != FMI2_FALSE).then_some(stop_time))
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2EnterInitializationMode(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(component, &may::ENTER_INITIALIZATION_MODE, |instance| instance.enter_initialization_mode())
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2ExitInitializationMode(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(component, &may::EXIT_INITIALIZATION_MODE, |instance| instance.exit_initialization_mode())
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2Terminate(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(component, &may::TERMINATE, |instance| instance.terminate()) }
}

/// Back to the state right after instantiation.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2Reset(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(component, &may::RESET, |instance| instance.reset()) }
}
