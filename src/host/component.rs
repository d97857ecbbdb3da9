//! What an instance of either version can be asked to do, and what may come back.

use std::ffi::{CStr, c_void};

use super::variable::Storage;

/// Why an FMU did not do what it was asked to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refusal {
    /// The function returned something worse than a warning.
    Status { function: &'static str, status: i32 },
    /// The library lacks the function.
    Missing { function: &'static str },
    /// The value has no exact counterpart in the storage type.
    NotExact { value: f64, target: Storage },
    /// The variable cannot be accessed as a number, or as a text.
    WrongStorage,
    /// The model wants the simulation to end.
    Termination,
}

pub(super) type Answer<T = ()> = std::result::Result<T, Refusal>;

/// Accepts `OK` (0) and `Warning` (1), the same numbers in both versions.
#[inline]
pub(super) fn accept(function: &'static str, status: i32) -> Answer {
    if status == 0 || status == 1 { Ok(()) } else { Err(Refusal::Status { function, status }) }
}

/// The version-independent face of `fmi2Component` and `fmi3Instance`.
///
/// Implementors are `Send`: both standards allow calls from any thread, one at a time per instance.
pub(super) trait Component: Send {
    /// Both times in seconds.
    fn enter_initialisation(&mut self, start_time: f64, stop_time: Option<f64>) -> Answer;
    fn exit_initialisation(&mut self) -> Answer;
    /// Time and step size in seconds. Unless it `may_go_back`, the model need not keep what lies before `time`.
    fn step(&mut self, time: f64, step_size: f64, may_go_back: bool) -> Answer;
    fn terminate(&mut self) -> Answer;
    fn reset(&mut self) -> Answer;
    /// Frees the instance; nothing may be called afterwards.
    fn free(&mut self);

    /// The slices have the same length.
    fn get_reals(&self, references: &[u32], values: &mut [f64]) -> Answer;
    /// The slices have the same length.
    fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Answer;
    /// Any numeric or boolean variable.
    fn get_number(&self, storage: Storage, reference: u32) -> Answer<f64>;
    /// Any numeric or boolean variable.
    fn set_number(&mut self, storage: Storage, reference: u32, value: f64) -> Answer;
    fn get_text(&self, reference: u32) -> Answer<String>;
    fn set_text(&mut self, reference: u32, text: &CStr) -> Answer;

    fn get_state(&mut self) -> Answer<*mut c_void>;
    /// `state` came from `get_state` of this component and was not freed.
    fn set_state(&mut self, state: *mut c_void) -> Answer;
    /// `state` came from `get_state` of this component and was not freed.
    fn free_state(&mut self, state: *mut c_void) -> Answer;
    /// `state` came from this component and was not freed.
    fn serialise_state(&mut self, state: *mut c_void) -> Answer<Vec<u8>>;
    /// The result is a state as from `get_state`.
    fn deserialise_state(&mut self, bytes: &[u8]) -> Answer<*mut c_void>;
}

/// Conversion between `f64` and a C number, refused where it would not be exact.
pub(super) trait Number: Copy + Default {
    fn exactly_from(value: f64) -> Option<Self>;
    /// The closest `f64`.
    fn nearest(self) -> f64;
    fn exactly_to(self) -> Option<f64>;
}

macro_rules! whole_numbers {
    ($($type:ty),*) => {$(
        impl Number for $type {
            fn exactly_from(value: f64) -> Option<Self> {
                // `as` saturates: what does not survive the way there and back was out of range or not whole.
                // The comparison as i128 catches 2^63 and 2^64, whose saturated values round back to them.
                let converted = value as $type;
                (converted as f64 == value && converted as i128 == value as i128).then_some(converted)
            }

            fn nearest(self) -> f64 {
                self as f64
            }

            fn exactly_to(self) -> Option<f64> {
                let converted = self as f64;
                (converted as i128 == self as i128).then_some(converted)
            }
        }
    )*};
}
whole_numbers!(i8, u8, i16, u16, i32, u32, i64, u64);

impl Number for f64 {
    fn exactly_from(value: f64) -> Option<Self> {
        Some(value)
    }

    fn nearest(self) -> f64 {
        self
    }

    fn exactly_to(self) -> Option<f64> {
        Some(self)
    }
}

impl Number for f32 {
    /// Rounds: nobody expects 0.1 to be refused.
    fn exactly_from(value: f64) -> Option<Self> {
        Some(value as f32)
    }

    fn nearest(self) -> f64 {
        f64::from(self)
    }

    fn exactly_to(self) -> Option<f64> {
        Some(f64::from(self))
    }
}

/// A C boolean: 0 and 1 and nothing else.
pub(super) fn boolean_from(value: f64) -> Answer<bool> {
    if value == 0.0 || value == 1.0 {
        Ok(value == 1.0)
    } else {
        Err(Refusal::NotExact { value, target: Storage::Boolean })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_exact_numbers_pass() {
        assert_eq!(i32::exactly_from(-7.0), Some(-7));
        assert_eq!(i32::exactly_from(0.5), None);
        assert_eq!(u8::exactly_from(256.0), None);
        assert_eq!(u8::exactly_from(-1.0), None);
        assert_eq!(i64::exactly_from(f64::NAN), None);
        assert_eq!(i64::exactly_from(-(2f64.powi(63))), Some(i64::MIN));
        assert_eq!(i64::exactly_from(2f64.powi(63)), None);
        assert_eq!(u64::exactly_from(2f64.powi(64)), None);
        assert_eq!(i64::MAX.exactly_to(), None);
        assert_eq!((1_i64 << 53).exactly_to(), Some(2f64.powi(53)));
    }
}
