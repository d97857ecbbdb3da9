//! FMI 2.0: functions of capabilities that the model description does not declare. They say so and return Error.
#![allow(non_snake_case, reason = "the names are the standard's")]

use core::ffi::c_int;

use super::legality as may;
use super::types::*;
use crate::fmi::CallError;
use crate::fmi::boundary::enter;

macro_rules! not_offered {
    ($because:literal: $($rule:ident $function:ident($($argument:ident: $type:ty),*);)*) => {$(
        /// Not offered: returns Error and logs why.
        ///
        /// # Safety
        /// A live handle, used by one thread at a time; the other arguments are not touched.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $function(component: fmi2Component $(, $argument: $type)*) -> fmi2Status {
            // SAFETY: the caller's promise.
            unsafe { enter(component, &may::$rule, |_| Err(CallError::NotOffered($because))) }
        }
    )*};
}

not_offered! { "providesDirectionalDerivative = false":
    GET_DIRECTIONAL_DERIVATIVE fmi2GetDirectionalDerivative(
        _unknowns: *const fmi2ValueReference, _unknown_count: usize,
        _knowns: *const fmi2ValueReference, _known_count: usize,
        _seed: *const fmi2Real, _sensitivity: *mut fmi2Real
    );
}
not_offered! { "canInterpolateInputs = false":
    SET_REAL_INPUT_DERIVATIVES fmi2SetRealInputDerivatives(
        _references: *const fmi2ValueReference, _count: usize, _orders: *const c_int, _values: *const fmi2Real
    );
}
not_offered! { "maxOutputDerivativeOrder = 0":
    GET_REAL_OUTPUT_DERIVATIVES fmi2GetRealOutputDerivatives(
        _references: *const fmi2ValueReference, _count: usize, _orders: *const c_int, _values: *mut fmi2Real
    );
}
not_offered! { "the unit is for co-simulation only":
    ENTER_EVENT_MODE fmi2EnterEventMode();
    NEW_DISCRETE_STATES fmi2NewDiscreteStates(_event_info: *mut fmi2EventInfo);
    ENTER_CONTINUOUS_TIME_MODE fmi2EnterContinuousTimeMode();
    COMPLETED_INTEGRATOR_STEP fmi2CompletedIntegratorStep(
        _no_set_state_prior: fmi2Boolean, _enter_event_mode: *mut fmi2Boolean, _terminate: *mut fmi2Boolean
    );
    SET_TIME fmi2SetTime(_time: fmi2Real);
    SET_CONTINUOUS_STATES fmi2SetContinuousStates(_states: *const fmi2Real, _count: usize);
    GET_DERIVATIVES fmi2GetDerivatives(_derivatives: *mut fmi2Real, _count: usize);
    GET_EVENT_INDICATORS fmi2GetEventIndicators(_indicators: *mut fmi2Real, _count: usize);
    GET_CONTINUOUS_STATES fmi2GetContinuousStates(_states: *mut fmi2Real, _count: usize);
    GET_NOMINALS_OF_CONTINUOUS_STATES fmi2GetNominalsOfContinuousStates(
        _nominals: *mut fmi2Real, _count: usize
    );
}
