//! FMI 2.0: steps and their status.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, report};
use crate::fmi::{CallError, Function, Status};

/// Lets time pass from `current_communication_point` by `communication_step_size` \[s\] with the inputs held.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2DoStep(
    component: fmi2Component,
    current_communication_point: fmi2Real,
    communication_step_size: fmi2Real,
    _no_set_fmu_state_prior_to_current_point: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(component, &may::DO_STEP, |instance| {
            instance.do_step(current_communication_point, communication_step_size)
        })
    }
}

/// Never legal: no step is ever in progress when a call returns.
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2CancelStep(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(component, &may::CANCEL_STEP, |_| Ok(())) }
}

/// Steps are synchronous, so the last one is always over.
///
/// # Safety
/// A live handle, used by one thread at a time; `value` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetStatus(
    component: fmi2Component,
    kind: fmi2StatusKind,
    value: *mut fmi2Status,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `value` is null or writable, as the standard
    // demands of importers.
    unsafe {
        status(component, &may::GET_STATUS, kind, FMI2_DO_STEP_STATUS, value, |_| Status::Ok as fmi2Status)
    }
}

/// Time that the last step reached \[s\].
///
/// # Safety
/// A live handle, used by one thread at a time; `value` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetRealStatus(
    component: fmi2Component,
    kind: fmi2StatusKind,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `value` is null or writable, as the standard
    // demands of importers.
    unsafe {
        status(component, &may::GET_REAL_STATUS, kind, FMI2_LAST_SUCCESSFUL_TIME, value, |instance| {
            instance.state.communication.now()
        })
    }
}

/// The standard defines no integer status.
///
/// # Safety
/// A live handle, used by one thread at a time; `value` is not touched.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetIntegerStatus(
    component: fmi2Component,
    kind: fmi2StatusKind,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `value` is not touched, as the standard demands of
    // importers.
    unsafe {
        enter(component, &may::GET_INTEGER_STATUS, |instance| {
            instance.require_co_simulation()?;
            Err(CallError::NoSuchStatus(kind))
        })
    }
}

/// Whether the model wants to end the simulation: never.
///
/// # Safety
/// A live handle, used by one thread at a time; `value` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetBooleanStatus(
    component: fmi2Component,
    kind: fmi2StatusKind,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `value` is null or writable, as the standard
    // demands of importers.
    unsafe { status(component, &may::GET_BOOLEAN_STATUS, kind, FMI2_TERMINATED, value, |_| FMI2_FALSE) }
}

/// Text for a pending step; empty, since none is ever pending.
///
/// # Safety
/// A live handle, used by one thread at a time; `value` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetStringStatus(
    component: fmi2Component,
    kind: fmi2StatusKind,
    value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `value` is null or writable, as the standard
    // demands of importers.
    unsafe { status(component, &may::GET_STRING_STATUS, kind, FMI2_PENDING_STATUS, value, |_| c"".as_ptr()) }
}

/// Reports one piece of status, if the kind is the one that the function knows.
///
/// # Safety
/// As for the exported functions.
unsafe fn status<T>(
    component: fmi2Component,
    function: &Function,
    kind: fmi2StatusKind,
    known: fmi2StatusKind,
    target: *mut T,
    value: impl FnOnce(&crate::fmi::Instance) -> T,
) -> fmi2Status {
    // SAFETY: as for the exported functions, which pass on what the importer gave them.
    unsafe {
        enter(component, function, |instance| {
            instance.require_co_simulation()?;
            if kind != known {
                return Err(CallError::NoSuchStatus(kind));
            }
            report(target, value(instance));
            Ok(())
        })
    }
}
