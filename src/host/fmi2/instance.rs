//! One instance of FMI 2.0.

use std::ffi::{CStr, c_void};
use std::ptr;
use std::sync::Arc;

use crate::fmi::fmi2::types::*;
use crate::host::component::{Answer, Component, Number, Refusal, accept, boolean_from};
use crate::host::message_log::{MessageLog, text_of};
use crate::host::variable::Storage;

use super::callbacks::Callbacks;
use super::functions::{Functions, Get, OfComponent, Set};

/// One co-simulation instance of FMI 2.0.
pub(in crate::host) struct FmiTwo {
    component: fmi2Component,
    functions: Functions,
    // Both are only there to outlive the component that points to them.
    _callbacks: Callbacks,
    _message_log: Arc<MessageLog>,
}

// SAFETY: the standard binds an instance to no thread, it only forbids concurrent calls; `FmiTwo` is not `Sync`.
// The message_log, the one thing shared with the FMU's own threads, is behind a lock.
unsafe impl Send for FmiTwo {}

impl FmiTwo {
    /// A new co-simulation instance, `None` if the FMU refuses.
    pub(in crate::host) fn instantiate(
        functions: Functions,
        name: &CStr,
        token: &CStr,
        resource_location: &CStr,
        logging: bool,
        message_log: Arc<MessageLog>,
    ) -> Option<Self> {
        let callbacks = Callbacks::new(&message_log);
        // SAFETY: all strings end with NUL and outlive the call; the callbacks outlive the instance.
        let component = unsafe {
            (functions.instantiate)(
                name.as_ptr(),
                FMI2_CO_SIMULATION,
                token.as_ptr(),
                resource_location.as_ptr(),
                callbacks.as_ptr(),
                FMI2_FALSE,
                fmi2Boolean::from(logging),
            )
        };
        (!component.is_null()).then_some(Self {
            component,
            functions,
            _callbacks: callbacks,
            _message_log: message_log,
        })
    }

    fn call(&self, name: &'static str, function: OfComponent) -> Answer {
        // SAFETY: the component is alive until `free`.
        accept(name, unsafe { function(self.component) })
    }

    fn get<T: Default>(&self, name: &'static str, function: Get<T>, reference: u32) -> Answer<T> {
        let mut value = T::default();
        // SAFETY: one reference, room for one value.
        accept(name, unsafe { function(self.component, &reference, 1, &mut value) }).map(|()| value)
    }

    fn set<T>(&self, name: &'static str, function: Set<T>, reference: u32, value: T) -> Answer {
        // SAFETY: one reference, one value.
        accept(name, unsafe { function(self.component, &reference, 1, &value) })
    }
}

impl Component for FmiTwo {
    fn enter_initialisation(&mut self, start_time: f64, stop_time: Option<f64>) -> Answer {
        // SAFETY: the component is alive until `free`.
        let status = unsafe {
            (self.functions.setup_experiment)(
                self.component,
                FMI2_FALSE,
                0.0,
                start_time,
                fmi2Boolean::from(stop_time.is_some()),
                stop_time.unwrap_or(0.0),
            )
        };
        accept("fmi2SetupExperiment", status)?;
        self.call("fmi2EnterInitializationMode", self.functions.enter_initialisation)
    }

    fn exit_initialisation(&mut self) -> Answer {
        self.call("fmi2ExitInitializationMode", self.functions.exit_initialisation)
    }

    #[inline]
    fn step(&mut self, time: f64, step_size: f64, may_go_back: bool) -> Answer {
        // SAFETY: the component is alive until `free`.
        let status = unsafe {
            (self.functions.do_step)(self.component, time, step_size, fmi2Boolean::from(!may_go_back))
        };
        accept("fmi2DoStep", status)
    }

    fn terminate(&mut self) -> Answer {
        self.call("fmi2Terminate", self.functions.terminate)
    }

    fn reset(&mut self) -> Answer {
        self.call("fmi2Reset", self.functions.reset)
    }

    fn free(&mut self) {
        // SAFETY: called once, by the owner's drop, and nothing is called after it.
        unsafe { (self.functions.free_instance)(self.component) }
    }

    #[inline]
    fn get_reals(&self, references: &[u32], values: &mut [f64]) -> Answer {
        debug_assert_eq!(references.len(), values.len());
        // SAFETY: as many values as references.
        let status = unsafe {
            (self.functions.get_real)(
                self.component,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
            )
        };
        accept("fmi2GetReal", status)
    }

    #[inline]
    fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Answer {
        debug_assert_eq!(references.len(), values.len());
        // SAFETY: as many values as references.
        let status = unsafe {
            (self.functions.set_real)(self.component, references.as_ptr(), references.len(), values.as_ptr())
        };
        accept("fmi2SetReal", status)
    }

    fn get_number(&self, storage: Storage, reference: u32) -> Answer<f64> {
        match storage {
            Storage::Float64 => self.get("fmi2GetReal", self.functions.get_real, reference),
            Storage::Int32 => {
                self.get("fmi2GetInteger", self.functions.get_integer, reference).map(f64::from)
            }
            Storage::Boolean => self
                .get("fmi2GetBoolean", self.functions.get_boolean, reference)
                .map(|value| f64::from(u8::from(value != FMI2_FALSE))),
            _ => Err(Refusal::WrongStorage),
        }
    }

    fn set_number(&mut self, storage: Storage, reference: u32, value: f64) -> Answer {
        match storage {
            Storage::Float64 => self.set("fmi2SetReal", self.functions.set_real, reference, value),
            Storage::Int32 => {
                let value = i32::exactly_from(value).ok_or(Refusal::NotExact { value, target: storage })?;
                self.set("fmi2SetInteger", self.functions.set_integer, reference, value)
            }
            Storage::Boolean => {
                let value = fmi2Boolean::from(boolean_from(value)?);
                self.set("fmi2SetBoolean", self.functions.set_boolean, reference, value)
            }
            _ => Err(Refusal::WrongStorage),
        }
    }

    fn get_text(&self, reference: u32) -> Answer<String> {
        let mut text: fmi2String = ptr::null();
        // SAFETY: one reference, room for one pointer.
        let status = unsafe { (self.functions.get_string)(self.component, &reference, 1, &mut text) };
        // SAFETY: the FMU guarantees the string until its next call; it is copied at once.
        accept("fmi2GetString", status).map(|()| unsafe { text_of(text) })
    }

    fn set_text(&mut self, reference: u32, text: &CStr) -> Answer {
        self.set("fmi2SetString", self.functions.set_string, reference, text.as_ptr())
    }

    fn get_state(&mut self) -> Answer<*mut c_void> {
        let name = "fmi2GetFMUstate";
        let function = self.functions.get_state.ok_or(Refusal::Missing { function: name })?;
        // NULL asks the FMU to allocate.
        let mut state = ptr::null_mut();
        // SAFETY: room for one pointer.
        accept(name, unsafe { function(self.component, &mut state) }).map(|()| state)
    }

    fn set_state(&mut self, state: *mut c_void) -> Answer {
        let name = "fmi2SetFMUstate";
        let function = self.functions.set_state.ok_or(Refusal::Missing { function: name })?;
        // SAFETY: the state is this component's own, by the trait's contract.
        accept(name, unsafe { function(self.component, state) })
    }

    fn free_state(&mut self, mut state: *mut c_void) -> Answer {
        let name = "fmi2FreeFMUstate";
        let function = self.functions.free_state.ok_or(Refusal::Missing { function: name })?;
        // SAFETY: the state is this component's own, by the trait's contract.
        accept(name, unsafe { function(self.component, &mut state) })
    }

    fn serialise_state(&mut self, state: *mut c_void) -> Answer<Vec<u8>> {
        let name = "fmi2SerializedFMUstateSize";
        let function = self.functions.state_size.ok_or(Refusal::Missing { function: name })?;
        let mut size = 0;
        // SAFETY: the state is this component's own, by the trait's contract; room for the size.
        accept(name, unsafe { function(self.component, state, &mut size) })?;
        let name = "fmi2SerializeFMUstate";
        let function = self.functions.serialise_state.ok_or(Refusal::Missing { function: name })?;
        let mut bytes = vec![0; size];
        let target = bytes.as_mut_ptr().cast();
        // SAFETY: as above, and room for as many bytes as were asked for.
        accept(name, unsafe { function(self.component, state, target, size) })?;
        Ok(bytes)
    }

    fn deserialise_state(&mut self, bytes: &[u8]) -> Answer<*mut c_void> {
        let name = "fmi2DeSerializeFMUstate";
        let function = self.functions.deserialise_state.ok_or(Refusal::Missing { function: name })?;
        // NULL asks the FMU to allocate.
        let mut state = ptr::null_mut();
        let source = bytes.as_ptr().cast();
        // SAFETY: as many bytes as said, room for one pointer.
        accept(name, unsafe { function(self.component, source, bytes.len(), &mut state) }).map(|()| state)
    }
}
