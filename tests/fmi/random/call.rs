//! Calls with their arguments.

use super::super::harness::Standard;

/// One call; functions are named as in the standard that is spoken.
#[derive(Clone, Debug)]
pub enum Call {
    Logging {
        on: bool,
        categories: Vec<Category>,
        is_null: bool,
    },
    /// FMI 2.0 only.
    Setup(Experiment),
    /// The experiment is an argument of FMI 3.0 only.
    EnterInitialization(Experiment),
    /// A function that takes nothing but the instance.
    Plain(&'static str),
    Get {
        function: &'static str,
        references: Vec<u32>,
        room: usize,
        is_null: bool,
    },
    Set {
        function: &'static str,
        references: Vec<u32>,
        values: Vec<f64>,
        room: usize,
        is_null: bool,
    },
    UpdateDiscreteStates {
        is_null: bool,
    },
    CompletedStep {
        is_null: bool,
    },
    SetTime(f64),
    SetStates {
        states: Vec<f64>,
        is_null: bool,
    },
    GetVector {
        function: &'static str,
        length: usize,
        is_null: bool,
    },
    Count(&'static str),
    Step {
        point: f64,
        size: f64,
        is_final: bool,
    },
    Activate {
        clock: u32,
        time: f64,
    },
    GetClocks {
        references: Vec<u32>,
    },
    SetClocks {
        references: Vec<u32>,
        values: Vec<u8>,
    },
    /// Intervals and shifts of clocks.
    Timing {
        function: &'static str,
        references: Vec<u32>,
    },
    /// Directional or adjoint.
    Partial {
        function: &'static str,
        unknowns: Vec<u32>,
        knowns: Vec<u32>,
        seed: Vec<f64>,
    },
    SetSlopes {
        references: Vec<u32>,
        orders: Vec<i32>,
        values: Vec<f64>,
    },
    GetSlopes {
        references: Vec<u32>,
        orders: Vec<i32>,
    },
    /// FMI 2.0 only.
    Status {
        function: &'static str,
        kind: i32,
    },
    Dependencies(&'static str),
    /// Into a place for saved states, over what is there.
    Save {
        slot: usize,
    },
    /// From a place, which may be empty.
    Restore {
        slot: usize,
    },
    Free {
        slot: usize,
    },
    Size {
        slot: usize,
    },
    /// To bytes that are kept; with room that lacks some of them.
    Serialise {
        slot: usize,
        shortage: usize,
    },
    /// Bytes that were kept, or that came from elsewhere, into a place.
    Deserialise {
        slot: usize,
        source: usize,
        damage: Damage,
    },
}

/// A name of a log category.
#[derive(Clone, Copy, Debug)]
pub enum Category {
    Declared(&'static core::ffi::CStr),
    Unknown,
    Null,
}

#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    pub start: f64,
    pub stop: Option<f64>,
    pub tolerance: Option<f64>,
}

/// What is done to the bytes of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damage {
    None,
    /// One bit is flipped.
    Flip {
        bit: usize,
    },
    Cut {
        length: usize,
    },
    /// One byte of the contents is replaced and the checksum made to fit, as only an attacker would.
    Forge {
        place: usize,
        value: u8,
    },
}

impl Call {
    /// The function of the standard.
    pub fn function(&self, standard: Standard) -> &'static str {
        let both = |fmi2, fmi3| if standard == Standard::Fmi2 { fmi2 } else { fmi3 };
        match self {
            Self::Logging { .. } => both("fmi2SetDebugLogging", "fmi3SetDebugLogging"),
            Self::Setup(_) => "fmi2SetupExperiment",
            Self::EnterInitialization(_) => {
                both("fmi2EnterInitializationMode", "fmi3EnterInitializationMode")
            }
            Self::Plain(function)
            | Self::Get { function, .. }
            | Self::Set { function, .. }
            | Self::GetVector { function, .. }
            | Self::Count(function)
            | Self::Timing { function, .. }
            | Self::Partial { function, .. }
            | Self::Status { function, .. }
            | Self::Dependencies(function) => function,
            Self::UpdateDiscreteStates { .. } => both("fmi2NewDiscreteStates", "fmi3UpdateDiscreteStates"),
            Self::CompletedStep { .. } => both("fmi2CompletedIntegratorStep", "fmi3CompletedIntegratorStep"),
            Self::SetTime(_) => both("fmi2SetTime", "fmi3SetTime"),
            Self::SetStates { .. } => both("fmi2SetContinuousStates", "fmi3SetContinuousStates"),
            Self::Step { .. } => both("fmi2DoStep", "fmi3DoStep"),
            Self::Activate { .. } => "fmi3ActivateModelPartition",
            Self::GetClocks { .. } => "fmi3GetClock",
            Self::SetClocks { .. } => "fmi3SetClock",
            Self::SetSlopes { .. } => "fmi2SetRealInputDerivatives",
            Self::GetSlopes { .. } => both("fmi2GetRealOutputDerivatives", "fmi3GetOutputDerivatives"),
            Self::Save { .. } => both("fmi2GetFMUstate", "fmi3GetFMUState"),
            Self::Restore { .. } => both("fmi2SetFMUstate", "fmi3SetFMUState"),
            Self::Free { .. } => both("fmi2FreeFMUstate", "fmi3FreeFMUState"),
            Self::Size { .. } => both("fmi2SerializedFMUstateSize", "fmi3SerializedFMUStateSize"),
            Self::Serialise { .. } => both("fmi2SerializeFMUstate", "fmi3SerializeFMUState"),
            Self::Deserialise { .. } => both("fmi2DeSerializeFMUstate", "fmi3DeserializeFMUState"),
        }
    }

    /// Whether the call is about saved states, which do not change the instance but for restoring one.
    pub fn is_about_states(&self) -> bool {
        matches!(
            self,
            Self::Save { .. }
                | Self::Restore { .. }
                | Self::Free { .. }
                | Self::Size { .. }
                | Self::Serialise { .. }
                | Self::Deserialise { .. }
        )
    }
}
