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

/// A getter and a setter of one data type.
macro_rules! accessors {
    ($enter:ident, $name:literal, $carries:expr, $get:ident $get_rule:ident, $set:ident $set_rule:ident, $type:ty,
     $from:expr, $into:expr) => {
        /// # Safety
        /// A live handle, used by one thread at a time; the arrays hold as many elements as the counts say.
        #[unsafe(no_mangle)]
        pub unsafe extern "C-unwind" fn $get(
            instance: fmi3Instance,
            references: *const fmi3ValueReference,
            count: usize,
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
                    instance.get(
                        &DataType { name: $name, carries: $carries, standard: FmiVersion::Three },
                        references,
                        values,
                        $from,
                    )
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
                    instance.set(
                        &DataType { name: $name, carries: $carries, standard: FmiVersion::Three },
                        references,
                        values,
                        $into,
                    )
                })
            }
        }
    };
}

/// A getter and a setter of a data type that no variable has: nothing is ever converted.
macro_rules! absent {
    ($name:literal, $get:ident $get_rule:ident, $set:ident $set_rule:ident, $type:ty $(, $sizes:ty)?) => {
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
                enter(instance, &may::$get_rule, |instance| {
                    require_length(value_count, count)?;
                    let references = input(references, count, "valueReferences")?;
                    output(values, count, "values")?;
                    instance.get_absent(&absent($name), references)
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
                enter(instance, &may::$set_rule, |instance| {
                    require_length(value_count, count)?;
                    let references = input(references, count, "valueReferences")?;
                    input(values, count, "values")?;
                    instance.set_absent(&absent($name), references)
                })
            }
        }
    };
}

fn absent(name: &'static str) -> DataType {
    DataType { name, carries: |_| false, standard: FmiVersion::Three }
}

accessors!(enter_to_copy, "a Float64", |kind| matches!(kind, Kind::Real(_)),
    fmi3GetFloat64 GET_FLOAT64, fmi3SetFloat64 SET_FLOAT64, f64, |value| value, |value| value);
accessors!(enter, "an Int32", |kind| matches!(kind, Kind::Integer),
    fmi3GetInt32 GET_INT32, fmi3SetInt32 SET_INT32, i32, |value| value as i32, f64::from);
// A number beyond 2^53 loses digits, but is no item of any enumeration either.
accessors!(enter, "an Int64 or Enumeration", |kind| matches!(kind, Kind::Enumeration(_)),
    fmi3GetInt64 GET_INT64, fmi3SetInt64 SET_INT64, i64, |value| value as i64, |value| value as f64);
accessors!(enter, "a Boolean", |kind| matches!(kind, Kind::Boolean),
    fmi3GetBoolean GET_BOOLEAN, fmi3SetBoolean SET_BOOLEAN, fmi3Boolean,
    |value| fmi3Boolean::from(value != 0.0), |value| f64::from(u8::from(value != FMI3_FALSE)));
absent!("a Float32", fmi3GetFloat32 GET_FLOAT32, fmi3SetFloat32 SET_FLOAT32, f32);
absent!("an Int8", fmi3GetInt8 GET_INT8, fmi3SetInt8 SET_INT8, i8);
absent!("a UInt8", fmi3GetUInt8 GET_UINT8, fmi3SetUInt8 SET_UINT8, u8);
absent!("an Int16", fmi3GetInt16 GET_INT16, fmi3SetInt16 SET_INT16, i16);
absent!("a UInt16", fmi3GetUInt16 GET_UINT16, fmi3SetUInt16 SET_UINT16, u16);
absent!("a UInt32", fmi3GetUInt32 GET_UINT32, fmi3SetUInt32 SET_UINT32, u32);
absent!("a UInt64", fmi3GetUInt64 GET_UINT64, fmi3SetUInt64 SET_UINT64, u64);
absent!("a String", fmi3GetString GET_STRING, fmi3SetString SET_STRING, fmi3String);
absent!("a Binary", fmi3GetBinary GET_BINARY, fmi3SetBinary SET_BINARY, fmi3Binary, usize);
