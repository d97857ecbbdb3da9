//! FMI 2.0: the C functions of one instance.

use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::ptr::{self, NonNull};
use std::sync::Arc;

use crate::fmi::fmi2::types::*;

use super::component::{Answer, Component, Number, Refusal, accept, boolean_from};
use super::description::Storage;
use super::error::Result;
use super::journal::{Journal, text_of};
use super::library::LoadedLibrary;

type OfComponent = unsafe extern "C" fn(fmi2Component) -> fmi2Status;
type Get<T> = unsafe extern "C" fn(fmi2Component, *const fmi2ValueReference, usize, *mut T) -> fmi2Status;
type Set<T> = unsafe extern "C" fn(fmi2Component, *const fmi2ValueReference, usize, *const T) -> fmi2Status;
type Instantiate = unsafe extern "C" fn(
    fmi2String,
    fmi2Type,
    fmi2String,
    fmi2String,
    *const fmi2CallbackFunctions,
    fmi2Boolean,
    fmi2Boolean,
) -> fmi2Component;
type SetupExperiment =
    unsafe extern "C" fn(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real) -> fmi2Status;
type DoStep = unsafe extern "C" fn(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean) -> fmi2Status;
type StateByPointer = unsafe extern "C" fn(fmi2Component, *mut fmi2FMUstate) -> fmi2Status;
type StateByValue = unsafe extern "C" fn(fmi2Component, fmi2FMUstate) -> fmi2Status;

/// The functions a co-simulation client of FMI 2.0 calls.
#[derive(Clone, Copy)]
pub(super) struct Functions {
    instantiate: Instantiate,
    free_instance: unsafe extern "C" fn(fmi2Component),
    setup_experiment: SetupExperiment,
    enter_initialisation: OfComponent,
    exit_initialisation: OfComponent,
    terminate: OfComponent,
    reset: OfComponent,
    do_step: DoStep,
    get_real: Get<fmi2Real>,
    set_real: Set<fmi2Real>,
    get_integer: Get<fmi2Integer>,
    set_integer: Set<fmi2Integer>,
    get_boolean: Get<fmi2Boolean>,
    set_boolean: Set<fmi2Boolean>,
    get_string: Get<fmi2String>,
    set_string: Set<fmi2String>,
    get_state: Option<StateByPointer>,
    set_state: Option<StateByValue>,
    free_state: Option<StateByPointer>,
}

impl Functions {
    pub(super) fn resolve(library: &LoadedLibrary) -> Result<Self> {
        library.check_version("fmi2GetVersion", "2.0")?;
        // SAFETY: each field has the type that fmi2FunctionTypes.h gives to the function named beside it.
        unsafe {
            Ok(Self {
                instantiate: library.required("fmi2Instantiate")?,
                free_instance: library.required("fmi2FreeInstance")?,
                setup_experiment: library.required("fmi2SetupExperiment")?,
                enter_initialisation: library.required("fmi2EnterInitializationMode")?,
                exit_initialisation: library.required("fmi2ExitInitializationMode")?,
                terminate: library.required("fmi2Terminate")?,
                reset: library.required("fmi2Reset")?,
                do_step: library.required("fmi2DoStep")?,
                get_real: library.required("fmi2GetReal")?,
                set_real: library.required("fmi2SetReal")?,
                get_integer: library.required("fmi2GetInteger")?,
                set_integer: library.required("fmi2SetInteger")?,
                get_boolean: library.required("fmi2GetBoolean")?,
                set_boolean: library.required("fmi2SetBoolean")?,
                get_string: library.required("fmi2GetString")?,
                set_string: library.required("fmi2SetString")?,
                get_state: library.optional("fmi2GetFMUstate"),
                set_state: library.optional("fmi2SetFMUstate"),
                free_state: library.optional("fmi2FreeFMUstate"),
            })
        }
    }

    /// A new co-simulation instance, `None` if the FMU refuses.
    pub(super) fn instantiate(
        self,
        name: &CStr,
        token: &CStr,
        resource_location: &CStr,
        logging: bool,
        journal: Arc<Journal>,
    ) -> Option<FmiTwo> {
        let callbacks = Box::new(fmi2CallbackFunctions {
            logger: Some(variadic_logger()),
            allocate_memory: Some(calloc),
            free_memory: Some(free),
            step_finished: None,
            component_environment: Arc::as_ptr(&journal).cast_mut().cast(),
        });
        // A raw pointer from here on: the FMU keeps it and reads through it until it is freed.
        let callbacks = Callbacks(NonNull::from(Box::leak(callbacks)));
        // SAFETY: all strings end with NUL and outlive the call; the callbacks outlive the instance.
        let component = unsafe {
            (self.instantiate)(
                name.as_ptr(),
                FMI2_CO_SIMULATION,
                token.as_ptr(),
                resource_location.as_ptr(),
                callbacks.0.as_ptr(),
                FMI2_FALSE,
                fmi2Boolean::from(logging),
            )
        };
        (!component.is_null()).then_some(FmiTwo {
            component,
            functions: self,
            _callbacks: callbacks,
            _journal: journal,
        })
    }
}

/// The callback table of one instance, which must not move.
struct Callbacks(NonNull<fmi2CallbackFunctions>);

impl Drop for Callbacks {
    fn drop(&mut self) {
        // SAFETY: the pointer came from `Box::leak`, and the instance that used it is gone.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

unsafe extern "C" {
    // The C library's own, which the standard suggests and every program of the standard library links.
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(object: *mut c_void);
}

/// Collects a message; the arguments after the format string stay unread.
unsafe extern "C" fn log(
    environment: fmi2ComponentEnvironment,
    _instance_name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
) {
    // SAFETY: the environment is the journal of a living instance, the strings are C strings or NULL.
    unsafe {
        Journal::append(environment.cast_const().cast(), status, category, message, |text| {
            text.replace("%%", "%")
        });
    }
}

fn variadic_logger() -> fmi2CallbackLogger {
    type FixedArguments =
        unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String);
    // SAFETY: stable Rust cannot define a variadic function. On the C ABIs of the supported platforms (System V
    // x86-64, Windows x64, AAPCS64 and Apple's variant of it) the named arguments of a variadic call, all of them
    // pointers and one int here, lie where those of an ordinary call lie, and the caller cleans up the rest.
    // `log` reads the named arguments only, so it cannot tell the difference.
    unsafe { transmute::<FixedArguments, fmi2CallbackLogger>(log) }
}

/// One co-simulation instance of FMI 2.0.
pub(super) struct FmiTwo {
    component: fmi2Component,
    functions: Functions,
    // Both are only there to outlive the component that points to them.
    _callbacks: Callbacks,
    _journal: Arc<Journal>,
}

// SAFETY: the standard binds an instance to no thread, it only forbids concurrent calls; `FmiTwo` is not `Sync`.
// The journal, the one thing shared with the FMU's own threads, is behind a lock.
unsafe impl Send for FmiTwo {}

impl FmiTwo {
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
}
