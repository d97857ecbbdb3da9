//! A logger that keeps what it is told.

use core::ffi::{CStr, c_char, c_void};
use std::mem::transmute;
use std::sync::Mutex;

use maglev_fmu::fmi::fmi2::types::{fmi2CallbackLogger, fmi2ComponentEnvironment, fmi2Status, fmi2String};
use maglev_fmu::fmi::fmi3::types::{fmi3InstanceEnvironment, fmi3Status, fmi3String};

/// One call of the logger.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// FMI 2.0 only.
    pub instance_name: Option<String>,
    pub status: i32,
    pub category: String,
    pub text: String,
}

/// Its address is the environment that the instance hands back.
#[derive(Debug, Default)]
pub struct Recorder(Mutex<Vec<Message>>);

impl Recorder {
    pub fn environment(&self) -> *mut c_void {
        core::ptr::from_ref(self).cast_mut().cast()
    }

    pub fn messages(&self) -> Vec<Message> {
        self.0.lock().unwrap().clone()
    }

    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut self.0.lock().unwrap())
    }

    pub fn clear(&self) {
        self.0.lock().unwrap().clear();
    }

    /// # Safety
    /// The environment of a living recorder and C strings.
    unsafe fn append(
        environment: *mut c_void,
        instance_name: Option<*const c_char>,
        status: i32,
        category: *const c_char,
        text: *const c_char,
    ) {
        // SAFETY: the caller's promise.
        unsafe {
            let own = |text: *const c_char| CStr::from_ptr(text).to_str().expect("UTF-8").to_owned();
            let recorder = environment.cast::<Self>().as_ref().expect("the environment");
            recorder.0.lock().unwrap().push(Message {
                instance_name: instance_name.map(own),
                status,
                category: own(category),
                text: own(text),
            });
        }
    }
}

unsafe extern "C-unwind" fn log2(
    environment: fmi2ComponentEnvironment,
    instance_name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
) {
    // SAFETY: the tests pass the environment of a living recorder; the library passes C strings that live during the call.
    unsafe { Recorder::append(environment, Some(instance_name), status, category, message) }
}

/// The variadic logger of FMI 2.0.
pub fn fmi2_logger() -> fmi2CallbackLogger {
    type Fixed =
        unsafe extern "C-unwind" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String);
    // SAFETY: stable Rust cannot define a variadic function. On the C ABIs of the supported platforms the named
    // arguments of a variadic call, pointers and one int, lie where those of an ordinary call lie, and the caller
    // cleans up; `log2` reads the named arguments only.
    unsafe { transmute::<Fixed, fmi2CallbackLogger>(log2) }
}

/// The logger of FMI 3.0.
///
/// # Safety
/// Called by an instance whose environment is a living recorder.
pub unsafe extern "C-unwind" fn fmi3_logger(
    environment: fmi3InstanceEnvironment,
    status: fmi3Status,
    category: fmi3String,
    message: fmi3String,
) {
    // SAFETY: as for `log2`.
    unsafe { Recorder::append(environment, None, status, category, message) }
}
