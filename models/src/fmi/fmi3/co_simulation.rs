//! FMI 3.0: steps.
#![allow(non_snake_case, reason = "the names are the standard's")]

use core::cell::Cell;

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, report};
use crate::fmi::intermediate_update::Progress;
use crate::fmi::{CallError, Instance};

/// Lets time pass from `current_communication_point` by `communication_step_size` \[s\] with the inputs held, or up to
/// the next tick if the importer handles events.
///
/// # Safety
/// A live handle, used by one thread at a time; the results are null or writable; the importer's callback calls nothing
/// but what intermediate update mode allows.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3DoStep(
    instance: fmi3Instance,
    current_communication_point: fmi3Float64,
    communication_step_size: fmi3Float64,
    _no_set_fmu_state_prior_to_current_point: fmi3Boolean,
    event_handling_needed: *mut fmi3Boolean,
    terminate_simulation: *mut fmi3Boolean,
    early_return: *mut fmi3Boolean,
    last_successful_time: *mut fmi3Float64,
) -> fmi3Status {
    let waiting = Cell::new(None);
    // What a part of the step has come to.
    let conclude = |instance: &mut Instance, outcome: Result<Progress, CallError>| {
        let (mut is_event, mut is_early) = (FMI3_FALSE, FMI3_FALSE);
        let outcome = outcome.map(|progress| match progress {
            Progress::Done(end) => (is_event, is_early) = (end.is_event.into(), end.is_early.into()),
            Progress::Waits(update, time) => waiting.set(Some((update, time))),
        });
        // SAFETY: the handle is live and used by one thread at a time; the results are null or writable; the
        // importer's callback calls nothing but what intermediate update mode allows, as the standard demands of
        // importers.
        unsafe {
            report(event_handling_needed, is_event);
            report(terminate_simulation, FMI3_FALSE);
            report(early_return, is_early);
            report(last_successful_time, instance.state.communication.now());
        }
        outcome
    };
    // SAFETY: the handle is live and used by one thread at a time; the results are null or writable; the importer's
    // callback calls nothing but what intermediate update mode allows, as the standard demands of importers.
    let mut status = unsafe {
        enter(instance, &may::DO_STEP, |instance| {
            let outcome = instance.begin_step(current_communication_point, communication_step_size);
            conclude(instance, outcome)
        })
    };
    while let Some((update, time)) = waiting.take() {
        let (mut is_requested, mut return_time) = (FMI3_FALSE, time);
        // SAFETY: the callback is valid until the instance is freed, as the standard demands; both results have room.
        // No reference to the instance is alive, since the importer uses the instance within.
        unsafe {
            (update.callback)(
                update.environment,
                time,
                FMI3_TRUE,
                FMI3_TRUE,
                FMI3_TRUE,
                update.may_return_early.into(),
                &mut is_requested,
                &mut return_time,
            );
        }
        let early_return = (is_requested != FMI3_FALSE).then_some(return_time);
        // SAFETY: the handle is live and used by one thread at a time; the results are null or writable; the
        // importer's callback calls nothing but what intermediate update mode allows, as the standard demands of
        // importers.
        status = unsafe {
            enter(instance, &may::RETURN_FROM_INTERMEDIATE_UPDATE, |instance| {
                let outcome = instance.resume_step(early_return);
                conclude(instance, outcome)
            })
        };
    }
    status
}
