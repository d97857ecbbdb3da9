//! What the texts of the two standards allow, transcribed by hand and independent of the library: which call in which
//! state (`fmi2_calls.csv`, `fmi3_calls.csv`), which variable ([`Condition`]), and where the library differs on purpose
//! (`deviations.toml`).

mod calls;
mod conditions;
mod deviations;
mod model_description;

pub use calls::Table;
pub use conditions::Condition;
pub use deviations::Deviations;
pub use model_description::{Causality, Kind, ModelDescription, Variability, Variable};

/// Interface types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Interface {
    ModelExchange,
    CoSimulation,
    ScheduledExecution,
}

/// States of the standards' state machines that an importer of these models can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum State {
    Instantiated,
    Initialization,
    Event,
    Continuous,
    /// FMI 2.0: stepComplete.
    Step,
    /// Within the callback of a step.
    Intermediate,
    /// Clock Activation Mode.
    Activation,
    /// Clock Update Mode, within the callback of an activation.
    Update,
    Terminated,
    /// FMI 2.0: after a call has returned Error. FMI 3.0 goes to Terminated then.
    Error,
}

impl Interface {
    const ALL: [(&str, Self); 3] =
        [("me", Self::ModelExchange), ("cs", Self::CoSimulation), ("se", Self::ScheduledExecution)];
}

impl State {
    const ALL: [(&str, Self); 10] = [
        ("instantiated", Self::Instantiated),
        ("initialization", Self::Initialization),
        ("event", Self::Event),
        ("continuous", Self::Continuous),
        ("step", Self::Step),
        ("intermediate", Self::Intermediate),
        ("activation", Self::Activation),
        ("update", Self::Update),
        ("terminated", Self::Terminated),
        ("error", Self::Error),
    ];

    /// Whether the importer is being called back.
    pub fn is_in_callback(self) -> bool {
        matches!(self, Self::Intermediate | Self::Update)
    }
}
