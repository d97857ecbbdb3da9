//! Which function may be called when: the state descriptions of FMI 3.0.2, sections 2.3 (common), 3.2, 4.2 and 5.2.
//! Setting and getting are allowed per variable, too: see `access.rs`.

use crate::fmi::Function;
use crate::fmi::Phase::{
    self, ClockActivationMode, ClockUpdateMode, ConfigurationMode, ContinuousTimeMode, EventMode,
    InitializationMode, Instantiated, IntermediateUpdateMode, ReconfigurationMode, StepMode, Terminated,
};

/// Super state "FMU State Settable".
const SETTABLE: &[Phase] = &[
    Instantiated,
    InitializationMode,
    ConfigurationMode,
    ReconfigurationMode,
    EventMode,
    ContinuousTimeMode,
    StepMode,
    ClockActivationMode,
    Terminated,
];
/// The same, and in the importer's callbacks within a step and an activation. Those may end by an exception or a jump,
/// after which the importer has but these ways to an instance that it can use: the standard, which knows no exceptions,
/// leaves none.
const SETTABLE_ANEW: &[Phase] = &[
    Instantiated,
    InitializationMode,
    ConfigurationMode,
    ReconfigurationMode,
    EventMode,
    ContinuousTimeMode,
    StepMode,
    ClockActivationMode,
    IntermediateUpdateMode,
    ClockUpdateMode,
    Terminated,
];
const READABLE: &[Phase] = &[
    Instantiated,
    InitializationMode,
    ConfigurationMode,
    ReconfigurationMode,
    EventMode,
    ContinuousTimeMode,
    StepMode,
    ClockActivationMode,
    IntermediateUpdateMode,
    Terminated,
];
const WRITABLE: &[Phase] = &[
    Instantiated,
    InitializationMode,
    ConfigurationMode,
    ReconfigurationMode,
    EventMode,
    ContinuousTimeMode,
    StepMode,
    ClockActivationMode,
    IntermediateUpdateMode,
];
const WRITABLE_DISCRETE: &[Phase] = &[
    Instantiated,
    InitializationMode,
    ConfigurationMode,
    ReconfigurationMode,
    EventMode,
    StepMode,
    ClockActivationMode,
];
const INITIALIZED: &[Phase] = &[EventMode, ContinuousTimeMode, StepMode, ClockActivationMode];
/// Clocks tick in Event Mode and around their activation only, never in Step Mode (section 2.2.8.2, table of clock
/// types).
const CLOCKED: &[Phase] = &[EventMode, ClockUpdateMode];
/// Of fixed clocks (sections 2.2.8.2 and 2.3.5).
const INTERVAL_READABLE: &[Phase] = &[InitializationMode, EventMode];
const EVALUABLE: &[Phase] = &[InitializationMode, EventMode, ContinuousTimeMode, Terminated];
const DIFFERENTIABLE: &[Phase] = &[InitializationMode, EventMode, ContinuousTimeMode, StepMode, Terminated];

pub const SET_DEBUG_LOGGING: Function = Function::new(
    "fmi3SetDebugLogging",
    &[
        Instantiated,
        InitializationMode,
        ConfigurationMode,
        ReconfigurationMode,
        EventMode,
        ContinuousTimeMode,
        StepMode,
        ClockActivationMode,
        ClockUpdateMode,
        IntermediateUpdateMode,
        Terminated,
    ],
);
pub const ENTER_INITIALIZATION_MODE: Function = Function::new("fmi3EnterInitializationMode", &[Instantiated]);
pub const EXIT_INITIALIZATION_MODE: Function =
    Function::new("fmi3ExitInitializationMode", &[InitializationMode]);
pub const ENTER_EVENT_MODE: Function = Function::new("fmi3EnterEventMode", &[ContinuousTimeMode, StepMode]);
pub const TERMINATE: Function = Function::new("fmi3Terminate", INITIALIZED);
pub const RESET: Function = Function::new("fmi3Reset", SETTABLE_ANEW);

pub const GET_FLOAT32: Function = Function::new("fmi3GetFloat32", READABLE);
pub const GET_FLOAT64: Function = Function::new("fmi3GetFloat64", READABLE);
pub const GET_INT8: Function = Function::new("fmi3GetInt8", READABLE);
pub const GET_UINT8: Function = Function::new("fmi3GetUInt8", READABLE);
pub const GET_INT16: Function = Function::new("fmi3GetInt16", READABLE);
pub const GET_UINT16: Function = Function::new("fmi3GetUInt16", READABLE);
pub const GET_INT32: Function = Function::new("fmi3GetInt32", READABLE);
pub const GET_UINT32: Function = Function::new("fmi3GetUInt32", READABLE);
pub const GET_INT64: Function = Function::new("fmi3GetInt64", READABLE);
pub const GET_UINT64: Function = Function::new("fmi3GetUInt64", READABLE);
pub const GET_BOOLEAN: Function = Function::new("fmi3GetBoolean", READABLE);
pub const GET_STRING: Function = Function::new("fmi3GetString", READABLE);
pub const GET_BINARY: Function = Function::new("fmi3GetBinary", READABLE);
pub const GET_CLOCK: Function = Function::new("fmi3GetClock", CLOCKED);
pub const SET_FLOAT32: Function = Function::new("fmi3SetFloat32", WRITABLE);
pub const SET_FLOAT64: Function = Function::new("fmi3SetFloat64", WRITABLE);
pub const SET_INT8: Function = Function::new("fmi3SetInt8", WRITABLE_DISCRETE);
pub const SET_UINT8: Function = Function::new("fmi3SetUInt8", WRITABLE_DISCRETE);
pub const SET_INT16: Function = Function::new("fmi3SetInt16", WRITABLE_DISCRETE);
pub const SET_UINT16: Function = Function::new("fmi3SetUInt16", WRITABLE_DISCRETE);
pub const SET_INT32: Function = Function::new("fmi3SetInt32", WRITABLE_DISCRETE);
pub const SET_UINT32: Function = Function::new("fmi3SetUInt32", WRITABLE_DISCRETE);
pub const SET_INT64: Function = Function::new("fmi3SetInt64", WRITABLE_DISCRETE);
pub const SET_UINT64: Function = Function::new("fmi3SetUInt64", WRITABLE_DISCRETE);
pub const SET_BOOLEAN: Function = Function::new("fmi3SetBoolean", WRITABLE_DISCRETE);
pub const SET_STRING: Function = Function::new("fmi3SetString", WRITABLE_DISCRETE);
pub const SET_BINARY: Function = Function::new("fmi3SetBinary", WRITABLE_DISCRETE);
pub const SET_CLOCK: Function = Function::new("fmi3SetClock", &[EventMode]);

pub const GET_NUMBER_OF_VARIABLE_DEPENDENCIES: Function =
    Function::new("fmi3GetNumberOfVariableDependencies", SETTABLE);
pub const GET_VARIABLE_DEPENDENCIES: Function = Function::new("fmi3GetVariableDependencies", SETTABLE);
pub const GET_FMU_STATE: Function = Function::new("fmi3GetFMUState", SETTABLE);
pub const SET_FMU_STATE: Function = Function::new("fmi3SetFMUState", SETTABLE_ANEW);
pub const FREE_FMU_STATE: Function = Function::new("fmi3FreeFMUState", SETTABLE);
pub const SERIALIZED_FMU_STATE_SIZE: Function = Function::new("fmi3SerializedFMUStateSize", SETTABLE);
pub const SERIALIZE_FMU_STATE: Function = Function::new("fmi3SerializeFMUState", SETTABLE);
pub const DESERIALIZE_FMU_STATE: Function = Function::new("fmi3DeserializeFMUState", SETTABLE);
pub const GET_DIRECTIONAL_DERIVATIVE: Function =
    Function::new("fmi3GetDirectionalDerivative", DIFFERENTIABLE);
pub const GET_ADJOINT_DERIVATIVE: Function = Function::new("fmi3GetAdjointDerivative", DIFFERENTIABLE);

pub const ENTER_CONFIGURATION_MODE: Function =
    Function::new("fmi3EnterConfigurationMode", &[Instantiated, EventMode, StepMode, ClockActivationMode]);
pub const EXIT_CONFIGURATION_MODE: Function =
    Function::new("fmi3ExitConfigurationMode", &[ConfigurationMode, ReconfigurationMode]);
pub const GET_INTERVAL_DECIMAL: Function = Function::new("fmi3GetIntervalDecimal", INTERVAL_READABLE);
pub const GET_INTERVAL_FRACTION: Function = Function::new("fmi3GetIntervalFraction", INTERVAL_READABLE);
pub const GET_SHIFT_DECIMAL: Function = Function::new("fmi3GetShiftDecimal", &[InitializationMode]);
pub const GET_SHIFT_FRACTION: Function = Function::new("fmi3GetShiftFraction", &[InitializationMode]);
/// Of fixed clocks in Initialization Mode only (section 2.2.8.2, table of clock types).
pub const SET_INTERVAL_DECIMAL: Function = Function::new("fmi3SetIntervalDecimal", &[InitializationMode]);
pub const SET_INTERVAL_FRACTION: Function = Function::new("fmi3SetIntervalFraction", &[InitializationMode]);
pub const SET_SHIFT_DECIMAL: Function = Function::new("fmi3SetShiftDecimal", &[InitializationMode]);
pub const SET_SHIFT_FRACTION: Function = Function::new("fmi3SetShiftFraction", &[InitializationMode]);
pub const EVALUATE_DISCRETE_STATES: Function = Function::new("fmi3EvaluateDiscreteStates", &[EventMode]);
pub const UPDATE_DISCRETE_STATES: Function = Function::new("fmi3UpdateDiscreteStates", &[EventMode]);

pub const ENTER_CONTINUOUS_TIME_MODE: Function = Function::new("fmi3EnterContinuousTimeMode", &[EventMode]);
pub const COMPLETED_INTEGRATOR_STEP: Function =
    Function::new("fmi3CompletedIntegratorStep", &[ContinuousTimeMode]);
pub const SET_TIME: Function = Function::new("fmi3SetTime", &[ContinuousTimeMode]);
pub const SET_CONTINUOUS_STATES: Function = Function::new("fmi3SetContinuousStates", &[ContinuousTimeMode]);
pub const GET_CONTINUOUS_STATE_DERIVATIVES: Function =
    Function::new("fmi3GetContinuousStateDerivatives", EVALUABLE);
pub const GET_EVENT_INDICATORS: Function = Function::new("fmi3GetEventIndicators", EVALUABLE);
pub const GET_CONTINUOUS_STATES: Function = Function::new("fmi3GetContinuousStates", EVALUABLE);
pub const GET_NOMINALS_OF_CONTINUOUS_STATES: Function =
    Function::new("fmi3GetNominalsOfContinuousStates", EVALUABLE);
pub const GET_NUMBER_OF_EVENT_INDICATORS: Function =
    Function::new("fmi3GetNumberOfEventIndicators", READABLE);
pub const GET_NUMBER_OF_CONTINUOUS_STATES: Function =
    Function::new("fmi3GetNumberOfContinuousStates", READABLE);

pub const ENTER_STEP_MODE: Function = Function::new("fmi3EnterStepMode", &[EventMode]);
pub const GET_OUTPUT_DERIVATIVES: Function =
    Function::new("fmi3GetOutputDerivatives", &[StepMode, IntermediateUpdateMode, Terminated]);
pub const DO_STEP: Function = Function::new("fmi3DoStep", &[StepMode]);
/// The importer has returned from the callback within a step.
pub const RETURN_FROM_INTERMEDIATE_UPDATE: Function =
    Function::after_callback("fmi3DoStep", &[IntermediateUpdateMode]);
/// The importer has returned from the callback within an activation.
pub const RETURN_FROM_CLOCK_UPDATE: Function =
    Function::after_callback("fmi3ActivateModelPartition", &[ClockUpdateMode]);
pub const ACTIVATE_MODEL_PARTITION: Function =
    Function::new("fmi3ActivateModelPartition", &[ClockActivationMode]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_neither_tick_nor_change_in_step_mode() {
        // Section 4.2: "During Step Mode, clocked variables can not be set or get".
        for function in [GET_CLOCK, SET_CLOCK, GET_INTERVAL_DECIMAL, SET_SHIFT_FRACTION] {
            assert!(!function.is_allowed_in(StepMode), "{}", function.name);
        }
        assert!(GET_CLOCK.is_allowed_in(EventMode) && !GET_CLOCK.is_allowed_in(InitializationMode));
        assert!(GET_SHIFT_DECIMAL.is_allowed_in(InitializationMode));
    }
}
