//! One instance of FMI 3.0.

use std::ffi::{CStr, c_void};
use std::ptr;
use std::sync::Arc;

use crate::fmi::fmi3::types::*;
use crate::host::component::{Answer, Component, Number, Refusal, accept, boolean_from};
use crate::host::message_log::{MessageLog, text_of};
use crate::host::variable::Storage;

use super::functions::{Access, Functions, OfInstance};

/// One co-simulation instance of FMI 3.0.
pub(in crate::host) struct FmiThree {
    instance: fmi3Instance,
    functions: Functions,
    // Only there to outlive the instance that points to it.
    _message_log: Arc<MessageLog>,
}

// SAFETY: the standard binds an instance to no thread, it only forbids concurrent calls; `FmiThree` is not `Sync`.
// The message_log, the one thing shared with the FMU's own threads, is behind a lock.
unsafe impl Send for FmiThree {}

impl FmiThree {
    /// A new co-simulation instance without event mode and early return, `None` if the FMU refuses.
    pub(in crate::host) fn instantiate(
        functions: Functions,
        name: &CStr,
        token: &CStr,
        resource_path: &CStr,
        logging: bool,
        message_log: Arc<MessageLog>,
    ) -> Option<Self> {
        // SAFETY: all strings end with NUL and outlive the call; the message_log outlives the instance.
        let instance = unsafe {
            (functions.instantiate)(
                name.as_ptr(),
                token.as_ptr(),
                resource_path.as_ptr(),
                FMI3_FALSE,
                fmi3Boolean::from(logging),
                FMI3_FALSE,
                FMI3_FALSE,
                ptr::null(),
                0,
                Arc::as_ptr(&message_log).cast_mut().cast(),
                Some(log),
                None,
            )
        };
        (!instance.is_null()).then_some(Self { instance, functions, _message_log: message_log })
    }

    fn call(&self, name: &'static str, function: OfInstance) -> Answer {
        // SAFETY: the instance is alive until `free`.
        accept(name, unsafe { function(self.instance) })
    }

    fn get<T: Number>(&self, access: Access<T>, storage: Storage, reference: u32) -> Answer<f64> {
        let function = access.get.ok_or(Refusal::Missing { function: access.getter })?;
        let mut value = T::default();
        // SAFETY: one reference, room for one value.
        accept(access.getter, unsafe { function(self.instance, &reference, 1, &mut value, 1) })?;
        // Only 64 bit integers can fail; the nearest f64 is close enough for a message.
        value.exactly_to().ok_or(Refusal::NotExact { value: value.nearest(), target: storage })
    }

    fn set<T: Number>(&self, access: Access<T>, storage: Storage, reference: u32, value: f64) -> Answer {
        let value = T::exactly_from(value).ok_or(Refusal::NotExact { value, target: storage })?;
        self.set_raw(access, reference, value)
    }

    fn set_raw<T>(&self, access: Access<T>, reference: u32, value: T) -> Answer {
        let function = access.set.ok_or(Refusal::Missing { function: access.setter })?;
        // SAFETY: one reference, one value.
        accept(access.setter, unsafe { function(self.instance, &reference, 1, &value, 1) })
    }
}

impl Component for FmiThree {
    fn enter_initialisation(&mut self, start_time: f64, stop_time: Option<f64>) -> Answer {
        // SAFETY: the instance is alive until `free`.
        let status = unsafe {
            (self.functions.enter_initialisation)(
                self.instance,
                FMI3_FALSE,
                0.0,
                start_time,
                fmi3Boolean::from(stop_time.is_some()),
                stop_time.unwrap_or(0.0),
            )
        };
        accept("fmi3EnterInitializationMode", status)
    }

    fn exit_initialisation(&mut self) -> Answer {
        self.call("fmi3ExitInitializationMode", self.functions.exit_initialisation)
    }

    #[inline]
    fn step(&mut self, time: f64, step_size: f64, may_go_back: bool) -> Answer {
        let mut event_handling_needed = FMI3_FALSE;
        let mut terminate = FMI3_FALSE;
        let mut early_return = FMI3_FALSE;
        let mut last_successful_time = time;
        // SAFETY: the instance is alive until `free`, the four results have room.
        let status = unsafe {
            (self.functions.do_step)(
                self.instance,
                time,
                step_size,
                fmi3Boolean::from(!may_go_back),
                &mut event_handling_needed,
                &mut terminate,
                &mut early_return,
                &mut last_successful_time,
            )
        };
        accept("fmi3DoStep", status)?;
        // Event handling and early return were declined at instantiation.
        if terminate == FMI3_FALSE { Ok(()) } else { Err(Refusal::Termination) }
    }

    fn terminate(&mut self) -> Answer {
        self.call("fmi3Terminate", self.functions.terminate)
    }

    fn reset(&mut self) -> Answer {
        self.call("fmi3Reset", self.functions.reset)
    }

    fn free(&mut self) {
        // SAFETY: called once, by the owner's drop, and nothing is called after it.
        unsafe { (self.functions.free_instance)(self.instance) }
    }

    #[inline]
    fn get_reals(&self, references: &[u32], values: &mut [f64]) -> Answer {
        debug_assert_eq!(references.len(), values.len());
        let count = references.len();
        // SAFETY: as many values as references, and both lengths are passed.
        let status = unsafe {
            (self.functions.get_float64)(
                self.instance,
                references.as_ptr(),
                count,
                values.as_mut_ptr(),
                values.len(),
            )
        };
        accept("fmi3GetFloat64", status)
    }

    #[inline]
    fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Answer {
        debug_assert_eq!(references.len(), values.len());
        let count = references.len();
        // SAFETY: as many values as references, and both lengths are passed.
        let status = unsafe {
            (self.functions.set_float64)(
                self.instance,
                references.as_ptr(),
                count,
                values.as_ptr(),
                values.len(),
            )
        };
        accept("fmi3SetFloat64", status)
    }

    fn get_number(&self, storage: Storage, reference: u32) -> Answer<f64> {
        let functions = &self.functions;
        match storage {
            Storage::Float64 => {
                let mut value = [0.0];
                self.get_reals(&[reference], &mut value).map(|()| value[0])
            }
            Storage::Float32 => self.get(functions.float32, storage, reference),
            Storage::Int8 => self.get(functions.int8, storage, reference),
            Storage::UInt8 => self.get(functions.uint8, storage, reference),
            Storage::Int16 => self.get(functions.int16, storage, reference),
            Storage::UInt16 => self.get(functions.uint16, storage, reference),
            Storage::Int32 => self.get(functions.int32, storage, reference),
            Storage::UInt32 => self.get(functions.uint32, storage, reference),
            Storage::Int64 => self.get(functions.int64, storage, reference),
            Storage::UInt64 => self.get(functions.uint64, storage, reference),
            Storage::Boolean => self
                .get(functions.boolean, storage, reference)
                .map(|value| f64::from(u8::from(value != f64::from(FMI3_FALSE)))),
            Storage::String | Storage::Other => Err(Refusal::WrongStorage),
        }
    }

    fn set_number(&mut self, storage: Storage, reference: u32, value: f64) -> Answer {
        let functions = &self.functions;
        match storage {
            Storage::Float64 => self.set_reals(&[reference], &[value]),
            Storage::Float32 => self.set(functions.float32, storage, reference, value),
            Storage::Int8 => self.set(functions.int8, storage, reference, value),
            Storage::UInt8 => self.set(functions.uint8, storage, reference, value),
            Storage::Int16 => self.set(functions.int16, storage, reference, value),
            Storage::UInt16 => self.set(functions.uint16, storage, reference, value),
            Storage::Int32 => self.set(functions.int32, storage, reference, value),
            Storage::UInt32 => self.set(functions.uint32, storage, reference, value),
            Storage::Int64 => self.set(functions.int64, storage, reference, value),
            Storage::UInt64 => self.set(functions.uint64, storage, reference, value),
            Storage::Boolean => {
                self.set_raw(functions.boolean, reference, fmi3Boolean::from(boolean_from(value)?))
            }
            Storage::String | Storage::Other => Err(Refusal::WrongStorage),
        }
    }

    fn get_text(&self, reference: u32) -> Answer<String> {
        let access = &self.functions.string;
        let function = access.get.ok_or(Refusal::Missing { function: access.getter })?;
        let mut text: fmi3String = ptr::null();
        // SAFETY: one reference, room for one pointer.
        let status = unsafe { function(self.instance, &reference, 1, &mut text, 1) };
        // SAFETY: the FMU guarantees the string until its next call; it is copied at once.
        accept(access.getter, status).map(|()| unsafe { text_of(text) })
    }

    fn set_text(&mut self, reference: u32, text: &CStr) -> Answer {
        self.set_raw(self.functions.string, reference, text.as_ptr())
    }

    fn get_state(&mut self) -> Answer<*mut c_void> {
        let name = "fmi3GetFMUState";
        let function = self.functions.get_state.ok_or(Refusal::Missing { function: name })?;
        // NULL asks the FMU to allocate.
        let mut state = ptr::null_mut();
        // SAFETY: room for one pointer.
        accept(name, unsafe { function(self.instance, &mut state) }).map(|()| state)
    }

    fn set_state(&mut self, state: *mut c_void) -> Answer {
        let name = "fmi3SetFMUState";
        let function = self.functions.set_state.ok_or(Refusal::Missing { function: name })?;
        // SAFETY: the state is this instance's own, by the trait's contract.
        accept(name, unsafe { function(self.instance, state) })
    }

    fn free_state(&mut self, mut state: *mut c_void) -> Answer {
        let name = "fmi3FreeFMUState";
        let function = self.functions.free_state.ok_or(Refusal::Missing { function: name })?;
        // SAFETY: the state is this instance's own, by the trait's contract.
        accept(name, unsafe { function(self.instance, &mut state) })
    }

    fn serialise_state(&mut self, state: *mut c_void) -> Answer<Vec<u8>> {
        let name = "fmi3SerializedFMUStateSize";
        let function = self.functions.state_size.ok_or(Refusal::Missing { function: name })?;
        let mut size = 0;
        // SAFETY: the state is this instance's own, by the trait's contract; room for the size.
        accept(name, unsafe { function(self.instance, state, &mut size) })?;
        let name = "fmi3SerializeFMUState";
        let function = self.functions.serialise_state.ok_or(Refusal::Missing { function: name })?;
        let mut bytes = vec![0; size];
        let target = bytes.as_mut_ptr();
        // SAFETY: as above, and room for as many bytes as were asked for.
        accept(name, unsafe { function(self.instance, state, target, size) })?;
        Ok(bytes)
    }

    fn deserialise_state(&mut self, bytes: &[u8]) -> Answer<*mut c_void> {
        let name = "fmi3DeserializeFMUState";
        let function = self.functions.deserialise_state.ok_or(Refusal::Missing { function: name })?;
        // NULL asks the FMU to allocate.
        let mut state = ptr::null_mut();
        let source = bytes.as_ptr();
        // SAFETY: as many bytes as said, room for one pointer.
        accept(name, unsafe { function(self.instance, source, bytes.len(), &mut state) }).map(|()| state)
    }
}

/// Collects a message and never unwinds, whatever its type allows.
unsafe extern "C-unwind" fn log(
    environment: fmi3InstanceEnvironment,
    status: fmi3Status,
    category: fmi3String,
    message: fmi3String,
) {
    // SAFETY: the environment is the message_log of a living instance, the strings are C strings or NULL.
    unsafe { MessageLog::append(environment.cast_const().cast(), status, category, message, |text| text) };
}
