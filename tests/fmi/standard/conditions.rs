//! Conditions of the tables: on variables, arguments and what was called before.

use super::{Causality, Variability, Variable};

/// When a call is allowed in a state; the marks are those of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    Never,
    Always,
    /// By the list of a super state of FMI 3.0 alone.
    SuperState,
    /// FMI 2.0, condition 1: variability is not constant and initial is exact or approx.
    Initial,
    /// FMI 2.0, condition 2: an output or an initial unknown.
    InitialUnknownOrOutput,
    /// FMI 2.0, condition 3: initial is exact, or an input. FMI 3.0.2, sections 2.3.2 and 2.3.3, which has inputs in
    /// Instantiated, too. No variable of these models has initial = approx.
    InitialOrInput,
    /// FMI 2.0, conditions 4 and 6; FMI 3.0.2, sections 4.2.1 and 5.2.1: an input or a tunable parameter.
    InputOrTunable,
    /// FMI 3.0.2, section 2.3.5: an input, a tunable parameter or a continuous state that does not jump.
    InputTunableOrLastingState,
    /// FMI 2.0, condition 5; FMI 3.0.2, section 3.2.1: a continuous input or a continuous state.
    ContinuousInputOrState,
    /// FMI 2.0, condition 8: of models without continuous time, which no model of model exchange is here.
    PureDiscreteTime,
    /// FMI 2.0.5, section 2.1.6: after fmi2SetupExperiment.
    AfterSetup,
    /// FMI 3.0.2, section 4.2.2: an input that may be set within steps and was registered for it.
    RegisteredInput,
    /// FMI 3.0.2, section 4.2.2: a variable that may be accessed within steps and was registered for it.
    Registered,
    /// FMI 3.0.2, section 2.3.2: a variable that has a start value.
    HasStart,
    /// FMI 3.0.2, section 2.2.8.3: a clock, which is bound to none or to one that is active.
    ReadableClock,
    /// FMI 3.0.2, section 2.3.5: an input clock.
    InputClock,
    /// FMI 3.0.2, sections 5.2.1 and 5.2.2: of clocks that are tunable, changing or countdown, which none is here.
    ChangingClock,
    /// FMI 3.0.2, section 2.3.5: after the last event iteration that fmi3UpdateDiscreteStates asked for.
    SettledEvent,
    /// FMI 3.0.2, section 4.2.1: of instances that were made with eventModeUsed.
    EventModeUsed,
}

impl Condition {
    pub fn from_mark(mark: &str) -> Self {
        match mark {
            "." => Self::Never,
            "x" => Self::Always,
            "s" => Self::SuperState,
            "1" => Self::Initial,
            "2" => Self::InitialUnknownOrOutput,
            "3" | "a" | "b" => Self::InitialOrInput,
            "4" | "6" | "e" | "g" => Self::InputOrTunable,
            "c" => Self::InputTunableOrLastingState,
            "5" | "d" => Self::ContinuousInputOrState,
            "8" => Self::PureDiscreteTime,
            "9" => Self::AfterSetup,
            "f" => Self::RegisteredInput,
            "i" => Self::Registered,
            "h" => Self::HasStart,
            "k" => Self::ReadableClock,
            "l" => Self::InputClock,
            "m" => Self::ChangingClock,
            "u" => Self::SettledEvent,
            "v" => Self::EventModeUsed,
            _ => panic!("unknown mark {mark}"),
        }
    }

    /// Whether the condition holds for a variable; `is_registered` tells of intermediate update, `is_active` of the
    /// clocks that the variable is bound to.
    pub fn allows(self, variable: &Variable, is_registered: bool, is_active: bool) -> bool {
        let is_input = variable.causality == Causality::Input;
        let is_exact = variable.is_initially_exact;
        let is_tunable =
            variable.causality == Causality::Parameter && variable.variability == Variability::Tunable;
        let is_continuous = variable.variability == Variability::Continuous;
        match self {
            Self::Never | Self::PureDiscreteTime | Self::ChangingClock => false,
            Self::Always | Self::SuperState | Self::AfterSetup | Self::SettledEvent | Self::EventModeUsed => {
                true
            }
            Self::Initial => is_exact,
            Self::InitialUnknownOrOutput => {
                variable.is_initial_unknown || variable.causality == Causality::Output
            }
            Self::InitialOrInput => is_exact || is_input,
            Self::InputOrTunable => is_input || is_tunable,
            Self::InputTunableOrLastingState => {
                is_input || is_tunable || (variable.is_state && !variable.may_jump)
            }
            Self::ContinuousInputOrState => (is_input && is_continuous) || variable.is_state,
            Self::RegisteredInput => is_input && is_continuous && variable.may_be_updated && is_registered,
            Self::Registered => variable.may_be_updated && is_registered,
            Self::HasStart => variable.start.is_some(),
            Self::ReadableClock => variable.clocks.is_empty() || is_active,
            Self::InputClock => is_input,
        }
    }
}
