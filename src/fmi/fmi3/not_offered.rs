//! FMI 3.0: functions of capabilities that the model description does not declare. They say so and return Error.
#![allow(non_snake_case, reason = "the names are the standard's")]

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
        pub unsafe extern "C" fn $function(instance: fmi3Instance $(, $argument: $type)*) -> fmi3Status {
            // SAFETY: the caller's promise.
            unsafe { enter(instance, &may::$rule, |_| Err(CallError::NotOffered($because))) }
        }
    )*};
}

not_offered! { "providesPerElementDependencies = false":
    GET_NUMBER_OF_VARIABLE_DEPENDENCIES fmi3GetNumberOfVariableDependencies(
        _reference: fmi3ValueReference, _count: *mut usize
    );
    GET_VARIABLE_DEPENDENCIES fmi3GetVariableDependencies(
        _dependent: fmi3ValueReference, _element_indices_of_dependent: *mut usize,
        _independents: *mut fmi3ValueReference, _element_indices_of_independents: *mut usize,
        _kinds: *mut fmi3DependencyKind, _count: usize
    );
}
not_offered! { "providesDirectionalDerivatives = false":
    GET_DIRECTIONAL_DERIVATIVE fmi3GetDirectionalDerivative(
        _unknowns: *const fmi3ValueReference, _unknown_count: usize,
        _knowns: *const fmi3ValueReference, _known_count: usize,
        _seed: *const fmi3Float64, _seed_count: usize,
        _sensitivity: *mut fmi3Float64, _sensitivity_count: usize
    );
}
not_offered! { "providesAdjointDerivatives = false":
    GET_ADJOINT_DERIVATIVE fmi3GetAdjointDerivative(
        _unknowns: *const fmi3ValueReference, _unknown_count: usize,
        _knowns: *const fmi3ValueReference, _known_count: usize,
        _seed: *const fmi3Float64, _seed_count: usize,
        _sensitivity: *mut fmi3Float64, _sensitivity_count: usize
    );
}
not_offered! { "the unit has no structural parameters":
    ENTER_CONFIGURATION_MODE fmi3EnterConfigurationMode();
    EXIT_CONFIGURATION_MODE fmi3ExitConfigurationMode();
}
not_offered! { "the unit has no clocks":
    GET_INTERVAL_DECIMAL fmi3GetIntervalDecimal(
        _references: *const fmi3ValueReference, _count: usize,
        _intervals: *mut fmi3Float64, _qualifiers: *mut fmi3IntervalQualifier
    );
    GET_INTERVAL_FRACTION fmi3GetIntervalFraction(
        _references: *const fmi3ValueReference, _count: usize,
        _counters: *mut u64, _resolutions: *mut u64, _qualifiers: *mut fmi3IntervalQualifier
    );
    GET_SHIFT_DECIMAL fmi3GetShiftDecimal(
        _references: *const fmi3ValueReference, _count: usize, _shifts: *mut fmi3Float64
    );
    GET_SHIFT_FRACTION fmi3GetShiftFraction(
        _references: *const fmi3ValueReference, _count: usize, _counters: *mut u64, _resolutions: *mut u64
    );
    SET_INTERVAL_DECIMAL fmi3SetIntervalDecimal(
        _references: *const fmi3ValueReference, _count: usize, _intervals: *const fmi3Float64
    );
    SET_INTERVAL_FRACTION fmi3SetIntervalFraction(
        _references: *const fmi3ValueReference, _count: usize, _counters: *const u64, _resolutions: *const u64
    );
    SET_SHIFT_DECIMAL fmi3SetShiftDecimal(
        _references: *const fmi3ValueReference, _count: usize, _shifts: *const fmi3Float64
    );
    SET_SHIFT_FRACTION fmi3SetShiftFraction(
        _references: *const fmi3ValueReference, _count: usize, _counters: *const u64, _resolutions: *const u64
    );
    ACTIVATE_MODEL_PARTITION fmi3ActivateModelPartition(_clock: fmi3ValueReference, _time: fmi3Float64);
}
not_offered! { "hasEventMode = false":
    ENTER_EVENT_MODE fmi3EnterEventMode();
    EVALUATE_DISCRETE_STATES fmi3EvaluateDiscreteStates();
    UPDATE_DISCRETE_STATES fmi3UpdateDiscreteStates(
        _discrete_states_need_update: *mut fmi3Boolean, _terminate_simulation: *mut fmi3Boolean,
        _nominals_changed: *mut fmi3Boolean, _values_changed: *mut fmi3Boolean,
        _next_event_time_defined: *mut fmi3Boolean, _next_event_time: *mut fmi3Float64
    );
    ENTER_STEP_MODE fmi3EnterStepMode();
}
not_offered! { "the unit is for co-simulation only":
    ENTER_CONTINUOUS_TIME_MODE fmi3EnterContinuousTimeMode();
    COMPLETED_INTEGRATOR_STEP fmi3CompletedIntegratorStep(
        _no_set_state_prior: fmi3Boolean, _enter_event_mode: *mut fmi3Boolean, _terminate: *mut fmi3Boolean
    );
    SET_TIME fmi3SetTime(_time: fmi3Float64);
    SET_CONTINUOUS_STATES fmi3SetContinuousStates(_states: *const fmi3Float64, _count: usize);
    GET_CONTINUOUS_STATE_DERIVATIVES fmi3GetContinuousStateDerivatives(
        _derivatives: *mut fmi3Float64, _count: usize
    );
    GET_EVENT_INDICATORS fmi3GetEventIndicators(_indicators: *mut fmi3Float64, _count: usize);
    GET_CONTINUOUS_STATES fmi3GetContinuousStates(_states: *mut fmi3Float64, _count: usize);
    GET_NOMINALS_OF_CONTINUOUS_STATES fmi3GetNominalsOfContinuousStates(
        _nominals: *mut fmi3Float64, _count: usize
    );
    GET_NUMBER_OF_EVENT_INDICATORS fmi3GetNumberOfEventIndicators(_count: *mut usize);
    GET_NUMBER_OF_CONTINUOUS_STATES fmi3GetNumberOfContinuousStates(_count: *mut usize);
}
not_offered! { "maxOutputDerivativeOrder = 0":
    GET_OUTPUT_DERIVATIVES fmi3GetOutputDerivatives(
        _references: *const fmi3ValueReference, _count: usize,
        _orders: *const i32, _values: *mut fmi3Float64, _value_count: usize
    );
}
