//! FMI 3.0.2, sections 2.3 and 4.2: the function calls that the text allows in Instantiated, Initialization Mode,
//! Step Mode and Terminated of a co-simulation model without event mode.

use core::ffi::c_void;
use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi3::*;

use super::harness::OK;
use super::life_cycle::Outcome::{self, NotOffered, PlantsOnly, Refuses, Works};
use super::life_cycle::Row;

/// The time, a Float64 of both models.
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
        let status = fmi3GetFMUState(c, &mut state);
        if status == OK { fmi3FreeFMUState(c, &mut state) } else { status }
    }
}

/// The arguments are valid wherever the function is offered.
#[rustfmt::skip]
pub fn table() -> Vec<Row> {
    vec![
        row("fmi3SetDebugLogging", "xxxx", Works, |c| unsafe { fmi3SetDebugLogging(c, 1, 0, null()) }),
        row("fmi3EnterInitializationMode", "x...", Works, |c| unsafe { fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0) }),
        row("fmi3ExitInitializationMode", ".x..", Works, |c| unsafe { fmi3ExitInitializationMode(c) }),
        row("fmi3EnterEventMode", "..x.", NotOffered, |c| unsafe { fmi3EnterEventMode(c) }),
        row("fmi3Terminate", "..x.", Works, |c| unsafe { fmi3Terminate(c) }),
        row("fmi3Reset", "xxxx", Works, |c| unsafe { fmi3Reset(c) }),
        row("fmi3GetFloat64", "xxxx", Works, |c| unsafe { fmi3GetFloat64(c, &TIME, 1, &mut 0.0, 1) }),
        row("fmi3SetFloat64", "xxx.", Works, |c| unsafe { fmi3SetFloat64(c, &1, 1, &0.001, 1) }),
        row("fmi3GetFloat32", "xxxx", Works, |c| unsafe { fmi3GetFloat32(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetFloat32", "xxx.", Works, |c| unsafe { fmi3SetFloat32(c, null(), 0, null(), 0) }),
        row("fmi3GetInt8", "xxxx", Works, |c| unsafe { fmi3GetInt8(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetInt8", "xxx.", Works, |c| unsafe { fmi3SetInt8(c, null(), 0, null(), 0) }),
        row("fmi3GetUInt8", "xxxx", Works, |c| unsafe { fmi3GetUInt8(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetUInt8", "xxx.", Works, |c| unsafe { fmi3SetUInt8(c, null(), 0, null(), 0) }),
        row("fmi3GetInt16", "xxxx", Works, |c| unsafe { fmi3GetInt16(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetInt16", "xxx.", Works, |c| unsafe { fmi3SetInt16(c, null(), 0, null(), 0) }),
        row("fmi3GetUInt16", "xxxx", Works, |c| unsafe { fmi3GetUInt16(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetUInt16", "xxx.", Works, |c| unsafe { fmi3SetUInt16(c, null(), 0, null(), 0) }),
        row("fmi3GetInt32", "xxxx", Works, |c| unsafe { fmi3GetInt32(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetInt32", "xxx.", Works, |c| unsafe { fmi3SetInt32(c, null(), 0, null(), 0) }),
        row("fmi3GetUInt32", "xxxx", Works, |c| unsafe { fmi3GetUInt32(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetUInt32", "xxx.", Works, |c| unsafe { fmi3SetUInt32(c, null(), 0, null(), 0) }),
        row("fmi3GetInt64", "xxxx", Works, |c| unsafe { fmi3GetInt64(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetInt64", "xxx.", Works, |c| unsafe { fmi3SetInt64(c, null(), 0, null(), 0) }),
        row("fmi3GetUInt64", "xxxx", Works, |c| unsafe { fmi3GetUInt64(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetUInt64", "xxx.", Works, |c| unsafe { fmi3SetUInt64(c, null(), 0, null(), 0) }),
        row("fmi3GetBoolean", "xxxx", Works, |c| unsafe { fmi3GetBoolean(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetBoolean", "xxx.", Works, |c| unsafe { fmi3SetBoolean(c, null(), 0, null(), 0) }),
        row("fmi3GetString", "xxxx", Works, |c| unsafe { fmi3GetString(c, null(), 0, null_mut(), 0) }),
        row("fmi3SetString", "xxx.", Works, |c| unsafe { fmi3SetString(c, null(), 0, null(), 0) }),
        row("fmi3GetBinary", "xxxx", Works, |c| unsafe { fmi3GetBinary(c, null(), 0, null_mut(), null_mut(), 0) }),
        row("fmi3SetBinary", "xxx.", Works, |c| unsafe { fmi3SetBinary(c, null(), 0, null(), null(), 0) }),
        row("fmi3GetClock", "....", NotOffered, |c| unsafe { fmi3GetClock(c, null(), 0, null_mut()) }),
        row("fmi3SetClock", "....", NotOffered, |c| unsafe { fmi3SetClock(c, null(), 0, null()) }),
        row("fmi3GetNumberOfVariableDependencies", "xxxx", NotOffered, |c| unsafe { fmi3GetNumberOfVariableDependencies(c, 2, &mut 0) }),
        row("fmi3GetVariableDependencies", "xxxx", NotOffered, |c| unsafe { fmi3GetVariableDependencies(c, 2, null_mut(), null_mut(), null_mut(), null_mut(), 0) }),
        row("fmi3GetFMUState", "xxxx", Works, |c| unsafe { save_and_free(c) }),
        row("fmi3SetFMUState", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi3SetFMUState(c, null_mut()) }),
        row("fmi3FreeFMUState", "xxxx", Works, |c| unsafe { fmi3FreeFMUState(c, &mut null_mut()) }),
        row("fmi3SerializedFMUStateSize", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi3SerializedFMUStateSize(c, null_mut(), &mut 0) }),
        row("fmi3SerializeFMUState", "xxxx", Refuses("FMUState is a null pointer"), |c| unsafe { fmi3SerializeFMUState(c, null_mut(), null_mut(), 0) }),
        row("fmi3DeserializeFMUState", "xxxx", Refuses("0 bytes: expected"), |c| unsafe { fmi3DeserializeFMUState(c, null(), 0, &mut null_mut()) }),
        row("fmi3GetDirectionalDerivative", ".xxx", PlantsOnly, |c| unsafe { fmi3GetDirectionalDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0) }),
        row("fmi3GetAdjointDerivative", ".xxx", PlantsOnly, |c| unsafe { fmi3GetAdjointDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0) }),
        row("fmi3EnterConfigurationMode", "x.x.", NotOffered, |c| unsafe { fmi3EnterConfigurationMode(c) }),
        row("fmi3ExitConfigurationMode", "....", NotOffered, |c| unsafe { fmi3ExitConfigurationMode(c) }),
        row("fmi3GetIntervalDecimal", ".x..", Works, |c| unsafe { fmi3GetIntervalDecimal(c, null(), 0, null_mut(), null_mut()) }),
        row("fmi3GetIntervalFraction", ".x..", Works, |c| unsafe { fmi3GetIntervalFraction(c, null(), 0, null_mut(), null_mut(), null_mut()) }),
        row("fmi3GetShiftDecimal", ".x..", Works, |c| unsafe { fmi3GetShiftDecimal(c, null(), 0, null_mut()) }),
        row("fmi3GetShiftFraction", ".x..", Works, |c| unsafe { fmi3GetShiftFraction(c, null(), 0, null_mut(), null_mut()) }),
        row("fmi3SetIntervalDecimal", ".x..", Works, |c| unsafe { fmi3SetIntervalDecimal(c, null(), 0, null()) }),
        row("fmi3SetIntervalFraction", ".x..", Works, |c| unsafe { fmi3SetIntervalFraction(c, null(), 0, null(), null()) }),
        row("fmi3SetShiftDecimal", ".x..", NotOffered, |c| unsafe { fmi3SetShiftDecimal(c, null(), 0, null()) }),
        row("fmi3SetShiftFraction", ".x..", NotOffered, |c| unsafe { fmi3SetShiftFraction(c, null(), 0, null(), null()) }),
        row("fmi3EvaluateDiscreteStates", "....", Works, |c| unsafe { fmi3EvaluateDiscreteStates(c) }),
        row("fmi3UpdateDiscreteStates", "....", NotOffered, |c| unsafe { fmi3UpdateDiscreteStates(c, &mut 0, &mut 0, &mut 0, &mut 0, &mut 0, &mut 0.0) }),
        row("fmi3EnterStepMode", "....", NotOffered, |c| unsafe { fmi3EnterStepMode(c) }),
        row("fmi3GetOutputDerivatives", "..xx", PlantsOnly, |c| unsafe { fmi3GetOutputDerivatives(c, null(), 0, null(), null_mut(), 0) }),
        row("fmi3DoStep", "..x.", Works, |c| unsafe { fmi3DoStep(c, 0.005, 0.001, 1, &mut 0, &mut 0, &mut 0, &mut 0.0) }),
        // Model exchange or scheduled execution only.
        row("fmi3EnterContinuousTimeMode", "----", NotOffered, |c| unsafe { fmi3EnterContinuousTimeMode(c) }),
        row("fmi3CompletedIntegratorStep", "----", NotOffered, |c| unsafe { fmi3CompletedIntegratorStep(c, 1, &mut 0, &mut 0) }),
        row("fmi3SetTime", "----", NotOffered, |c| unsafe { fmi3SetTime(c, 0.0) }),
        row("fmi3SetContinuousStates", "----", NotOffered, |c| unsafe { fmi3SetContinuousStates(c, null(), 0) }),
        row("fmi3GetContinuousStateDerivatives", "----", NotOffered, |c| unsafe { fmi3GetContinuousStateDerivatives(c, null_mut(), 0) }),
        row("fmi3GetEventIndicators", "----", NotOffered, |c| unsafe { fmi3GetEventIndicators(c, null_mut(), 0) }),
        row("fmi3GetContinuousStates", "----", NotOffered, |c| unsafe { fmi3GetContinuousStates(c, null_mut(), 0) }),
        row("fmi3GetNominalsOfContinuousStates", "----", NotOffered, |c| unsafe { fmi3GetNominalsOfContinuousStates(c, null_mut(), 0) }),
        row("fmi3GetNumberOfEventIndicators", "----", NotOffered, |c| unsafe { fmi3GetNumberOfEventIndicators(c, &mut 0) }),
        row("fmi3GetNumberOfContinuousStates", "----", NotOffered, |c| unsafe { fmi3GetNumberOfContinuousStates(c, &mut 0) }),
        row("fmi3ActivateModelPartition", "----", NotOffered, |c| unsafe { fmi3ActivateModelPartition(c, 0, 0.0) }),
    ]
}
