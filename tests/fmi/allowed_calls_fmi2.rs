//! FMI 2.0.5, section 4.2.4: the table of function calls allowed in co-simulation, columns instantiated,
//! Initialization Mode, stepComplete and terminated; model exchange functions are not in it.

use core::ffi::c_void;
use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi2::types::{
    FMI2_DO_STEP_STATUS, FMI2_LAST_SUCCESSFUL_TIME, FMI2_PENDING_STATUS, FMI2_TERMINATED,
};
use maglev_fmu::fmi::fmi2::*;

use super::harness::OK;
use super::life_cycle::Outcome::{self, Discards, NotOffered, PlantsOnly, Refuses, Works};
use super::life_cycle::Row;

/// One reference of each type that both models have: the time, a real.
static TIME: u32 = 0;

fn row(
    name: &'static str,
    allowed: &'static str,
    outcome: Outcome,
    call: unsafe fn(*mut c_void) -> i32,
) -> Row {
    Row { name, allowed, outcome, call }
}

/// Saves a state and frees it.
unsafe fn save_and_free(c: *mut c_void) -> i32 {
    let mut state = null_mut();
    // SAFETY: the caller's promise.
    unsafe {
        let status = fmi2GetFMUstate(c, &mut state);
        if status == OK { fmi2FreeFMUstate(c, &mut state) } else { status }
    }
}

/// The arguments are valid wherever the function is offered.
#[rustfmt::skip]
pub fn table() -> Vec<Row> {
    vec![
        row("fmi2SetDebugLogging", "xxxx", Works, |c| unsafe { fmi2SetDebugLogging(c, 1, 0, null()) }),
        row("fmi2SetupExperiment", "x...", Works, |c| unsafe { fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0) }),
        row("fmi2EnterInitializationMode", "x...", Works, |c| unsafe { fmi2EnterInitializationMode(c) }),
        row("fmi2ExitInitializationMode", ".x..", Works, |c| unsafe { fmi2ExitInitializationMode(c) }),
        row("fmi2Terminate", "..x.", Works, |c| unsafe { fmi2Terminate(c) }),
        row("fmi2Reset", "xxxx", Works, |c| unsafe { fmi2Reset(c) }),
        row("fmi2GetReal", ".xxx", Works, |c| unsafe { fmi2GetReal(c, &TIME, 1, &mut 0.0) }),
        row("fmi2GetInteger", ".xxx", Works, |c| unsafe { fmi2GetInteger(c, null(), 0, null_mut()) }),
        row("fmi2GetBoolean", ".xxx", Works, |c| unsafe { fmi2GetBoolean(c, null(), 0, null_mut()) }),
        row("fmi2GetString", ".xxx", Works, |c| unsafe { fmi2GetString(c, null(), 0, null_mut()) }),
        row("fmi2SetReal", "xxx.", Works, |c| unsafe { fmi2SetReal(c, &1, 1, &0.001) }),
        row("fmi2SetInteger", "xxx.", Works, |c| unsafe { fmi2SetInteger(c, null(), 0, null()) }),
        row("fmi2SetBoolean", "xxx.", Works, |c| unsafe { fmi2SetBoolean(c, null(), 0, null()) }),
        row("fmi2SetString", "xxx.", Works, |c| unsafe { fmi2SetString(c, null(), 0, null()) }),
        row("fmi2GetFMUstate", "xxxx", Works, |c| unsafe { save_and_free(c) }),
        row("fmi2SetFMUstate", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi2SetFMUstate(c, null_mut()) }),
        row("fmi2FreeFMUstate", "xxxx", Works, |c| unsafe { fmi2FreeFMUstate(c, &mut null_mut()) }),
        row("fmi2SerializedFMUstateSize", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi2SerializedFMUstateSize(c, null_mut(), &mut 0) }),
        row("fmi2SerializeFMUstate", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi2SerializeFMUstate(c, null_mut(), null_mut(), 0) }),
        row("fmi2DeSerializeFMUstate", "xxxx", Refuses("0 bytes: expected"), |c| unsafe { fmi2DeSerializeFMUstate(c, null(), 0, &mut null_mut()) }),
        row("fmi2GetDirectionalDerivative", ".xxx", PlantsOnly, |c| unsafe { fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut()) }),
        row("fmi2SetRealInputDerivatives", "xxx.", PlantsOnly, |c| unsafe { fmi2SetRealInputDerivatives(c, null(), 0, null(), null()) }),
        row("fmi2GetRealOutputDerivatives", "..xx", PlantsOnly, |c| unsafe { fmi2GetRealOutputDerivatives(c, null(), 0, null(), null_mut()) }),
        row("fmi2DoStep", "..x.", Works, |c| unsafe { fmi2DoStep(c, 0.005, 0.001, 1) }),
        row("fmi2CancelStep", "....", NotOffered, |c| unsafe { fmi2CancelStep(c) }),
        row("fmi2GetStatus", "..xx", Works, |c| unsafe { fmi2GetStatus(c, FMI2_DO_STEP_STATUS, &mut 0) }),
        row("fmi2GetRealStatus", "..xx", Works, |c| unsafe { fmi2GetRealStatus(c, FMI2_LAST_SUCCESSFUL_TIME, &mut 0.0) }),
        row("fmi2GetIntegerStatus", "..xx", Discards, |c| unsafe { fmi2GetIntegerStatus(c, FMI2_DO_STEP_STATUS, &mut 0) }),
        row("fmi2GetBooleanStatus", "..xx", Works, |c| unsafe { fmi2GetBooleanStatus(c, FMI2_TERMINATED, &mut 0) }),
        row("fmi2GetStringStatus", "..xx", Works, |c| unsafe { fmi2GetStringStatus(c, FMI2_PENDING_STATUS, &mut null()) }),
        // Model exchange only.
        row("fmi2EnterEventMode", "----", NotOffered, |c| unsafe { fmi2EnterEventMode(c) }),
        row("fmi2NewDiscreteStates", "----", NotOffered, |c| unsafe { fmi2NewDiscreteStates(c, null_mut()) }),
        row("fmi2EnterContinuousTimeMode", "----", NotOffered, |c| unsafe { fmi2EnterContinuousTimeMode(c) }),
        row("fmi2CompletedIntegratorStep", "----", NotOffered, |c| unsafe { fmi2CompletedIntegratorStep(c, 1, &mut 0, &mut 0) }),
        row("fmi2SetTime", "----", NotOffered, |c| unsafe { fmi2SetTime(c, 0.0) }),
        row("fmi2SetContinuousStates", "----", NotOffered, |c| unsafe { fmi2SetContinuousStates(c, null(), 0) }),
        row("fmi2GetDerivatives", "----", NotOffered, |c| unsafe { fmi2GetDerivatives(c, null_mut(), 0) }),
        row("fmi2GetEventIndicators", "----", NotOffered, |c| unsafe { fmi2GetEventIndicators(c, null_mut(), 0) }),
        row("fmi2GetContinuousStates", "----", NotOffered, |c| unsafe { fmi2GetContinuousStates(c, null_mut(), 0) }),
        row("fmi2GetNominalsOfContinuousStates", "----", NotOffered, |c| unsafe { fmi2GetNominalsOfContinuousStates(c, null_mut(), 0) }),
    ]
}
