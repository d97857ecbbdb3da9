//! Which function may be called when: the tables of FMI 2.0.5, sections 3.2.3 (model exchange) and 4.2.4
//! (co-simulation). Setting and getting are allowed per variable, too: see `access.rs`.

use crate::fmi::Function;
use crate::fmi::Phase::{
    self, ContinuousTimeMode, EventMode, InitializationMode, Instantiated, StepCanceled, StepFailed,
    StepInProgress, StepMode, Terminated,
};

/// Everywhere but during a step and after a fatal error.
const AT_REST: &[Phase] = &[
    Instantiated,
    InitializationMode,
    EventMode,
    ContinuousTimeMode,
    StepMode,
    StepFailed,
    StepCanceled,
    Terminated,
];
const READABLE: &[Phase] =
    &[InitializationMode, EventMode, ContinuousTimeMode, StepMode, StepFailed, StepCanceled, Terminated];
const WRITABLE: &[Phase] = &[Instantiated, InitializationMode, EventMode, ContinuousTimeMode, StepMode];
const WRITABLE_DISCRETE: &[Phase] = &[Instantiated, InitializationMode, EventMode, StepMode];
const STATUS: &[Phase] = &[StepMode, StepInProgress, StepFailed, Terminated];
const EVALUABLE: &[Phase] = &[InitializationMode, EventMode, ContinuousTimeMode, Terminated];

pub const SET_DEBUG_LOGGING: Function = Function::new(
    "fmi2SetDebugLogging",
    &[
        Instantiated,
        InitializationMode,
        EventMode,
        ContinuousTimeMode,
        StepMode,
        StepInProgress,
        StepFailed,
        StepCanceled,
        Terminated,
    ],
);
pub const SETUP_EXPERIMENT: Function = Function::new("fmi2SetupExperiment", &[Instantiated]);
pub const ENTER_INITIALIZATION_MODE: Function = Function::new("fmi2EnterInitializationMode", &[Instantiated]);
pub const EXIT_INITIALIZATION_MODE: Function =
    Function::new("fmi2ExitInitializationMode", &[InitializationMode]);
pub const TERMINATE: Function =
    Function::new("fmi2Terminate", &[EventMode, ContinuousTimeMode, StepMode, StepFailed]);
pub const RESET: Function = Function::new("fmi2Reset", AT_REST);
pub const GET_REAL: Function = Function::new("fmi2GetReal", READABLE);
pub const GET_INTEGER: Function = Function::new("fmi2GetInteger", READABLE);
pub const GET_BOOLEAN: Function = Function::new("fmi2GetBoolean", READABLE);
pub const GET_STRING: Function = Function::new("fmi2GetString", READABLE);
pub const SET_REAL: Function = Function::new("fmi2SetReal", WRITABLE);
pub const SET_INTEGER: Function = Function::new("fmi2SetInteger", WRITABLE_DISCRETE);
pub const SET_BOOLEAN: Function = Function::new("fmi2SetBoolean", WRITABLE_DISCRETE);
pub const SET_STRING: Function = Function::new("fmi2SetString", WRITABLE_DISCRETE);
pub const GET_FMU_STATE: Function = Function::new("fmi2GetFMUstate", AT_REST);
pub const SET_FMU_STATE: Function = Function::new("fmi2SetFMUstate", AT_REST);
pub const FREE_FMU_STATE: Function = Function::new("fmi2FreeFMUstate", AT_REST);
pub const SERIALIZED_FMU_STATE_SIZE: Function = Function::new("fmi2SerializedFMUstateSize", AT_REST);
pub const SERIALIZE_FMU_STATE: Function = Function::new("fmi2SerializeFMUstate", AT_REST);
pub const DESERIALIZE_FMU_STATE: Function = Function::new("fmi2DeSerializeFMUstate", AT_REST);
pub const GET_DIRECTIONAL_DERIVATIVE: Function = Function::new("fmi2GetDirectionalDerivative", READABLE);

pub const ENTER_EVENT_MODE: Function = Function::new("fmi2EnterEventMode", &[EventMode, ContinuousTimeMode]);
pub const NEW_DISCRETE_STATES: Function = Function::new("fmi2NewDiscreteStates", &[EventMode]);
pub const ENTER_CONTINUOUS_TIME_MODE: Function = Function::new("fmi2EnterContinuousTimeMode", &[EventMode]);
pub const COMPLETED_INTEGRATOR_STEP: Function =
    Function::new("fmi2CompletedIntegratorStep", &[ContinuousTimeMode]);
/// In event mode for pure discrete-time models only (condition 8), which no model is.
pub const SET_TIME: Function = Function::new("fmi2SetTime", &[ContinuousTimeMode]);
pub const SET_CONTINUOUS_STATES: Function = Function::new("fmi2SetContinuousStates", &[ContinuousTimeMode]);
pub const GET_DERIVATIVES: Function = Function::new("fmi2GetDerivatives", EVALUABLE);
pub const GET_EVENT_INDICATORS: Function = Function::new("fmi2GetEventIndicators", EVALUABLE);
pub const GET_CONTINUOUS_STATES: Function = Function::new("fmi2GetContinuousStates", EVALUABLE);
pub const GET_NOMINALS_OF_CONTINUOUS_STATES: Function = Function::new(
    "fmi2GetNominalsOfContinuousStates",
    &[Instantiated, InitializationMode, EventMode, ContinuousTimeMode, Terminated],
);

pub const SET_REAL_INPUT_DERIVATIVES: Function =
    Function::new("fmi2SetRealInputDerivatives", &[Instantiated, InitializationMode, StepMode]);
pub const GET_REAL_OUTPUT_DERIVATIVES: Function =
    Function::new("fmi2GetRealOutputDerivatives", &[StepMode, StepFailed, StepCanceled, Terminated]);
pub const DO_STEP: Function = Function::new("fmi2DoStep", &[StepMode]);
pub const CANCEL_STEP: Function = Function::new("fmi2CancelStep", &[StepInProgress]);
pub const GET_STATUS: Function = Function::new("fmi2GetStatus", STATUS);
pub const GET_REAL_STATUS: Function = Function::new("fmi2GetRealStatus", STATUS);
pub const GET_INTEGER_STATUS: Function = Function::new("fmi2GetIntegerStatus", STATUS);
pub const GET_BOOLEAN_STATUS: Function = Function::new("fmi2GetBooleanStatus", STATUS);
pub const GET_STRING_STATUS: Function = Function::new("fmi2GetStringStatus", STATUS);
