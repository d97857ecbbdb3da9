//! Calls of FMI 3.0 as a C importer makes them.

use core::ffi::{c_char, c_void};
use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi3::*;

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
                    fmi3SetDebugLogging(handle, (*on).into(), names.len(), pointer(&names, *is_null))
                }))
            }
            Call::EnterInitialization(Experiment { start, stop, tolerance }) => Answer::of(in_host(|| {
                fmi3EnterInitializationMode(
                    handle,
                    tolerance.is_some().into(),
                    tolerance.unwrap_or(f64::NAN),
                    *start,
                    stop.is_some().into(),
                    stop.unwrap_or(f64::NAN),
                )
            })),
            Call::Plain(function) => Answer::of(in_host(|| plain(function)(handle))),
            Call::Get { function, references, room, is_null } => {
                get(handle, function, references, *room, *is_null)
            }
            Call::Set { function, references, values, room, is_null } => {
                set(handle, function, references, values, *room, *is_null)
            }
            Call::UpdateDiscreteStates { is_null } => update(handle, *is_null),
            Call::CompletedStep { is_null } => {
                let (mut enter, mut end) = ([7_u8], [7_u8]);
                let status = in_host(|| {
                    fmi3CompletedIntegratorStep(
                        handle,
                        1,
                        pointer_mut(&mut enter, *is_null),
                        pointer_mut(&mut end, *is_null),
                    )
                });
                assert!(status != 0 || *is_null || (enter, end) == ([0], [0]));
                Answer::of(status)
            }
            Call::SetTime(time) => Answer::of(in_host(|| fmi3SetTime(handle, *time))),
            Call::SetStates { states, is_null } => Answer::of(in_host(|| {
                fmi3SetContinuousStates(handle, pointer(states, *is_null), states.len())
            })),
            Call::GetVector { function, length, is_null } => {
                let mut values = vec![0.0; *length];
                let status =
                    in_host(|| vector(function)(handle, pointer_mut(&mut values, *is_null), *length));
                Answer::with_values(status, values)
            }
            Call::Count(function) => {
                let mut count = 0;
                let status = match *function {
                    "fmi3GetNumberOfEventIndicators" => {
                        in_host(|| fmi3GetNumberOfEventIndicators(handle, &mut count))
                    }
                    _ => in_host(|| fmi3GetNumberOfContinuousStates(handle, &mut count)),
                };
                Answer::with_values(status, vec![count as f64])
            }
            Call::Step { point, size, is_final } => step(handle, *point, *size, *is_final),
            Call::Activate { clock, time } => {
                Answer::of(in_host(|| fmi3ActivateModelPartition(handle, *clock, *time)))
            }
            Call::GetClocks { references } => {
                let mut active = vec![7; references.len()];
                let status = in_host(|| {
                    fmi3GetClock(handle, references.as_ptr(), references.len(), active.as_mut_ptr())
                });
                Answer { active, ..Answer::of(status) }
            }
            Call::SetClocks { references, values } => Answer::of(in_host(|| {
                fmi3SetClock(handle, references.as_ptr(), references.len(), values.as_ptr())
            })),
            Call::Timing { function, references } => timing(handle, function, references),
            Call::Partial { function, unknowns, knowns, seed } => {
                let (is_adjoint, (m, n)) =
                    (*function == "fmi3GetAdjointDerivative", (unknowns.len(), knowns.len()));
                let call = if is_adjoint { fmi3GetAdjointDerivative } else { fmi3GetDirectionalDerivative };
                let mut values = vec![0.0; if is_adjoint { n } else { m }];
                let (u, k) = (unknowns.as_ptr(), knowns.as_ptr());
                let room = values.len();
                let status = in_host(|| {
                    call(handle, u, m, k, n, seed.as_ptr(), seed.len(), values.as_mut_ptr(), room)
                });
                Answer::with_values(status, values)
            }
            Call::GetSlopes { references, orders } => {
                let (n, mut values) = (references.len(), vec![0.0; references.len()]);
                let (r, o) = (references.as_ptr(), orders.as_ptr());
                let status = in_host(|| fmi3GetOutputDerivatives(handle, r, n, o, values.as_mut_ptr(), n));
                Answer::with_values(status, values)
            }
            Call::Dependencies(function) => Answer::of(match *function {
                "fmi3GetNumberOfVariableDependencies" => {
                    in_host(|| fmi3GetNumberOfVariableDependencies(handle, 1, &mut 0))
                }
                _ => in_host(|| fmi3GetVariableDependencies(handle, 1, &mut 0, &mut 0, &mut 0, &mut 0, 1)),
            }),
            _ => unreachable!("{call:?}"),
        }
    }
}

fn name(category: &Category) -> *const c_char {
    match category {
        Category::Declared(name) => name.as_ptr(),
        Category::Unknown => c"unknown % #".as_ptr(),
        Category::Null => null(),
    }
}

fn plain(function: &str) -> unsafe extern "C-unwind" fn(*mut c_void) -> i32 {
    match function {
        "fmi3ExitInitializationMode" => fmi3ExitInitializationMode,
        "fmi3Terminate" => fmi3Terminate,
        "fmi3Reset" => fmi3Reset,
        "fmi3EnterEventMode" => fmi3EnterEventMode,
        "fmi3EnterContinuousTimeMode" => fmi3EnterContinuousTimeMode,
        "fmi3EnterStepMode" => fmi3EnterStepMode,
        "fmi3EnterConfigurationMode" => fmi3EnterConfigurationMode,
        "fmi3ExitConfigurationMode" => fmi3ExitConfigurationMode,
        "fmi3EvaluateDiscreteStates" => fmi3EvaluateDiscreteStates,
        _ => unreachable!("{function}"),
    }
}

fn vector(function: &str) -> unsafe extern "C-unwind" fn(*mut c_void, *mut f64, usize) -> i32 {
    match function {
        "fmi3GetContinuousStateDerivatives" => fmi3GetContinuousStateDerivatives,
        "fmi3GetEventIndicators" => fmi3GetEventIndicators,
        "fmi3GetContinuousStates" => fmi3GetContinuousStates,
        "fmi3GetNominalsOfContinuousStates" => fmi3GetNominalsOfContinuousStates,
        _ => unreachable!("{function}"),
    }
}

/// The getters and setters of all types but Binary: function, type in C, a value of that type from a real one.
macro_rules! types {
    ($($get:ident $set:ident $type:ty, $from:expr;)*) => {
        unsafe fn get(
            handle: *mut c_void,
            function: &str,
            references: &[u32],
            room: usize,
            is_null: bool,
        ) -> Answer {
            let (r, n) = (pointer(references, is_null), references.len());
            // SAFETY: the caller's promise; where the numbers of references and values differ the call is refused.
            unsafe {
                match function {
                    $(stringify!($get) => {
                        let mut values = vec![$from(0.0); room];
                        let status = in_host(|| $get(handle, r, n, pointer_mut(&mut values, is_null), room));
                        Answer::with_values(status, values.iter().map(|value: &$type| real(*value)).collect())
                    })*
                    "fmi3GetBinary" => {
                        let (mut sizes, mut values) = (vec![0; room], vec![null(); room]);
                        let values = pointer_mut(&mut values, is_null);
                        Answer::of(in_host(|| fmi3GetBinary(handle, r, n, sizes.as_mut_ptr(), values, room)))
                    }
                    _ => unreachable!("{function}"),
                }
            }
        }

        unsafe fn set(
            handle: *mut c_void,
            function: &str,
            references: &[u32],
            values: &[f64],
            room: usize,
            is_null: bool,
        ) -> Answer {
            let (r, n) = (pointer(references, is_null), references.len());
            // SAFETY: as above.
            Answer::of(unsafe {
                match function {
                    $(stringify!($set) => {
                        let values: Vec<$type> = values.iter().map(|value| $from(*value)).collect();
                        in_host(|| $set(handle, r, n, pointer(&values, is_null), room))
                    })*
                    "fmi3SetBinary" => {
                        let (sizes, values) = (vec![1; values.len()], vec![&0_u8 as *const u8; values.len()]);
                        in_host(|| fmi3SetBinary(handle, r, n, sizes.as_ptr(), pointer(&values, is_null), room))
                    }
                    _ => unreachable!("{function}"),
                }
            })
        }
    };
}

types! {
    fmi3GetFloat32 fmi3SetFloat32 f32, |value: f64| value as f32;
    fmi3GetFloat64 fmi3SetFloat64 f64, |value: f64| value;
    fmi3GetInt8 fmi3SetInt8 i8, |value: f64| value as i8;
    fmi3GetUInt8 fmi3SetUInt8 u8, |value: f64| value as u8;
    fmi3GetInt16 fmi3SetInt16 i16, |value: f64| value as i16;
    fmi3GetUInt16 fmi3SetUInt16 u16, |value: f64| value as u16;
    fmi3GetInt32 fmi3SetInt32 i32, |value: f64| value as i32;
    fmi3GetUInt32 fmi3SetUInt32 u32, |value: f64| value as u32;
    fmi3GetInt64 fmi3SetInt64 i64, |value: f64| value as i64;
    fmi3GetUInt64 fmi3SetUInt64 u64, |value: f64| value as u64;
    fmi3GetBoolean fmi3SetBoolean u8, |value: f64| value as u8;
    fmi3GetString fmi3SetString *const c_char, |_: f64| c"text".as_ptr();
}

/// A result as a real number.
fn real<T: Copy + 'static>(value: T) -> f64 {
    let value: &dyn core::any::Any = &value;
    let as_real = value.downcast_ref::<f64>().copied();
    let as_real = as_real.or_else(|| value.downcast_ref::<i32>().map(|value| f64::from(*value)));
    let as_real = as_real.or_else(|| value.downcast_ref::<i64>().map(|value| *value as f64));
    as_real.or_else(|| value.downcast_ref::<u8>().map(|value| f64::from(*value))).unwrap_or_default()
}

unsafe fn step(handle: *mut c_void, point: f64, size: f64, is_final: bool) -> Answer {
    let (mut event, mut end, mut early, mut reached) = (7, 7, 7, f64::NAN);
    let is_final = is_final.into();
    // SAFETY: the caller's promise; room for the results.
    let status = unsafe {
        in_host(|| fmi3DoStep(handle, point, size, is_final, &mut event, &mut end, &mut early, &mut reached))
    };
    assert!(status != 0 || end == 0);
    Answer { reached, is_event: event == 1, is_early: early == 1, ..Answer::of(status) }
}

unsafe fn update(handle: *mut c_void, is_null: bool) -> Answer {
    let (mut flags, mut next) = ([7; 5], f64::NAN);
    // SAFETY: the caller's promise; null is allowed.
    let status = unsafe {
        if is_null {
            let none = null_mut();
            in_host(|| fmi3UpdateDiscreteStates(handle, none, none, none, none, none, null_mut()))
        } else {
            let [need, end, nominals, states, defined] = &mut flags;
            in_host(|| fmi3UpdateDiscreteStates(handle, need, end, nominals, states, defined, &mut next))
        }
    };
    assert!(status != 0 || is_null || (flags[1], flags[2]) == (0, 0), "{flags:?}");
    let values = if flags[4] == 1 { vec![next] } else { Vec::new() };
    Answer { is_unfinished: flags[0] == 1, ..Answer::with_values(status, values) }
}

unsafe fn timing(handle: *mut c_void, function: &str, references: &[u32]) -> Answer {
    let (r, n) = (references.as_ptr(), references.len());
    let (mut decimals, mut qualifiers) = (vec![1e-3; n], vec![7; n]);
    let (mut counters, mut resolutions) = (vec![1; n], vec![1000; n]);
    let (d, q) = (decimals.as_mut_ptr(), qualifiers.as_mut_ptr());
    let (c, s) = (counters.as_mut_ptr(), resolutions.as_mut_ptr());
    // SAFETY: the caller's promise.
    let status = unsafe {
        match function {
            "fmi3GetIntervalDecimal" => in_host(|| fmi3GetIntervalDecimal(handle, r, n, d, q)),
            "fmi3GetIntervalFraction" => in_host(|| fmi3GetIntervalFraction(handle, r, n, c, s, q)),
            "fmi3GetShiftDecimal" => in_host(|| fmi3GetShiftDecimal(handle, r, n, d)),
            "fmi3GetShiftFraction" => in_host(|| fmi3GetShiftFraction(handle, r, n, c, s)),
            "fmi3SetIntervalDecimal" => in_host(|| fmi3SetIntervalDecimal(handle, r, n, d)),
            "fmi3SetIntervalFraction" => in_host(|| fmi3SetIntervalFraction(handle, r, n, c, s)),
            "fmi3SetShiftDecimal" => in_host(|| fmi3SetShiftDecimal(handle, r, n, d)),
            "fmi3SetShiftFraction" => in_host(|| fmi3SetShiftFraction(handle, r, n, c, s)),
            _ => unreachable!("{function}"),
        }
    };
    if function.ends_with("Fraction") {
        decimals =
            counters.iter().zip(&resolutions).map(|(c, s): (&u64, &u64)| *c as f64 / *s as f64).collect();
    }
    Answer::with_values(status, decimals)
}
