//! Log categories that the units declare.

use core::ffi::CStr;

/// Declared log categories: name and description.
pub const LOG_CATEGORIES: [(&CStr, &str); 5] = [
    (c"logStatusError", "A call was refused; always reported"),
    (c"logStatusFatal", "The instance is lost; always reported"),
    (c"logStatusWarning", "Something looks wrong, but the call went through"),
    (c"logEvents", "Life cycle of the instance: instantiated, initialised, terminated, reset"),
    (c"logObserver", "The observer lost or regained convergence"),
];
