//! Messages to the importer, through its callback only, formatted without the heap.

use core::ffi::{CStr, c_char};
use core::fmt::{self, Write};
use std::ffi::CString;

use super::fmi2::types::{fmi2CallbackLogger, fmi2ComponentEnvironment};
use super::fmi3::types::{fmi3InstanceEnvironment, fmi3LogMessageCallback};
use super::{CallError, Status};
use crate::unit::{Journal, Topic};

/// Declared log categories: name in the model description and description.
pub const LOG_CATEGORIES: [(&CStr, &str); 4] = [
    (c"logStatusError", "A call was refused; always reported"),
    (c"logStatusFatal", "The instance is lost; always reported"),
    (c"logEvents", "Life cycle of the instance: instantiated, initialised, terminated, reset"),
    (c"logObserver", "The observer lost or regained convergence"),
];
const ERROR: usize = 0;
const FATAL: usize = 1;
const EVENTS: usize = 2;
const OBSERVER: usize = 3;

/// Beginning of a name that no category has, for an error message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CategoryName {
    /// `None` of a null pointer.
    length: Option<usize>,
    text: [u8; 40],
}

impl CategoryName {
    fn new(name: Option<&CStr>) -> Self {
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

/// The importer's callback, if it gave one.
#[derive(Clone, Copy)]
pub enum Callback {
    None,
    Fmi2(fmi2CallbackLogger, fmi2ComponentEnvironment),
    Fmi3(fmi3LogMessageCallback, fmi3InstanceEnvironment),
}

/// Sends messages of enabled categories to the importer.
///
/// Both standards let errors through even when debug logging is off.
pub struct Logger {
    callback: Callback,
    instance_name: CString,
    enabled: [bool; LOG_CATEGORIES.len()],
}

impl Logger {
    pub fn new(callback: Callback, instance_name: CString, logging_on: bool) -> Self {
        Self { callback, instance_name, enabled: [logging_on; LOG_CATEGORIES.len()] }
    }

    /// Number of a category by name.
    fn category(name: &CStr) -> Option<usize> {
        LOG_CATEGORIES.iter().position(|(known, _)| *known == name)
    }

    /// A call was refused with [`Status::Error`].
    pub(super) fn error(&self, message: fmt::Arguments<'_>) {
        self.refusal(Status::Error, message);
    }

    /// A call was refused.
    #[cold]
    pub(super) fn refusal(&self, status: Status, message: fmt::Arguments<'_>) {
        self.send(status, ERROR, message);
    }

    /// The instance is lost.
    #[cold]
    pub(super) fn fatal(&self, message: fmt::Arguments<'_>) {
        self.send(Status::Fatal, FATAL, message);
    }

    fn send(&self, status: Status, category: usize, message: fmt::Arguments<'_>) {
        let category = LOG_CATEGORIES[category].0.as_ptr();
        match self.callback {
            Callback::None => {}
            Callback::Fmi2(callback, environment) => {
                let text = Message::new(message, true);
                // SAFETY: the importer vouches for its callback and environment as long as the instance lives; all
                // strings end with NUL and outlive the call; the format has no conversions, since % is doubled.
                unsafe {
                    callback(
                        environment,
                        self.instance_name.as_ptr(),
                        status as i32,
                        category,
                        text.as_ptr(),
                    );
                }
            }
            Callback::Fmi3(callback, environment) => {
                let text = Message::new(message, false);
                // SAFETY: as above.
                unsafe { callback(environment, status as i32, category, text.as_ptr()) }
            }
        }
    }
}

impl Journal for Logger {
    fn wants(&self, topic: Topic) -> bool {
        self.enabled[category_of(topic)] && !matches!(self.callback, Callback::None)
    }

    fn note(&mut self, topic: Topic, message: fmt::Arguments<'_>) {
        if self.wants(topic) {
            self.send(Status::Ok, category_of(topic), message);
        }
    }
}

fn category_of(topic: Topic) -> usize {
    match topic {
        Topic::Events => EVENTS,
        Topic::Observer => OBSERVER,
    }
}

/// Longest message in bytes, the final NUL included; the rest is cut off.
const CAPACITY: usize = 1024;

/// C string on the stack.
struct Message {
    text: [u8; CAPACITY],
    length: usize,
    double_percent: bool,
}

impl Message {
    fn new(arguments: fmt::Arguments<'_>, double_percent: bool) -> Self {
        let mut message = Self { text: [0; CAPACITY], length: 0, double_percent };
        // Fails only when the text is cut off, which is what we want then.
        let _ = message.write_fmt(arguments);
        message
    }

    fn as_ptr(&self) -> *const c_char {
        self.text.as_ptr().cast()
    }

    fn push(&mut self, bytes: &[u8]) -> fmt::Result {
        let end = self.length + bytes.len();
        // The last byte stays NUL.
        if end >= CAPACITY {
            return Err(fmt::Error);
        }
        self.text[self.length..end].copy_from_slice(bytes);
        self.length = end;
        Ok(())
    }
}

impl Write for Message {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut encoded = [0; 4];
        text.chars().try_for_each(|character| match character {
            // #4# stands for the variable with the value reference 4.
            '#' => self.push(b"##"),
            '%' if self.double_percent => self.push(b"%%"),
            '\0' => self.push(b"?"),
            _ => self.push(character.encode_utf8(&mut encoded).as_bytes()),
        })
    }
}

/// Switches categories by name, or all of them when there is no name. An unknown name changes nothing.
///
/// # Safety
/// Each name is null or a NUL-terminated string.
pub(super) unsafe fn set_debug_logging(
    logger: &mut Logger,
    on: bool,
    names: &[*const c_char],
) -> Result<(), CallError> {
    // SAFETY: the caller's promise.
    let number = |name: &*const c_char| unsafe { c_string(*name) }.and_then(Logger::category);
    if let Some(unknown) = names.iter().find(|name| number(name).is_none()) {
        // SAFETY: the caller's promise.
        return Err(CallError::UnknownCategory(CategoryName::new(unsafe { c_string(*unknown) })));
    }
    if names.is_empty() {
        logger.enabled = [on; LOG_CATEGORIES.len()];
    }
    names.iter().filter_map(number).for_each(|category| logger.enabled[category] = on);
    Ok(())
}

/// Reads a C string that may be null or not UTF-8.
///
/// # Safety
/// `pointer` is null or points to a NUL-terminated string that outlives the result.
pub(super) unsafe fn c_string<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: not null here; the rest is the caller's promise.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(arguments: fmt::Arguments<'_>, double_percent: bool) -> String {
        let message = Message::new(arguments, double_percent);
        CStr::from_bytes_until_nul(&message.text).unwrap().to_str().unwrap().to_owned()
    }

    #[test]
    fn percent_signs_cannot_become_conversions() {
        assert_eq!(text(format_args!("100 %s"), true), "100 %%s");
        assert_eq!(text(format_args!("100 %s"), false), "100 %s");
    }

    #[test]
    fn number_signs_cannot_become_references() {
        assert_eq!(text(format_args!("#1#"), true), "##1##");
        assert_eq!(text(format_args!("#1#"), false), "##1##");
    }

    #[test]
    fn long_messages_are_cut_at_a_character() {
        let long = "ü".repeat(CAPACITY);
        let cut = text(format_args!("{long}"), false);
        assert_eq!(cut.len(), CAPACITY - 2);
        assert!(cut.chars().all(|character| character == 'ü'));
    }
}
