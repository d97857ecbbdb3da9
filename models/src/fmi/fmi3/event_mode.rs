//! FMI 3.0: event mode, of model exchange and of co-simulation.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, report};

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3EnterEventMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::ENTER_EVENT_MODE, |instance| instance.enter_event_mode()) }
}

/// Discrete transitions of an event; of a sampled model the tick that is due.
///
/// # Safety
/// A live handle, used by one thread at a time; the results are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3UpdateDiscreteStates(
    instance: fmi3Instance,
    discrete_states_need_update: *mut fmi3Boolean,
    terminate_simulation: *mut fmi3Boolean,
    nominals_of_continuous_states_changed: *mut fmi3Boolean,
    values_of_continuous_states_changed: *mut fmi3Boolean,
    next_event_time_defined: *mut fmi3Boolean,
    next_event_time: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; the results are null or writable, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::UPDATE_DISCRETE_STATES, |instance| {
            let end = instance.update_discrete_states()?;
            report(discrete_states_need_update, end.is_unfinished.into());
            report(terminate_simulation, FMI3_FALSE);
            report(nominals_of_continuous_states_changed, FMI3_FALSE);
            report(values_of_continuous_states_changed, end.have_states_changed.into());
            report(next_event_time_defined, end.next_event_time.is_some().into());
            report(next_event_time, end.next_event_time.unwrap_or_default());
            Ok(())
        })
    }
}

/// Ignored, since providesEvaluateDiscreteStates is false (FMI 3.0.2, section 2.3.5).
///
/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3EvaluateDiscreteStates(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::EVALUATE_DISCRETE_STATES, |_| Ok(())) }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3EnterStepMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::ENTER_STEP_MODE, |instance| instance.enter_step_mode()) }
}
