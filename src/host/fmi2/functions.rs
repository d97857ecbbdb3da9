//! The C functions of FMI 2.0 that a co-simulation client calls.

use crate::fmi::fmi2::types::*;

use crate::host::error::Result;
use crate::host::library::LoadedLibrary;

pub(super) type OfComponent = unsafe extern "C" fn(fmi2Component) -> fmi2Status;
pub(super) type Get<T> =
    unsafe extern "C" fn(fmi2Component, *const fmi2ValueReference, usize, *mut T) -> fmi2Status;
pub(super) type Set<T> =
    unsafe extern "C" fn(fmi2Component, *const fmi2ValueReference, usize, *const T) -> fmi2Status;
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
type StateSize = unsafe extern "C" fn(fmi2Component, fmi2FMUstate, *mut usize) -> fmi2Status;
type SerialiseState = unsafe extern "C" fn(fmi2Component, fmi2FMUstate, *mut fmi2Byte, usize) -> fmi2Status;
type DeserialiseState =
    unsafe extern "C" fn(fmi2Component, *const fmi2Byte, usize, *mut fmi2FMUstate) -> fmi2Status;

/// The functions a co-simulation client of FMI 2.0 calls.
#[derive(Clone, Copy)]
pub(in crate::host) struct Functions {
    pub(super) instantiate: Instantiate,
    pub(super) free_instance: unsafe extern "C" fn(fmi2Component),
    pub(super) setup_experiment: SetupExperiment,
    pub(super) enter_initialisation: OfComponent,
    pub(super) exit_initialisation: OfComponent,
    pub(super) terminate: OfComponent,
    pub(super) reset: OfComponent,
    pub(super) do_step: DoStep,
    pub(super) get_real: Get<fmi2Real>,
    pub(super) set_real: Set<fmi2Real>,
    pub(super) get_integer: Get<fmi2Integer>,
    pub(super) set_integer: Set<fmi2Integer>,
    pub(super) get_boolean: Get<fmi2Boolean>,
    pub(super) set_boolean: Set<fmi2Boolean>,
    pub(super) get_string: Get<fmi2String>,
    pub(super) set_string: Set<fmi2String>,
    pub(super) get_state: Option<StateByPointer>,
    pub(super) set_state: Option<StateByValue>,
    pub(super) free_state: Option<StateByPointer>,
    pub(super) state_size: Option<StateSize>,
    pub(super) serialise_state: Option<SerialiseState>,
    pub(super) deserialise_state: Option<DeserialiseState>,
}

impl Functions {
    pub(in crate::host) fn resolve(library: &LoadedLibrary) -> Result<Self> {
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
                state_size: library.optional("fmi2SerializedFMUstateSize"),
                serialise_state: library.optional("fmi2SerializeFMUstate"),
                deserialise_state: library.optional("fmi2DeSerializeFMUstate"),
            })
        }
    }
}
