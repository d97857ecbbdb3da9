//! The C functions of FMI 3.0 that a co-simulation client calls.

use crate::fmi::fmi3::types::*;

use crate::host::error::Result;
use crate::host::library::LoadedLibrary;

pub(super) type OfInstance = unsafe extern "C" fn(fmi3Instance) -> fmi3Status;
pub(super) type Get<T> =
    unsafe extern "C" fn(fmi3Instance, *const fmi3ValueReference, usize, *mut T, usize) -> fmi3Status;
pub(super) type Set<T> =
    unsafe extern "C" fn(fmi3Instance, *const fmi3ValueReference, usize, *const T, usize) -> fmi3Status;
type InstantiateCoSimulation = unsafe extern "C" fn(
    fmi3String,
    fmi3String,
    fmi3String,
    fmi3Boolean,
    fmi3Boolean,
    fmi3Boolean,
    fmi3Boolean,
    *const fmi3ValueReference,
    usize,
    fmi3InstanceEnvironment,
    Option<fmi3LogMessageCallback>,
    Option<fmi3IntermediateUpdateCallback>,
) -> fmi3Instance;
type EnterInitialisation = unsafe extern "C" fn(
    fmi3Instance,
    fmi3Boolean,
    fmi3Float64,
    fmi3Float64,
    fmi3Boolean,
    fmi3Float64,
) -> fmi3Status;
type DoStep = unsafe extern "C" fn(
    fmi3Instance,
    fmi3Float64,
    fmi3Float64,
    fmi3Boolean,
    *mut fmi3Boolean,
    *mut fmi3Boolean,
    *mut fmi3Boolean,
    *mut fmi3Float64,
) -> fmi3Status;
type StateByPointer = unsafe extern "C" fn(fmi3Instance, *mut fmi3FMUState) -> fmi3Status;
type StateByValue = unsafe extern "C" fn(fmi3Instance, fmi3FMUState) -> fmi3Status;
type StateSize = unsafe extern "C" fn(fmi3Instance, fmi3FMUState, *mut usize) -> fmi3Status;
type SerialiseState = unsafe extern "C" fn(fmi3Instance, fmi3FMUState, *mut fmi3Byte, usize) -> fmi3Status;
type DeserialiseState =
    unsafe extern "C" fn(fmi3Instance, *const fmi3Byte, usize, *mut fmi3FMUState) -> fmi3Status;

/// The pair of functions for one type of value. Libraries often lack those of types they do not use.
#[derive(Clone, Copy)]
pub(super) struct Access<T> {
    pub(super) getter: &'static str,
    pub(super) get: Option<Get<T>>,
    pub(super) setter: &'static str,
    pub(super) set: Option<Set<T>>,
}

impl<T> Access<T> {
    /// # Safety
    /// The standard gives both functions values of the C type that corresponds to `T`.
    unsafe fn resolve(library: &LoadedLibrary, getter: &'static str, setter: &'static str) -> Self {
        // SAFETY: all getters and all setters of FMI 3.0 but those of binaries differ in the value type only.
        unsafe { Self { getter, get: library.optional(getter), setter, set: library.optional(setter) } }
    }
}

/// The functions a co-simulation client of FMI 3.0 calls.
#[derive(Clone, Copy)]
pub(in crate::host) struct Functions {
    pub(super) instantiate: InstantiateCoSimulation,
    pub(super) free_instance: unsafe extern "C" fn(fmi3Instance),
    pub(super) enter_initialisation: EnterInitialisation,
    pub(super) exit_initialisation: OfInstance,
    pub(super) terminate: OfInstance,
    pub(super) reset: OfInstance,
    pub(super) do_step: DoStep,
    pub(super) get_float64: Get<f64>,
    pub(super) set_float64: Set<f64>,
    pub(super) float32: Access<f32>,
    pub(super) int8: Access<i8>,
    pub(super) uint8: Access<u8>,
    pub(super) int16: Access<i16>,
    pub(super) uint16: Access<u16>,
    pub(super) int32: Access<i32>,
    pub(super) uint32: Access<u32>,
    pub(super) int64: Access<i64>,
    pub(super) uint64: Access<u64>,
    pub(super) boolean: Access<fmi3Boolean>,
    pub(super) string: Access<fmi3String>,
    pub(super) get_state: Option<StateByPointer>,
    pub(super) set_state: Option<StateByValue>,
    pub(super) free_state: Option<StateByPointer>,
    pub(super) state_size: Option<StateSize>,
    pub(super) serialise_state: Option<SerialiseState>,
    pub(super) deserialise_state: Option<DeserialiseState>,
}

impl Functions {
    pub(in crate::host) fn resolve(library: &LoadedLibrary) -> Result<Self> {
        library.check_version("fmi3GetVersion", "3.0")?;
        // SAFETY: each field has the type that fmi3FunctionTypes.h gives to the functions named beside it.
        unsafe {
            Ok(Self {
                instantiate: library.required("fmi3InstantiateCoSimulation")?,
                free_instance: library.required("fmi3FreeInstance")?,
                enter_initialisation: library.required("fmi3EnterInitializationMode")?,
                exit_initialisation: library.required("fmi3ExitInitializationMode")?,
                terminate: library.required("fmi3Terminate")?,
                reset: library.required("fmi3Reset")?,
                do_step: library.required("fmi3DoStep")?,
                get_float64: library.required("fmi3GetFloat64")?,
                set_float64: library.required("fmi3SetFloat64")?,
                float32: Access::resolve(library, "fmi3GetFloat32", "fmi3SetFloat32"),
                int8: Access::resolve(library, "fmi3GetInt8", "fmi3SetInt8"),
                uint8: Access::resolve(library, "fmi3GetUInt8", "fmi3SetUInt8"),
                int16: Access::resolve(library, "fmi3GetInt16", "fmi3SetInt16"),
                uint16: Access::resolve(library, "fmi3GetUInt16", "fmi3SetUInt16"),
                int32: Access::resolve(library, "fmi3GetInt32", "fmi3SetInt32"),
                uint32: Access::resolve(library, "fmi3GetUInt32", "fmi3SetUInt32"),
                int64: Access::resolve(library, "fmi3GetInt64", "fmi3SetInt64"),
                uint64: Access::resolve(library, "fmi3GetUInt64", "fmi3SetUInt64"),
                boolean: Access::resolve(library, "fmi3GetBoolean", "fmi3SetBoolean"),
                string: Access::resolve(library, "fmi3GetString", "fmi3SetString"),
                get_state: library.optional("fmi3GetFMUState"),
                set_state: library.optional("fmi3SetFMUState"),
                free_state: library.optional("fmi3FreeFMUState"),
                state_size: library.optional("fmi3SerializedFMUStateSize"),
                serialise_state: library.optional("fmi3SerializeFMUState"),
                deserialise_state: library.optional("fmi3DeserializeFMUState"),
            })
        }
    }
}
