//! FMI 3.0: scheduled execution.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::Status;
use crate::fmi::boundary::enter;

/// Runs the tick at `activation_time` \[s\], then tells the importer that the clock `ticked` is active. There is one
/// model partition, so nothing can preempt it, and preemption is never locked.
///
/// # Safety
/// A live handle, used by one thread at a time; the importer's callback calls nothing but what clock update mode allows.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3ActivateModelPartition(
    instance: fmi3Instance,
    clock: fmi3ValueReference,
    activation_time: fmi3Float64,
) -> fmi3Status {
    let mut clock_update = None;
    // SAFETY: the handle is live and used by one thread at a time; the importer's callback calls nothing but what
    // clock update mode allows, as the standard demands of importers.
    let status = unsafe {
        enter(instance, &may::ACTIVATE_MODEL_PARTITION, |instance| {
            instance.activate_model_partition(clock, activation_time)?;
            clock_update = instance.clock_update;
            if clock_update.is_some() {
                instance.enter_clock_update_mode();
            }
            Ok(())
        })
    };
    let Some((callback, environment)) = clock_update else { return status };
    if status != Status::Ok as i32 {
        return status;
    }
    // SAFETY: the callback is valid until the instance is freed, as the standard demands. No reference to the
    // instance is alive, since the importer uses the instance within.
    unsafe { callback(environment) };
    // SAFETY: the handle is live and used by one thread at a time; the importer's callback calls nothing but what
    // clock update mode allows, as the standard demands of importers.
    unsafe {
        enter(instance, &may::RETURN_FROM_CLOCK_UPDATE, |instance| {
            instance.leave_clock_update_mode();
            Ok(())
        })
    }
}
