//! FMI 3.0: steps.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, report};

/// Lets time pass from `current_communication_point` by `communication_step_size` \[s\] with the inputs held.
///
/// # Safety
/// A live handle, used by one thread at a time; the results are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: fmi3Instance,
    current_communication_point: fmi3Float64,
    communication_step_size: fmi3Float64,
    _no_set_fmu_state_prior_to_current_point: fmi3Boolean,
    event_handling_needed: *mut fmi3Boolean,
    terminate_simulation: *mut fmi3Boolean,
    early_return: *mut fmi3Boolean,
    last_successful_time: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: the caller's promise.
    unsafe {
        enter(instance, &may::DO_STEP, |instance| {
            let outcome = instance.do_step(current_communication_point, communication_step_size);
            report(event_handling_needed, FMI3_FALSE);
            report(terminate_simulation, FMI3_FALSE);
            report(early_return, FMI3_FALSE);
            report(last_successful_time, instance.communication.now());
            outcome
        })
    }
}
