//! FMI 2.0: getting and setting variables.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::FmiVersion;
use crate::fmi::access::DataType;
use crate::fmi::boundary::{enter, enter_to_copy, input, output};
use crate::model::variable::Kind;

const REAL: DataType =
    DataType { name: "a Real", carries: |kind| matches!(kind, Kind::Real(_)), standard: FmiVersion::Two };
const INTEGER: DataType = DataType {
    name: "an Integer or Enumeration",
    carries: |kind| matches!(kind, Kind::Integer | Kind::Enumeration(_)),
    standard: FmiVersion::Two,
};
const BOOLEAN: DataType =
    DataType { name: "a Boolean", carries: |kind| matches!(kind, Kind::Boolean), standard: FmiVersion::Two };
const STRING: DataType = DataType { name: "a String", carries: |_| false, standard: FmiVersion::Two };

/// A getter and a setter of one data type; how both convert, if any variable has it.
macro_rules! accessors {
    ($enter:ident, $data_type:ident: $type:ty,
     $get:ident $get_rule:ident $get_values:ident($($from:expr)?),
     $set:ident $set_rule:ident $set_values:ident($($into:expr)?)) => {
        /// # Safety
        /// A live handle, used by one thread at a time; both arrays hold `count` elements.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $get(
            component: fmi2Component,
            references: *const fmi2ValueReference,
            count: usize,
            values: *mut $type,
        ) -> fmi2Status {
            // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the
            // standard demands of importers.
            unsafe {
                $enter(component, &may::$get_rule, |instance| {
                    let references = input(references, count, "vr")?;
                    instance.$get_values(&$data_type, references, output(values, count, "value")? $(, $from)?)
                })
            }
        }

        /// # Safety
        /// A live handle, used by one thread at a time; both arrays hold `count` elements.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $set(
            component: fmi2Component,
            references: *const fmi2ValueReference,
            count: usize,
            values: *const $type,
        ) -> fmi2Status {
            // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the
            // standard demands of importers.
            unsafe {
                $enter(component, &may::$set_rule, |instance| {
                    let references = input(references, count, "vr")?;
                    instance.$set_values(&$data_type, references, input(values, count, "value")? $(, $into)?)
                })
            }
        }
    };
}

accessors!(enter_to_copy, REAL: fmi2Real,
    fmi2GetReal GET_REAL get(|value| value), fmi2SetReal SET_REAL set(|value| value));
accessors!(enter, INTEGER: fmi2Integer,
    fmi2GetInteger GET_INTEGER get(|value| value as fmi2Integer), fmi2SetInteger SET_INTEGER set(f64::from));
accessors!(enter, BOOLEAN: fmi2Boolean,
    fmi2GetBoolean GET_BOOLEAN get(|value| fmi2Boolean::from(value != 0.0)),
    fmi2SetBoolean SET_BOOLEAN set(|value| f64::from(u8::from(value != FMI2_FALSE))));
accessors!(enter, STRING: fmi2String,
    fmi2GetString GET_STRING get_absent(), fmi2SetString SET_STRING set_absent());
