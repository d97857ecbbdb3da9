//! Phases of an instance's life and which function may be called in which.

use serde::{Deserialize, Serialize};

/// States of the standards' state machines; those of FMI 2.0 and FMI 3.0 that mean the same are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u16)]
pub enum Phase {
    Instantiated = 1 << 0,
    InitializationMode = 1 << 1,
    /// FMI 2.0 "stepComplete", FMI 3.0 "Step Mode".
    StepMode = 1 << 2,
    StepInProgress = 1 << 3,
    StepFailed = 1 << 4,
    StepCanceled = 1 << 5,
    EventMode = 1 << 6,
    ContinuousTimeMode = 1 << 7,
    ConfigurationMode = 1 << 8,
    ReconfigurationMode = 1 << 9,
    IntermediateUpdateMode = 1 << 10,
    ClockActivationMode = 1 << 11,
    Terminated = 1 << 12,
    /// Within the callback `fmi3ClockUpdateCallback`.
    ClockUpdateMode = 1 << 14,
    /// After a panic: only to be freed.
    Fatal = 1 << 13,
}

impl Phase {
    /// Start values may still be set.
    #[inline]
    pub const fn is_before_first_step(self) -> bool {
        matches!(self, Self::Instantiated | Self::InitializationMode)
    }

    /// Name for log messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::InitializationMode => "initialization mode",
            Self::StepMode => "step mode",
            Self::StepInProgress => "step in progress",
            Self::StepFailed => "step failed",
            Self::StepCanceled => "step canceled",
            Self::EventMode => "event mode",
            Self::ContinuousTimeMode => "continuous-time mode",
            Self::ConfigurationMode => "configuration mode",
            Self::ReconfigurationMode => "reconfiguration mode",
            Self::IntermediateUpdateMode => "intermediate update mode",
            Self::ClockActivationMode => "clock activation mode",
            Self::ClockUpdateMode => "clock update mode",
            Self::Terminated => "terminated",
            Self::Fatal => "fatal error",
        }
    }
}

/// A function of a standard and the phases in which it may be called.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    pub name: &'static str,
    phases: u16,
    /// The importer has called it and has come back to it from a callback.
    pub is_back_from_callback: bool,
}

impl Function {
    pub const fn new(name: &'static str, phases: &[Phase]) -> Self {
        let mut bits = 0;
        let mut index = 0;
        while index < phases.len() {
            bits |= phases[index] as u16;
            index += 1;
        }
        Self { name, phases: bits, is_back_from_callback: false }
    }

    /// What is left of a function after its callback, which may leave the instance in these phases.
    pub const fn after_callback(name: &'static str, phases: &[Phase]) -> Self {
        Self { is_back_from_callback: true, ..Self::new(name, phases) }
    }

    #[inline]
    pub const fn is_allowed_in(&self, phase: Phase) -> bool {
        self.phases & phase as u16 != 0
    }
}
