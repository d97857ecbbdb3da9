//! What callbacks find.

use core::ffi::{c_char, c_void};
use core::mem::transmute;
use core::ptr::{null, null_mut};
use std::cell::RefCell;
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::fmi2CallbackLogger;

use super::host::{ENVIRONMENTS, control_word, hosted};
use crate::harness::clocked::Choices;
use crate::harness::{BOTH, CONTROLLER, Component, Standard, description, instantiate_with};

thread_local! {
    /// Control words that callbacks have found.
    static FOUND: RefCell<Vec<u32>> = const { RefCell::new(Vec::new()) };
}

fn find() {
    FOUND.with_borrow_mut(|found| found.push(control_word()));
}

unsafe extern "C-unwind" fn logger2(
    _: *mut c_void,
    _: *const c_char,
    _: i32,
    _: *const c_char,
    _: *const c_char,
) {
    find();
}

unsafe extern "C-unwind" fn logger3(_: *mut c_void, _: i32, _: *const c_char, _: *const c_char) {
    find();
}

unsafe extern "C-unwind" fn update(
    _: *mut c_void,
    _: f64,
    _: u8,
    _: u8,
    _: u8,
    _: u8,
    _: *mut u8,
    _: *mut f64,
) {
    find();
}

unsafe extern "C-unwind" fn clock_update(_: *mut c_void) {
    find();
}

fn with_loggers(standard: Standard, model: &str) -> Component {
    type Fixed = unsafe extern "C-unwind" fn(*mut c_void, *const c_char, i32, *const c_char, *const c_char);
    // SAFETY: as for the recording logger of the harness.
    let logger2 = unsafe { transmute::<Fixed, fmi2CallbackLogger>(logger2) };
    let token = CString::new(description(model).token().as_str()).unwrap();
    // SAFETY: C strings, and loggers that need no environment.
    let handle = unsafe {
        let (name, loggers) = (c"hosted".as_ptr(), (Some(logger2), Some(logger3 as _)));
        instantiate_with(standard, name, token.as_ptr(), null(), null_mut(), loggers.0, loggers.1, true)
    };
    Component::from_handle(standard, model, handle, Box::default())
}

#[test]
fn callbacks_find_the_hosts_own_word() {
    for word in ENVIRONMENTS {
        let called = |least: usize, run: &dyn Fn()| {
            FOUND.take();
            run();
            let found = FOUND.take();
            assert!(found.len() >= least, "{found:?}");
            assert!(found.iter().all(|found| *found == word), "{found:x?}, expected {word:#x}");
        };
        for standard in BOTH {
            called(4, &|| {
                let component = hosted(word, || with_loggers(standard, CONTROLLER));
                hosted(word, || component.initialise(0.0));
                for k in 0..6 {
                    let time = f64::from(k) * 1e-3;
                    let position = 0.01 + time * time;
                    hosted(word, || component.set("position", position));
                    hosted(word, || component.step(time, 1e-3));
                }
                hosted(word, || component.step(0.0, f64::NAN));
            });
        }
        called(3, &|| {
            let choices = Choices { intermediate_update: Some(update), ..Choices::default() };
            let component = hosted(word, || Component::co_simulation(CONTROLLER, choices));
            hosted(word, || component.initialise(0.0));
            hosted(word, || component.step(0.0, 4e-3));
        });
        called(2, &|| {
            let component = hosted(word, || Component::scheduled(CONTROLLER, Some(clock_update)));
            hosted(word, || component.initialise(0.0));
            hosted(word, || component.activate(0.0));
            hosted(word, || component.activate(1e-3));
        });
    }
}
