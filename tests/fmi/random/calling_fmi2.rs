//! Calls of FMI 2.0 as a C importer makes them.

use core::ffi::{CStr, c_void};
use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi2::types::*;
use maglev_fmu::fmi::fmi2::*;

use super::answer::{Answer, pointer, pointer_mut};
use super::call::{Call, Category, Experiment};
use super::environment::in_host;

/// Makes a call on a living instance. Calls about saved states are made elsewhere.
///
/// # Safety
/// A live handle; callbacks and environment of the instance are alive.
pub unsafe fn send(handle: *mut c_void, call: &Call) -> Answer {
    // SAFETY: the caller's promise; arrays have the lengths that are said, or are null, which is checked.
    unsafe {
        match call {
            Call::Logging { on, categories, is_null } => {
                let names: Vec<_> = categories.iter().map(name).collect();
                Answer::of(in_host(|| {
                    fmi2SetDebugLogging(handle, (*on).into(), names.len(), pointer(&names, *is_null))
                }))
            }
            Call::Setup(Experiment { start, stop, tolerance }) => Answer::of(in_host(|| {
                fmi2SetupExperiment(
                    handle,
                    tolerance.is_some().into(),
                    tolerance.unwrap_or(f64::NAN),
                    *start,
                    stop.is_some().into(),
                    stop.unwrap_or(f64::NAN),
                )
            })),
            Call::EnterInitialization(_) => Answer::of(in_host(|| fmi2EnterInitializationMode(handle))),
            Call::Plain(function) => Answer::of(in_host(|| plain(function)(handle))),
            Call::Get { function, references, is_null, .. } => get(handle, function, references, *is_null),
            Call::Set { function, references, values, is_null, .. } => {
                set(handle, function, references, values, *is_null)
            }
            Call::UpdateDiscreteStates { is_null } => update(handle, *is_null),
            Call::CompletedStep { is_null } => {
                let mut results = [7; 2];
                let [enter, end] = &mut results;
                let [enter, end] =
                    [enter, end].map(|result| if *is_null { null_mut() } else { result as *mut _ });
                let status = in_host(|| fmi2CompletedIntegratorStep(handle, 1, enter, end));
                assert!(status != 0 || *is_null || results == [0; 2]);
                Answer::of(status)
            }
            Call::SetTime(time) => Answer::of(in_host(|| fmi2SetTime(handle, *time))),
            Call::SetStates { states, is_null } => Answer::of(in_host(|| {
                fmi2SetContinuousStates(handle, pointer(states, *is_null), states.len())
            })),
            Call::GetVector { function, length, is_null } => {
                let mut values = vec![0.0; *length];
                let status =
                    in_host(|| vector(function)(handle, pointer_mut(&mut values, *is_null), *length));
                Answer::with_values(status, values)
            }
            Call::Step { point, size, is_final } => {
                let status = in_host(|| fmi2DoStep(handle, *point, *size, (*is_final).into()));
                Answer { reached: point + size, ..Answer::of(status) }
            }
            Call::Partial { unknowns, knowns, seed, .. } => {
                let mut values = vec![0.0; unknowns.len()];
                let status = in_host(|| {
                    fmi2GetDirectionalDerivative(
                        handle,
                        unknowns.as_ptr(),
                        unknowns.len(),
                        knowns.as_ptr(),
                        knowns.len(),
                        seed.as_ptr(),
                        values.as_mut_ptr(),
                    )
                });
                Answer::with_values(status, values)
            }
            Call::SetSlopes { references, orders, values } => Answer::of(in_host(|| {
                fmi2SetRealInputDerivatives(
                    handle,
                    references.as_ptr(),
                    references.len(),
                    orders.as_ptr(),
                    values.as_ptr(),
                )
            })),
            Call::GetSlopes { references, orders } => {
                let mut values = vec![0.0; references.len()];
                let status = in_host(|| {
                    fmi2GetRealOutputDerivatives(
                        handle,
                        references.as_ptr(),
                        references.len(),
                        orders.as_ptr(),
                        values.as_mut_ptr(),
                    )
                });
                Answer::with_values(status, values)
            }
            Call::Status { function, kind } => status(handle, function, *kind),
            _ => unreachable!("{call:?}"),
        }
    }
}

fn name(category: &Category) -> *const core::ffi::c_char {
    match category {
        Category::Declared(name) => name.as_ptr(),
        Category::Unknown => c"unknown % #".as_ptr(),
        Category::Null => null(),
    }
}

fn plain(function: &str) -> unsafe extern "C-unwind" fn(*mut c_void) -> i32 {
    match function {
        "fmi2ExitInitializationMode" => fmi2ExitInitializationMode,
        "fmi2Terminate" => fmi2Terminate,
        "fmi2Reset" => fmi2Reset,
        "fmi2EnterEventMode" => fmi2EnterEventMode,
        "fmi2EnterContinuousTimeMode" => fmi2EnterContinuousTimeMode,
        "fmi2CancelStep" => fmi2CancelStep,
        _ => unreachable!("{function}"),
    }
}

fn vector(function: &str) -> unsafe extern "C-unwind" fn(*mut c_void, *mut f64, usize) -> i32 {
    match function {
        "fmi2GetDerivatives" => fmi2GetDerivatives,
        "fmi2GetEventIndicators" => fmi2GetEventIndicators,
        "fmi2GetContinuousStates" => fmi2GetContinuousStates,
        "fmi2GetNominalsOfContinuousStates" => fmi2GetNominalsOfContinuousStates,
        _ => unreachable!("{function}"),
    }
}

unsafe fn get(handle: *mut c_void, function: &str, references: &[u32], is_null: bool) -> Answer {
    let (r, n) = (pointer(references, is_null), references.len());
    let (mut reals, mut integers, mut texts) = (vec![0.0; n], vec![0; n], vec![null(); n]);
    // SAFETY: the caller's promise.
    let status = unsafe {
        match function {
            "fmi2GetReal" => in_host(|| fmi2GetReal(handle, r, n, pointer_mut(&mut reals, is_null))),
            "fmi2GetInteger" => in_host(|| fmi2GetInteger(handle, r, n, pointer_mut(&mut integers, is_null))),
            "fmi2GetBoolean" => in_host(|| fmi2GetBoolean(handle, r, n, pointer_mut(&mut integers, is_null))),
            "fmi2GetString" => in_host(|| fmi2GetString(handle, r, n, pointer_mut(&mut texts, is_null))),
            _ => unreachable!("{function}"),
        }
    };
    if function != "fmi2GetReal" {
        reals = integers.iter().map(|value| f64::from(*value)).collect();
    }
    Answer::with_values(status, reals)
}

unsafe fn set(
    handle: *mut c_void,
    function: &str,
    references: &[u32],
    values: &[f64],
    is_null: bool,
) -> Answer {
    let (r, n) = (pointer(references, is_null), references.len());
    let integers: Vec<i32> = values.iter().map(|value| *value as i32).collect();
    let texts = vec![c"text".as_ptr(); n];
    // SAFETY: the caller's promise.
    Answer::of(unsafe {
        match function {
            "fmi2SetReal" => in_host(|| fmi2SetReal(handle, r, n, pointer(values, is_null))),
            "fmi2SetInteger" => in_host(|| fmi2SetInteger(handle, r, n, pointer(&integers, is_null))),
            "fmi2SetBoolean" => in_host(|| fmi2SetBoolean(handle, r, n, pointer(&integers, is_null))),
            "fmi2SetString" => in_host(|| fmi2SetString(handle, r, n, pointer(&texts, is_null))),
            _ => unreachable!("{function}"),
        }
    })
}

unsafe fn update(handle: *mut c_void, is_null: bool) -> Answer {
    let mut info = fmi2EventInfo {
        new_discrete_states_needed: 7,
        terminate_simulation: 0,
        nominals_of_continuous_states_changed: 0,
        values_of_continuous_states_changed: 0,
        next_event_time_defined: 0,
        next_event_time: 0.0,
    };
    // SAFETY: the caller's promise; null is allowed.
    let status =
        unsafe { in_host(|| fmi2NewDiscreteStates(handle, if is_null { null_mut() } else { &mut info })) };
    let values = if info.next_event_time_defined == 1 { vec![info.next_event_time] } else { Vec::new() };
    assert_eq!(info.terminate_simulation, 0);
    Answer { is_unfinished: info.new_discrete_states_needed == 1, ..Answer::with_values(status, values) }
}

unsafe fn status(handle: *mut c_void, function: &str, kind: i32) -> Answer {
    let (mut integer, mut real, mut text) = (0, 0.0, null());
    // SAFETY: the caller's promise; room for each.
    let status = unsafe {
        match function {
            "fmi2GetStatus" => in_host(|| fmi2GetStatus(handle, kind, &mut integer)),
            "fmi2GetRealStatus" => in_host(|| fmi2GetRealStatus(handle, kind, &mut real)),
            "fmi2GetIntegerStatus" => in_host(|| fmi2GetIntegerStatus(handle, kind, &mut integer)),
            "fmi2GetBooleanStatus" => in_host(|| fmi2GetBooleanStatus(handle, kind, &mut integer)),
            "fmi2GetStringStatus" => in_host(|| fmi2GetStringStatus(handle, kind, &mut text)),
            _ => unreachable!("{function}"),
        }
    };
    if !text.is_null() {
        // SAFETY: a text of the library that lives until the next call.
        assert!(unsafe { CStr::from_ptr(text) }.is_empty());
    }
    Answer::with_values(status, vec![real, f64::from(integer)])
}
