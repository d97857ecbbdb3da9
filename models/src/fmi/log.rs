//! What is said to the importer, and how: through its callback only, in the categories it enabled.

use core::ffi::{CStr, c_char};
use core::fmt;

use super::fmi2::types::{fmi2CallbackLogger, fmi2ComponentEnvironment};
use super::fmi3::types::{fmi3InstanceEnvironment, fmi3LogMessageCallback};
use super::log_categories::{CategoryName, ERROR, EVENTS, FATAL, LOG_CATEGORIES, OBSERVER};
use super::message::{Message, Outbox};
use super::{CallError, Status};
use crate::model::memory::{OutOfMemory, try_vector};
use crate::model::{LogSink, Topic};

/// The importer's callback, if it gave one.
#[derive(Clone, Copy)]
pub enum Callback {
    None,
    Fmi2(fmi2CallbackLogger, fmi2ComponentEnvironment),
    Fmi3(fmi3LogMessageCallback, fmi3InstanceEnvironment),
}

impl Callback {
    /// A message as this importer reads it: that of FMI 2.0 is a format of `printf`.
    fn message(self, status: Status, category: usize, arguments: fmt::Arguments<'_>) -> Message {
        Message::new(status, category, self.takes_formats(), arguments)
    }

    fn takes_formats(self) -> bool {
        matches!(self, Self::Fmi2(..))
    }

    /// Why there is no instance.
    #[cold]
    pub(super) fn refusal(self, status: Status, arguments: fmt::Arguments<'_>) -> Message {
        self.message(status, category_of_refusal(status), arguments)
    }

    /// A remark about the life of an instance.
    pub(super) fn event(self, arguments: fmt::Arguments<'_>) -> Message {
        self.message(Status::Ok, EVENTS, arguments)
    }

    /// Calls the importer. It need not come back: an exception or a jump may end this call and those below it, so no
    /// reference to an instance and nothing that is yet to be dropped may be alive here or in any caller.
    ///
    /// # Safety
    /// The callback may be called and understands its environment; `instance_name` is a C string.
    pub(super) unsafe fn send(self, instance_name: *const c_char, message: &Message) {
        let (status, text) = (message.status as i32, message.as_ptr());
        let category = LOG_CATEGORIES[message.category].0.as_ptr();
        // SAFETY: the importer has passed callback and environment together; all strings end with NUL and outlive the
        // call; the format has no conversions, since % is doubled.
        unsafe {
            match self {
                Self::None => {}
                Self::Fmi2(callback, environment) => {
                    callback(environment, instance_name, status, category, text)
                }
                Self::Fmi3(callback, environment) => callback(environment, status, category, text),
            }
        }
    }
}

/// Collects messages of enabled categories for the importer, who gets them when the call is done
/// (`boundary::enter`).
///
/// Both standards let errors through even when debug logging is off.
pub struct Logger {
    pub(super) callback: Callback,
    /// As a C string.
    instance_name: Vec<u8>,
    enabled: [bool; LOG_CATEGORIES.len()],
    pub(super) outbox: Outbox,
}

impl Logger {
    pub fn new(callback: Callback, instance_name: &CStr, logging_on: bool) -> Result<Self, OutOfMemory> {
        let name = instance_name.to_bytes_with_nul();
        let mut own_name = try_vector("the instance's name", name.len())?;
        own_name.extend_from_slice(name);
        let outbox = if matches!(callback, Callback::None) { Outbox::default() } else { Outbox::new()? };
        let enabled = [logging_on; LOG_CATEGORIES.len()];
        Ok(Self { callback, instance_name: own_name, enabled, outbox })
    }

    /// Name that the importer gave the instance.
    pub(super) fn instance_name(&self) -> *const c_char {
        self.instance_name.as_ptr().cast()
    }

    /// Number of a category by name.
    fn category(name: &CStr) -> Option<usize> {
        LOG_CATEGORIES.iter().position(|(known, _)| *known == name)
    }

    /// A call was refused, or the instance is lost.
    #[cold]
    pub(super) fn refusal(&mut self, status: Status, message: fmt::Arguments<'_>) {
        self.push(status, category_of_refusal(status), message);
    }

    fn push(&mut self, status: Status, category: usize, message: fmt::Arguments<'_>) {
        if !matches!(self.callback, Callback::None) {
            self.outbox.push(status, category, self.callback.takes_formats(), message);
        }
    }
}

impl LogSink for Logger {
    fn enabled(&self, topic: Topic) -> bool {
        self.enabled[category_of(topic)] && !matches!(self.callback, Callback::None)
    }

    fn log(&mut self, topic: Topic, message: fmt::Arguments<'_>) {
        if self.enabled(topic) {
            self.push(Status::Ok, category_of(topic), message);
        }
    }
}

fn category_of(topic: Topic) -> usize {
    match topic {
        Topic::Events => EVENTS,
        Topic::Observer => OBSERVER,
    }
}

fn category_of_refusal(status: Status) -> usize {
    if status == Status::Fatal { FATAL } else { ERROR }
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
    // SAFETY: each name is null or ends with NUL, by this function's own contract.
    let number = |name: &*const c_char| unsafe { c_string(*name) }.and_then(Logger::category);
    if let Some(unknown) = names.iter().find(|name| number(name).is_none()) {
        // SAFETY: each name is null or ends with NUL, by this function's own contract.
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
    // SAFETY: not null here, so a string with a NUL at its end that outlives the result.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}
