//! FMI 3.0: getting and setting variables.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::CallError;
use crate::fmi::FmiVersion;
use crate::fmi::access::DataType;
use crate::fmi::boundary::{enter, enter_to_copy, input, output};
use crate::model::variable::Kind;

/// All variables are scalars: one value per reference.
#[inline]
fn require_length(got: usize, expected: usize) -> Result<(), CallError> {
    if got == expected { Ok(()) } else { Err(CallError::WrongLength { argument: "nValues", got, expected }) }
}

const fn data_type(name: &'static str, carries: fn(&Kind) -> bool) -> DataType {
    DataType { name, carries, standard: FmiVersion::Three }
}

const fn absent(name: &'static str) -> DataType {
    data_type(name, |_| false)
}

/// A getter and a setter of one data type; how both convert, if any variable has it. Values of some types have sizes.
macro_rules! accessors {
    ($enter:ident, $data_type:expr, $type:ty $(, $sizes:ty)?;
     $get:ident $get_rule:ident $get_values:ident($($from:expr)?),
     $set:ident $set_rule:ident $set_values:ident($($into:expr)?)) => {
        /// # Safety
        /// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $get(
            instance: fmi3Instance,
            references: *const fmi3ValueReference,
            count: usize,
            $(_sizes: *mut $sizes,)?
            values: *mut $type,
            value_count: usize,
        ) -> fmi3Status {
            // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as
            // the standard demands of importers.
            unsafe {
                $enter(instance, &may::$get_rule, |instance| {
                    require_length(value_count, count)?;
                    let references = input(references, count, "valueReferences")?;
                    let values = output(values, count, "values")?;
                    instance.$get_values(&const { $data_type }, references, values $(, $from)?)
                })
            }
        }

        /// # Safety
        /// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $set(
            instance: fmi3Instance,
            references: *const fmi3ValueReference,
            count: usize,
            $(_sizes: *const $sizes,)?
            values: *const $type,
            value_count: usize,
        ) -> fmi3Status {
            // SAFETY: the handle is live and used by one thread at a time; arrays are as long as their counts say, as
            // the standard demands of importers.
            unsafe {
                $enter(instance, &may::$set_rule, |instance| {
                    require_length(value_count, count)?;
                    let references = input(references, count, "valueReferences")?;
                    let values = input(values, count, "values")?;
                    instance.$set_values(&const { $data_type }, references, values $(, $into)?)
                })
            }
        }
    };
}

accessors!(enter_to_copy, data_type("a Float64", |kind| matches!(kind, Kind::Real(_))), f64;
    fmi3GetFloat64 GET_FLOAT64 get(|value| value), fmi3SetFloat64 SET_FLOAT64 set(|value| value));
accessors!(enter, data_type("an Int32", |kind| matches!(kind, Kind::Integer)), i32;
    fmi3GetInt32 GET_INT32 get(|value| value as i32), fmi3SetInt32 SET_INT32 set(f64::from));
// A number beyond 2^53 loses digits, but is no item of any enumeration either.
accessors!(enter, data_type("an Int64 or Enumeration", |kind| matches!(kind, Kind::Enumeration(_))), i64;
    fmi3GetInt64 GET_INT64 get(|value| value as i64), fmi3SetInt64 SET_INT64 set(|value| value as f64));
accessors!(enter, data_type("a Boolean", |kind| matches!(kind, Kind::Boolean)), fmi3Boolean;
    fmi3GetBoolean GET_BOOLEAN get(|value| fmi3Boolean::from(value != 0.0)),
    fmi3SetBoolean SET_BOOLEAN set(|value| f64::from(u8::from(value != FMI3_FALSE))));
accessors!(enter, absent("a Float32"), f32;
    fmi3GetFloat32 GET_FLOAT32 get_absent(), fmi3SetFloat32 SET_FLOAT32 set_absent());
accessors!(enter, absent("an Int8"), i8;
    fmi3GetInt8 GET_INT8 get_absent(), fmi3SetInt8 SET_INT8 set_absent());
accessors!(enter, absent("a UInt8"), u8;
    fmi3GetUInt8 GET_UINT8 get_absent(), fmi3SetUInt8 SET_UINT8 set_absent());
accessors!(enter, absent("an Int16"), i16;
    fmi3GetInt16 GET_INT16 get_absent(), fmi3SetInt16 SET_INT16 set_absent());
accessors!(enter, absent("a UInt16"), u16;
    fmi3GetUInt16 GET_UINT16 get_absent(), fmi3SetUInt16 SET_UINT16 set_absent());
accessors!(enter, absent("a UInt32"), u32;
    fmi3GetUInt32 GET_UINT32 get_absent(), fmi3SetUInt32 SET_UINT32 set_absent());
accessors!(enter, absent("a UInt64"), u64;
    fmi3GetUInt64 GET_UINT64 get_absent(), fmi3SetUInt64 SET_UINT64 set_absent());
accessors!(enter, absent("a String"), fmi3String;
    fmi3GetString GET_STRING get_absent(), fmi3SetString SET_STRING set_absent());
accessors!(enter, absent("a Binary"), fmi3Binary, usize;
    fmi3GetBinary GET_BINARY get_absent(), fmi3SetBinary SET_BINARY set_absent());
