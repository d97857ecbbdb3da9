//! Where an instance stands in its life: what a saved state holds besides the model.

use super::earliest_time::EarliestTime;
use super::ticking::ClockStates;
use super::{CommunicationPoint, Phase, StateError};
use serde::{Deserialize, Serialize};

/// Where an instance stands in its life.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct InstanceState {
    pub phase: Phase,
    pub communication: CommunicationPoint,
    /// How far an importer that integrates the model may go back.
    pub earliest_time: EarliestTime,
    /// \[s\]
    pub start_time: f64,
    /// Whether a value was set since the calculated ones were last computed, before the first step.
    pub needs_initialisation: bool,
    /// Whether a state or an input was set since what follows from them was last computed, after initialisation.
    pub needs_evaluation: bool,
    pub clocks: ClockStates,
}

impl InstanceState {
    /// Just instantiated.
    pub fn new() -> Self {
        Self {
            phase: Phase::Instantiated,
            communication: CommunicationPoint::new(0.0, None),
            earliest_time: EarliestTime::at_event(0.0),
            start_time: 0.0,
            needs_initialisation: true,
            needs_evaluation: false,
            clocks: ClockStates::default(),
        }
    }

    /// The experiment starts at `start_time` \[s\] and goes on to `stop_time` \[s\], if there is one.
    pub fn set_experiment(&mut self, start_time: f64, stop_time: Option<f64>) {
        self.start_time = start_time;
        self.communication = CommunicationPoint::new(start_time, stop_time);
        self.earliest_time = EarliestTime::at_event(start_time);
        self.needs_initialisation = true;
    }

    /// Whether an instance that may be in the phases that `reaches` names could have been saved so.
    pub fn check(&self, reaches: impl Fn(Phase) -> bool) -> Result<(), StateError> {
        let Self { phase, start_time, .. } = *self;
        let now = self.communication.now();
        if !reaches(phase) {
            return Err(StateError::OtherPhase { got: phase.name() });
        }
        if !(self.communication.is_possible_after(start_time) && self.earliest_time.is_finite()) {
            return Err(StateError::Times { now, start_time });
        }
        if self.needs_initialisation && !phase.is_before_first_step() {
            return Err(StateError::Stale(phase.name()));
        }
        Ok(())
    }
}
