//! Interface types: how an importer uses an instance.

use super::Phase;
use crate::unit::Description;

/// What an instance was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The unit solves itself, step by step.
    CoSimulation,
    /// The importer integrates the unit.
    ModelExchange,
}

impl Interface {
    pub fn name(self) -> &'static str {
        match self {
            Self::CoSimulation => "co-simulation",
            Self::ModelExchange => "model exchange",
        }
    }

    pub fn is_offered_by(self, description: &Description) -> bool {
        match self {
            Self::CoSimulation => true,
            Self::ModelExchange => description.offers_model_exchange(),
        }
    }

    /// Whether an instance can get into `phase`.
    pub(super) fn reaches(self, phase: Phase) -> bool {
        match phase {
            Phase::Instantiated | Phase::InitializationMode | Phase::Terminated => true,
            Phase::StepMode => self == Self::CoSimulation,
            Phase::EventMode | Phase::ContinuousTimeMode => self == Self::ModelExchange,
            _ => false,
        }
    }

    /// Phase after initialisation.
    pub(super) fn first_phase(self) -> Phase {
        match self {
            Self::CoSimulation => Phase::StepMode,
            Self::ModelExchange => Phase::EventMode,
        }
    }
}
