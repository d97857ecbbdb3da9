//! FMI 3.0: derivatives between variables and with respect to time.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::CallError;
use crate::fmi::boundary::{enter, input, output};

/// All variables are scalars: one number per reference.
fn require_length(argument: &'static str, got: usize, expected: usize) -> Result<(), CallError> {
    if got == expected { Ok(()) } else { Err(CallError::WrongLength { argument, got, expected }) }
}

/// How the unknowns move when the knowns move along `seed`, in closed form.
///
/// # Safety
/// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetDirectionalDerivative(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    unknown_count: usize,
    knowns: *const fmi3ValueReference,
    known_count: usize,
    seed: *const fmi3Float64,
    seed_count: usize,
    sensitivity: *mut fmi3Float64,
    sensitivity_count: usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as the
    // standard demands of importers.
    unsafe {
        enter(instance, &may::GET_DIRECTIONAL_DERIVATIVE, |instance| {
            require_length("nSeed", seed_count, known_count)?;
            require_length("nSensitivity", sensitivity_count, unknown_count)?;
            instance.directional_derivative(
                input(unknowns, unknown_count, "unknowns")?,
                input(knowns, known_count, "knowns")?,
                input(seed, known_count, "seed")?,
                output(sensitivity, unknown_count, "sensitivity")?,
            )
        })
    }
}

/// How the unknowns, weighted with `seed`, move with each known, in closed form.
///
/// # Safety
/// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetAdjointDerivative(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    unknown_count: usize,
    knowns: *const fmi3ValueReference,
    known_count: usize,
    seed: *const fmi3Float64,
    seed_count: usize,
    sensitivity: *mut fmi3Float64,
    sensitivity_count: usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as the
    // standard demands of importers.
    unsafe {
        enter(instance, &may::GET_ADJOINT_DERIVATIVE, |instance| {
            require_length("nSeed", seed_count, unknown_count)?;
            require_length("nSensitivity", sensitivity_count, known_count)?;
            instance.adjoint_derivative(
                input(unknowns, unknown_count, "unknowns")?,
                input(knowns, known_count, "knowns")?,
                input(seed, unknown_count, "seed")?,
                output(sensitivity, known_count, "sensitivity")?,
            )
        })
    }
}

/// Slopes of outputs at the end of the last step.
///
/// # Safety
/// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetOutputDerivatives(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    orders: *const i32,
    values: *mut fmi3Float64,
    value_count: usize,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as the
    // standard demands of importers.
    unsafe {
        enter(instance, &may::GET_OUTPUT_DERIVATIVES, |instance| {
            require_length("nValues", value_count, count)?;
            instance.output_derivatives(
                input(references, count, "valueReferences")?,
                input(orders, count, "orders")?,
                output(values, count, "values")?,
            )
        })
    }
}
