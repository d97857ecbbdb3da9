//! Categories of log messages, as model descriptions declare them.

use core::ffi::CStr;
use core::fmt;

/// Declared log categories: name in the model description and description.
pub const LOG_CATEGORIES: [(&CStr, &str); 4] = [
    (c"logStatusError", "A call was refused; always reported"),
    (c"logStatusFatal", "The instance is lost; always reported"),
    (c"logEvents", "Life cycle of the instance: instantiated, initialised, terminated, reset"),
    (c"logObserver", "The observer lost or regained convergence"),
];
pub(super) const ERROR: usize = 0;
pub(super) const FATAL: usize = 1;
pub(super) const EVENTS: usize = 2;
pub(super) const OBSERVER: usize = 3;

/// Beginning of a name that no category has, for an error message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CategoryName {
    /// `None` of a null pointer.
    length: Option<usize>,
    text: [u8; 40],
}

impl CategoryName {
    pub(super) fn new(name: Option<&CStr>) -> Self {
        let mut text = [0; 40];
        let length = name.map(|name| {
            let bytes = name.to_bytes();
            let length = bytes.len().min(text.len());
            text[..length].copy_from_slice(&bytes[..length]);
            length
        });
        Self { length, text }
    }
}

impl fmt::Display for CategoryName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(length) = self.length else {
            return formatter.write_str("of a null pointer");
        };
        let chunks = self.text[..length].utf8_chunks();
        formatter.write_str("\"")?;
        chunks.map(|chunk| chunk.valid()).try_for_each(|valid| formatter.write_str(valid))?;
        formatter.write_str("\"")
    }
}

/// Names of all categories for an error message.
pub(super) struct CategoryList;

impl fmt::Display for CategoryList {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        LOG_CATEGORIES.iter().enumerate().try_for_each(|(index, (name, _))| {
            let separator = if index == 0 { "" } else { ", " };
            write!(formatter, "{separator}{}", name.to_str().unwrap_or_default())
        })
    }
}
