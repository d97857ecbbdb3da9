//! FMI 2.0: functions of model exchange.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output, report};

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2EnterEventMode(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(component, &may::ENTER_EVENT_MODE, |instance| instance.enter_event_mode()) }
}

/// Discrete transitions of an event, of which one call settles everything. Readings of a sensor are time events.
///
/// # Safety
/// A live handle, used by one thread at a time; `event_info` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2NewDiscreteStates(
    component: fmi2Component,
    event_info: *mut fmi2EventInfo,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `event_info` is null or writable, as the standard
    // demands of importers.
    unsafe {
        enter(component, &may::NEW_DISCRETE_STATES, |instance| {
            let end = instance.update_discrete_states()?;
            report(
                event_info,
                fmi2EventInfo {
                    new_discrete_states_needed: FMI2_FALSE,
                    terminate_simulation: FMI2_FALSE,
                    nominals_of_continuous_states_changed: FMI2_FALSE,
                    values_of_continuous_states_changed: end.have_states_changed.into(),
                    next_event_time_defined: end.next_event_time.is_some().into(),
                    next_event_time: end.next_event_time.unwrap_or_default(),
                },
            );
            Ok(())
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2EnterContinuousTimeMode(component: fmi2Component) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(component, &may::ENTER_CONTINUOUS_TIME_MODE, |instance| instance.enter_continuous_time_mode())
    }
}

/// Not needed, as the model description says: no model has step events.
///
/// # Safety
/// A live handle, used by one thread at a time; the results are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2CompletedIntegratorStep(
    component: fmi2Component,
    _no_set_fmu_state_prior_to_current_point: fmi2Boolean,
    enter_event_mode: *mut fmi2Boolean,
    terminate_simulation: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; the results are null or writable, as the standard
    // demands of importers.
    unsafe {
        enter(component, &may::COMPLETED_INTEGRATOR_STEP, |instance| {
            instance.complete_integrator_step()?;
            report(enter_event_mode, FMI2_FALSE);
            report(terminate_simulation, FMI2_FALSE);
            Ok(())
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetTime(component: fmi2Component, time: fmi2Real) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(component, &may::SET_TIME, |instance| instance.set_time(time)) }
}

/// # Safety
/// A live handle, used by one thread at a time; `states` holds `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetContinuousStates(
    component: fmi2Component,
    states: *const fmi2Real,
    count: usize,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; `states` holds `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(component, &may::SET_CONTINUOUS_STATES, |instance| {
            instance.set_continuous_states(input(states, count, "x")?)
        })
    }
}

/// A getter of one number per continuous state or event indicator.
macro_rules! vectors {
    ($($function:ident $rule:ident $get:ident $argument:literal;)*) => {$(
        /// # Safety
        /// A live handle, used by one thread at a time; `values` has room for `count` elements.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $function(
            component: fmi2Component,
            values: *mut fmi2Real,
            count: usize,
        ) -> fmi2Status {
            // SAFETY: the handle is live and used by one thread at a time; `values` has room for `count` elements, as
            // the standard demands of importers.
            unsafe {
                enter(component, &may::$rule, |instance| instance.$get(output(values, count, $argument)?))
            }
        }
    )*};
}

vectors! {
    fmi2GetDerivatives GET_DERIVATIVES get_derivatives "derivatives";
    fmi2GetEventIndicators GET_EVENT_INDICATORS get_event_indicators "eventIndicators";
    fmi2GetContinuousStates GET_CONTINUOUS_STATES get_continuous_states "x";
    fmi2GetNominalsOfContinuousStates GET_NOMINALS_OF_CONTINUOUS_STATES get_nominals "x_nominal";
}
