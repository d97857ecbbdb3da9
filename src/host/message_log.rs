//! What an instance logged.

use std::collections::VecDeque;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::error::ReportedStatus;

/// A model that logs in every step must not fill the memory: the oldest messages go first.
const CAPACITY: usize = 10_000;

/// One message of an FMU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogMessage {
    pub status: ReportedStatus,
    pub category: String,
    pub text: String,
}

/// Messages of one instance. Its address is the environment pointer that the FMU hands back to the logger.
///
/// The lock is there because careless models log from threads of their own.
#[derive(Debug, Default)]
pub(super) struct MessageLog {
    messages: Mutex<VecDeque<LogMessage>>,
}

impl MessageLog {
    pub(super) fn messages(&self) -> Vec<LogMessage> {
        self.lock().iter().cloned().collect()
    }

    /// The last message, as an error wants to quote it.
    pub(super) fn last_text(&self) -> Option<String> {
        self.lock().back().map(|message| message.text.clone())
    }

    pub(super) fn clear(&self) {
        self.lock().clear();
    }

    /// Appends a message that came through a C callback; never unwinds.
    ///
    /// # Safety
    /// `message_log` is NULL or points to a living message_log; `category` and `text` are NULL or C strings.
    pub(super) unsafe fn append(
        message_log: *const Self,
        status: i32,
        category: *const c_char,
        text: *const c_char,
        polish: fn(String) -> String,
    ) {
        // Nobody below this frame could handle a panic: losing a message is the lesser evil.
        let _ = catch_unwind(AssertUnwindSafe(|| {
            // SAFETY: the caller passes NULL or a living message_log.
            let Some(message_log) = (unsafe { message_log.as_ref() }) else { return };
            let message = LogMessage {
                status: ReportedStatus(status),
                // SAFETY: the caller passes NULL or C strings.
                category: unsafe { text_of(category) },
                // SAFETY: as above.
                text: polish(unsafe { text_of(text) }),
            };
            let mut messages = message_log.lock();
            if messages.len() == CAPACITY {
                messages.pop_front();
            }
            messages.push_back(message);
        }));
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<LogMessage>> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// An owned copy of a C string; empty for NULL, bytes that are not UTF-8 replaced.
///
/// # Safety
/// `text` is NULL or points to a string that ends with a NUL byte.
pub(super) unsafe fn text_of(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not NULL, hence a C string by this function's contract.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_newest_messages_and_survives_null() {
        let message_log = MessageLog::default();
        for number in 0..CAPACITY + 2 {
            let text = std::ffi::CString::new(format!("{number}")).unwrap();
            // SAFETY: a living message_log, NULL and a C string.
            unsafe { MessageLog::append(&message_log, 1, std::ptr::null(), text.as_ptr(), |text| text) };
        }
        // SAFETY: all NULL.
        unsafe { MessageLog::append(std::ptr::null(), 1, std::ptr::null(), std::ptr::null(), |text| text) };
        let messages = message_log.messages();
        assert_eq!((messages.len(), messages[0].text.as_str()), (CAPACITY, "2"));
        assert_eq!(message_log.last_text(), Some((CAPACITY + 1).to_string()));
    }
}
