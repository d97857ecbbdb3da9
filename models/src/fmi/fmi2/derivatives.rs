//! FMI 2.0: derivatives between variables and with respect to time.
#![allow(non_snake_case, reason = "the names are the standard's")]

use core::ffi::c_int;

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output};

/// How the unknowns move when the knowns move along `seed`, in closed form.
///
/// # Safety
/// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetDirectionalDerivative(
    component: fmi2Component,
    unknowns: *const fmi2ValueReference,
    unknown_count: usize,
    knowns: *const fmi2ValueReference,
    known_count: usize,
    seed: *const fmi2Real,
    sensitivity: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as the
    // standard demands of importers.
    unsafe {
        enter(component, &may::GET_DIRECTIONAL_DERIVATIVE, |instance| {
            instance.directional_derivative(
                input(unknowns, unknown_count, "vUnknown_ref")?,
                input(knowns, known_count, "vKnown_ref")?,
                input(seed, known_count, "dvKnown")?,
                output(sensitivity, unknown_count, "dvUnknown")?,
            )
        })
    }
}

/// Lets inputs move with a slope during steps, until another slope is set.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2SetRealInputDerivatives(
    component: fmi2Component,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const c_int,
    values: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(component, &may::SET_REAL_INPUT_DERIVATIVES, |instance| {
            instance.set_input_derivatives(
                input(references, count, "vr")?,
                input(orders, count, "order")?,
                input(values, count, "value")?,
            )
        })
    }
}

/// Slopes of outputs at the end of the last step.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi2GetRealOutputDerivatives(
    component: fmi2Component,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const c_int,
    values: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(component, &may::GET_REAL_OUTPUT_DERIVATIVES, |instance| {
            instance.output_derivatives(
                input(references, count, "vr")?,
                input(orders, count, "order")?,
                output(values, count, "value")?,
            )
        })
    }
}
