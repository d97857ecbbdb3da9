//! FMI 2.0: functions of capabilities that the model description does not declare. They say so and return Error.
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
        pub unsafe extern "C" fn $function(component: fmi2Component $(, $argument: $type)*) -> fmi2Status {
            // SAFETY: the caller's promise.
            unsafe { enter(component, &may::$rule, |_| Err(CallError::NotOffered($because))) }
        }
    )*};
}

not_offered! { "canGetAndSetFMUstate = false":
    GET_FMU_STATE fmi2GetFMUstate(_state: *mut fmi2FMUstate);
    SET_FMU_STATE fmi2SetFMUstate(_state: fmi2FMUstate);
    FREE_FMU_STATE fmi2FreeFMUstate(_state: *mut fmi2FMUstate);
}
not_offered! { "canSerializeFMUstate = false":
    SERIALIZED_FMU_STATE_SIZE fmi2SerializedFMUstateSize(_state: fmi2FMUstate, _size: *mut usize);
    SERIALIZE_FMU_STATE fmi2SerializeFMUstate(_state: fmi2FMUstate, _bytes: *mut fmi2Byte, _size: usize);
    DESERIALIZE_FMU_STATE fmi2DeSerializeFMUstate(
        _bytes: *const fmi2Byte, _size: usize, _state: *mut fmi2FMUstate
    );
}
