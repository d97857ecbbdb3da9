//! How variables and their values are named in calls to an instance.

use super::variable::{Kind, Storage};

/// A resolved variable: what the C interface needs to access it. Valid for every instance of the same FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handle {
    pub(super) value_reference: u32,
    pub(super) kind: Kind,
    pub(super) storage: Storage,
}

impl Handle {
    /// The number for [`super::Instance::get_reals`] and [`super::Instance::set_reals`].
    pub fn value_reference(self) -> u32 {
        self.value_reference
    }

    pub fn kind(self) -> Kind {
        self.kind
    }

    pub fn storage(self) -> Storage {
        self.storage
    }

    /// Whether the batch functions for reals take this variable.
    pub fn is_float64(self) -> bool {
        self.storage == Storage::Float64
    }
}

/// A value for [`super::Instance::set_by_name`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// For any numeric variable that can hold it exactly.
    Real(f64),
    /// For any numeric variable that can hold it exactly.
    Integer(i32),
    /// For boolean variables.
    Boolean(bool),
    /// The name of an item of an enumeration, or the value of a string variable.
    Text(&'a str),
}

impl From<f64> for Value<'_> {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<i32> for Value<'_> {
    fn from(value: i32) -> Self {
        Self::Integer(value)
    }
}

impl From<bool> for Value<'_> {
    fn from(value: bool) -> Self {
        Self::Boolean(value)
    }
}

impl<'a> From<&'a str> for Value<'a> {
    fn from(value: &'a str) -> Self {
        Self::Text(value)
    }
}
