//! A logger that keeps the last message, without the heap, so that it can be called where memory is short.

use core::cell::{Cell, RefCell};
use core::ffi::{CStr, c_char, c_void};
use core::mem::transmute;

use maglev_fmu::fmi::LOG_CATEGORIES;
use maglev_fmu::fmi::fmi2::types::fmi2CallbackLogger;

use super::environment;

/// What an instance has logged during a call; the environment of its callbacks.
pub struct Log {
    /// Messages with any other status than OK.
    complaints: Cell<u32>,
    last_status: Cell<i32>,
    text: RefCell<([u8; 600], usize)>,
    /// What the logger itself objects to.
    objection: Cell<Option<&'static str>>,
}

impl Log {
    pub fn new() -> Self {
        Self {
            complaints: Cell::new(0),
            last_status: Cell::new(0),
            text: RefCell::new(([0; 600], 0)),
            objection: Cell::new(None),
        }
    }

    pub fn clear(&self) {
        self.complaints.set(0);
        self.text.borrow_mut().1 = 0;
    }

    /// Number of messages that were no mere information.
    pub fn complaints(&self) -> u32 {
        self.complaints.get()
    }

    /// Status of the last complaint.
    pub fn last_status(&self) -> i32 {
        self.last_status.get()
    }

    pub fn text(&self) -> String {
        let text = self.text.borrow();
        String::from_utf8_lossy(&text.0[..text.1]).into_owned()
    }

    pub fn objection(&self) -> Option<&'static str> {
        self.objection.get()
    }

    fn append(&self, status: i32, category: &CStr, message: &CStr) {
        if !LOG_CATEGORIES.iter().any(|(known, _)| *known == category) {
            self.objection.set(Some("a category that is not declared"));
        }
        if message.to_str().is_err() || message.is_empty() {
            self.objection.set(Some("a message without text, or one that is not UTF-8"));
        }
        if !environment::is_that_of_the_host() {
            self.objection
                .set(Some("called in another floating-point environment than that of the importer"));
        }
        if status != 0 {
            self.complaints.set(self.complaints.get() + 1);
            self.last_status.set(status);
            let mut text = self.text.borrow_mut();
            let (bytes, length) = (message.to_bytes(), message.count_bytes().min(600));
            text.0[..length].copy_from_slice(&bytes[..length]);
            text.1 = length;
        }
    }
}

/// # Safety
/// Called by the library: the environment is a living [`Log`], the strings are C strings.
pub unsafe extern "C-unwind" fn fmi3_logger(
    environment: *mut c_void,
    status: i32,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the caller's promise.
    unsafe {
        (*environment.cast::<Log>()).append(status, CStr::from_ptr(category), CStr::from_ptr(message));
    }
}

unsafe extern "C-unwind" fn fixed_fmi2_logger(
    environment: *mut c_void,
    name: *const c_char,
    status: i32,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: as for `fmi3_logger`.
    unsafe {
        let log = &*environment.cast::<Log>();
        if CStr::from_ptr(name) != c"random" {
            log.objection.set(Some("another name than that of the instance"));
        }
        log.append(status, CStr::from_ptr(category), CStr::from_ptr(message));
    }
}

/// The variadic logger of FMI 2.0.
pub fn fmi2_logger() -> fmi2CallbackLogger {
    type Fixed = unsafe extern "C-unwind" fn(*mut c_void, *const c_char, i32, *const c_char, *const c_char);
    // SAFETY: as in the harness: on the C ABIs of the supported platforms the named arguments of a variadic call lie
    // where those of an ordinary call lie, and the caller cleans up.
    unsafe { transmute::<Fixed, fmi2CallbackLogger>(fixed_fmi2_logger) }
}
