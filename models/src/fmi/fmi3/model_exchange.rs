//! FMI 3.0: functions of model exchange.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output, report};

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3EnterContinuousTimeMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe {
        enter(instance, &may::ENTER_CONTINUOUS_TIME_MODE, |instance| instance.enter_continuous_time_mode())
    }
}

/// Not needed, as the model description says: no model has step events.
///
/// # Safety
/// A live handle, used by one thread at a time; the results are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3CompletedIntegratorStep(
    instance: fmi3Instance,
    _no_set_fmu_state_prior_to_current_point: fmi3Boolean,
    enter_event_mode: *mut fmi3Boolean,
    terminate_simulation: *mut fmi3Boolean,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; the results are null or writable, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::COMPLETED_INTEGRATOR_STEP, |instance| {
            instance.complete_integrator_step()?;
            report(enter_event_mode, FMI3_FALSE);
            report(terminate_simulation, FMI3_FALSE);
            Ok(())
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetTime(instance: fmi3Instance, time: fmi3Float64) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time, as the standard demands of importers.
    unsafe { enter(instance, &may::SET_TIME, |instance| instance.set_time(time)) }
}

/// # Safety
/// A live handle, used by one thread at a time; `states` holds `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetContinuousStates(
    instance: fmi3Instance,
    states: *const fmi3Float64,
    count: usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; `states` holds `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::SET_CONTINUOUS_STATES, |instance| {
            instance.set_continuous_states(input(states, count, "continuousStates")?)
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
            instance: fmi3Instance,
            values: *mut fmi3Float64,
            count: usize,
        ) -> fmi3Status {
            // SAFETY: the handle is live and used by one thread at a time; `values` has room for `count` elements, as
            // the standard demands of importers.
            unsafe {
                enter(instance, &may::$rule, |instance| instance.$get(output(values, count, $argument)?))
            }
        }
    )*};
}

vectors! {
    fmi3GetContinuousStateDerivatives GET_CONTINUOUS_STATE_DERIVATIVES get_derivatives "derivatives";
    fmi3GetEventIndicators GET_EVENT_INDICATORS get_event_indicators "eventIndicators";
    fmi3GetContinuousStates GET_CONTINUOUS_STATES get_continuous_states "continuousStates";
    fmi3GetNominalsOfContinuousStates GET_NOMINALS_OF_CONTINUOUS_STATES get_nominals "nominals";
}

/// A number that never changes, since there are no structural parameters.
macro_rules! counts {
    ($($function:ident $rule:ident $rows:ident;)*) => {$(
        /// # Safety
        /// A live handle, used by one thread at a time; `count` is writable.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $function(instance: fmi3Instance, count: *mut usize) -> fmi3Status {
            // SAFETY: the handle is live and used by one thread at a time; `count` is writable, as the standard
            // demands of importers.
            unsafe {
                enter(instance, &may::$rule, |instance| {
                    instance.require_model_exchange()?;
                    report(count, instance.rows.$rows().len());
                    Ok(())
                })
            }
        }
    )*};
}

counts! {
    fmi3GetNumberOfEventIndicators GET_NUMBER_OF_EVENT_INDICATORS event_indicators;
    fmi3GetNumberOfContinuousStates GET_NUMBER_OF_CONTINUOUS_STATES states;
}
