//! FMI 3.0: version, logging, creation, initialisation, end.
#![allow(non_snake_case, reason = "the names are the standard's")]

use core::ffi::c_char;

use super::legality as may;
use super::types::*;
use crate::fmi::Interface;
use crate::fmi::boundary::{create, enter, free, input};
use crate::fmi::instantiation::Request;
use crate::fmi::intermediate_update::{IntermediateUpdate, RegisteredVariables};
use crate::fmi::log::{Callback, c_string, set_debug_logging};

/// "3.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Switches log categories; no category means all.
///
/// # Safety
/// As the standard demands: a live handle used by one thread at a time, `categories` with `count` C strings.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetDebugLogging(
    instance: fmi3Instance,
    logging_on: fmi3Boolean,
    count: usize,
    categories: *const fmi3String,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, `categories` with `count` C strings, as the
    // standard demands of importers.
    unsafe {
        enter(instance, &may::SET_DEBUG_LOGGING, |instance| {
            set_debug_logging(
                &mut instance.logger,
                logging_on != FMI3_FALSE,
                input(categories, count, "categories")?,
            )
        })
    }
}

/// Makes a co-simulation instance of the model that `token` selects; null and a log message if there is none, or if
/// events are wanted of a model that has none.
///
/// # Safety
/// Strings are null or end with NUL; `required_intermediate_variables` is null or holds as many references as said; the
/// callbacks stay callable while the instance lives.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3InstantiateCoSimulation(
    instance_name: fmi3String,
    token: fmi3String,
    _resource_path: fmi3String,
    _visible: fmi3Boolean,
    logging_on: fmi3Boolean,
    event_mode_used: fmi3Boolean,
    early_return_allowed: fmi3Boolean,
    required_intermediate_variables: *const fmi3ValueReference,
    required_intermediate_variable_count: usize,
    environment: fmi3InstanceEnvironment,
    log_message: Option<fmi3LogMessageCallback>,
    intermediate_update: Option<fmi3IntermediateUpdateCallback>,
) -> fmi3Instance {
    let may_return_early = early_return_allowed != FMI3_FALSE;
    let interface = match event_mode_used {
        FMI3_FALSE => Interface::CoSimulation,
        _ => Interface::CoSimulationWithEvents { may_return_early },
    };
    // SAFETY: strings are null or end with NUL; `required_intermediate_variables` is null or holds as many references
    // as said; the callbacks stay callable while the instance lives, as the standard demands of importers.
    unsafe {
        let request = Request {
            function: "fmi3InstantiateCoSimulation",
            name: c_string(instance_name),
            token: c_string(token),
            callback: callback(log_message, environment),
            logging_on: logging_on != FMI3_FALSE,
            interface: Ok(interface),
        };
        let references = input(
            required_intermediate_variables,
            required_intermediate_variable_count,
            "requiredIntermediateVariables",
        );
        create(&request, |instance| {
            // Recorders register all outputs, clocks among them.
            let count = instance.variables.len() + instance.clocks().count();
            let registered = RegisteredVariables::new(references?, count)?;
            // An importer without intermediate variables does not intend to use intermediate update (section 2.3.1),
            // but has it early return to ask for.
            let is_of_use = required_intermediate_variable_count > 0 || may_return_early;
            instance.intermediate_update = intermediate_update
                .filter(|_| is_of_use)
                .map(|callback| IntermediateUpdate { callback, environment, may_return_early, registered });
            Ok(())
        })
    }
}

/// Makes a model-exchange instance of the model that `token` selects; null and a log message if there is none or if it
/// is a sampled one.
///
/// # Safety
/// As [`fmi3InstantiateCoSimulation`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3InstantiateModelExchange(
    instance_name: fmi3String,
    token: fmi3String,
    _resource_path: fmi3String,
    _visible: fmi3Boolean,
    logging_on: fmi3Boolean,
    environment: fmi3InstanceEnvironment,
    log_message: Option<fmi3LogMessageCallback>,
) -> fmi3Instance {
    // SAFETY: the same holds as for [`fmi3InstantiateCoSimulation`], as the standard demands of importers.
    unsafe {
        let request = Request {
            function: "fmi3InstantiateModelExchange",
            name: c_string(instance_name),
            token: c_string(token),
            callback: callback(log_message, environment),
            logging_on: logging_on != FMI3_FALSE,
            interface: Ok(Interface::ModelExchange),
        };
        create(&request, |_| Ok(()))
    }
}

/// Makes an instance of the sampled model that `token` selects for a scheduler; null and a log message if there is none.
///
/// # Safety
/// As [`fmi3InstantiateCoSimulation`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3InstantiateScheduledExecution(
    instance_name: fmi3String,
    token: fmi3String,
    _resource_path: fmi3String,
    _visible: fmi3Boolean,
    logging_on: fmi3Boolean,
    environment: fmi3InstanceEnvironment,
    log_message: Option<fmi3LogMessageCallback>,
    clock_update: Option<fmi3ClockUpdateCallback>,
    _lock_preemption: Option<fmi3LockPreemptionCallback>,
    _unlock_preemption: Option<fmi3UnlockPreemptionCallback>,
) -> fmi3Instance {
    // SAFETY: the same holds as for [`fmi3InstantiateCoSimulation`], as the standard demands of importers.
    unsafe {
        let request = Request {
            function: "fmi3InstantiateScheduledExecution",
            name: c_string(instance_name),
            token: c_string(token),
            callback: callback(log_message, environment),
            logging_on: logging_on != FMI3_FALSE,
            interface: Ok(Interface::ScheduledExecution),
        };
        create(&request, |instance| {
            instance.clock_update = clock_update.map(|callback| (callback, environment));
            Ok(())
        })
    }
}

fn callback(log_message: Option<fmi3LogMessageCallback>, environment: fmi3InstanceEnvironment) -> Callback {
    log_message.map_or(Callback::None, |log_message| Callback::Fmi3(log_message, environment))
}

/// Frees an instance; null is ignored.
///
/// # Safety
/// `instance` is null or a live handle, dead afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: fmi3Instance) {
    // SAFETY: `instance` is null or a live handle, dead afterwards, as the standard demands of importers.
    unsafe { free(instance) }
}

/// Start and stop time of the experiment \[s\]; the tolerance has no meaning for a model solved in closed form.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3EnterInitializationMode(
    instance: fmi3Instance,
    _tolerance_defined: fmi3Boolean,
    _tolerance: fmi3Float64,
    start_time: fmi3Float64,
    stop_time_defined: fmi3Boolean,
    stop_time: fmi3Float64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(instance, &may::ENTER_INITIALIZATION_MODE, |instance| {
            instance.set_experiment(start_time, (stop_time_defined != FMI3_FALSE).then_some(stop_time))?;
            instance.enter_initialization_mode()
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3ExitInitializationMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::EXIT_INITIALIZATION_MODE, |instance| instance.exit_initialization_mode()) }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3Terminate(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::TERMINATE, |instance| instance.terminate()) }
}

/// Back to the state right after instantiation.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3Reset(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::RESET, |instance| instance.reset()) }
}
