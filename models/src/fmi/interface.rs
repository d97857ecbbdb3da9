//! Interface types: how an importer uses an instance.

use super::Phase;
use crate::model::{Description, Edition};

/// What an instance was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The model solves itself, step by step; a sampled one ticks within its steps.
    CoSimulation,
    /// As before, but steps end at ticks, which the importer runs in event mode. A step that may not return early runs
    /// the ticks inside it by itself, and only a tick at its end is an event.
    CoSimulationWithEvents { may_return_early: bool },
    /// The importer integrates the model.
    ModelExchange,
    /// A scheduler runs the ticks of a sampled model.
    ScheduledExecution,
}

impl Interface {
    /// One of each type.
    pub const ALL: [Self; 4] = [
        Self::CoSimulation,
        Self::ModelExchange,
        Self::CoSimulationWithEvents { may_return_early: true },
        Self::ScheduledExecution,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::CoSimulation => "co-simulation",
            Self::CoSimulationWithEvents { .. } => "co-simulation with event mode",
            Self::ModelExchange => "model exchange",
            Self::ScheduledExecution => "scheduled execution",
        }
    }

    pub fn is_offered_by(self, description: &Description, edition: Edition) -> bool {
        match self {
            Self::CoSimulation => true,
            Self::CoSimulationWithEvents { .. } | Self::ScheduledExecution => {
                description.is_sampled() && edition == Edition::Clocked
            }
            Self::ModelExchange => description.offers_model_exchange(),
        }
    }

    /// Whether an instance can be in `phase` between two calls.
    pub(super) fn reaches(self, phase: Phase) -> bool {
        match phase {
            Phase::Instantiated | Phase::InitializationMode | Phase::Terminated => true,
            Phase::StepMode => matches!(self, Self::CoSimulation | Self::CoSimulationWithEvents { .. }),
            Phase::EventMode => matches!(self, Self::CoSimulationWithEvents { .. } | Self::ModelExchange),
            Phase::ContinuousTimeMode => self == Self::ModelExchange,
            Phase::ClockActivationMode => self == Self::ScheduledExecution,
            _ => false,
        }
    }

    /// Phase after initialisation.
    pub(super) fn first_phase(self) -> Phase {
        match self {
            Self::CoSimulation => Phase::StepMode,
            Self::CoSimulationWithEvents { .. } | Self::ModelExchange => Phase::EventMode,
            Self::ScheduledExecution => Phase::ClockActivationMode,
        }
    }
}
