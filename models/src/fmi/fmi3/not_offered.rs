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
        pub unsafe extern "C-unwind" fn $function(instance: fmi3Instance $(, $argument: $type)*) -> fmi3Status {
            // SAFETY: the handle is live and used by one thread at a time; the other arguments are not touched, as
            // the standard demands of importers.
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
not_offered! { "the model has no structural parameters":
    ENTER_CONFIGURATION_MODE fmi3EnterConfigurationMode();
    EXIT_CONFIGURATION_MODE fmi3ExitConfigurationMode();
}
not_offered! { "ticks are at multiples of sample_time, whenever the experiment starts":
    SET_SHIFT_DECIMAL fmi3SetShiftDecimal(
        _references: *const fmi3ValueReference, _count: usize, _shifts: *const fmi3Float64
    );
    SET_SHIFT_FRACTION fmi3SetShiftFraction(
        _references: *const fmi3ValueReference, _count: usize, _counters: *const u64, _resolutions: *const u64
    );
}
