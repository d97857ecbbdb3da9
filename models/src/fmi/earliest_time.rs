//! How far back an importer that integrates may go in time.

use serde::{Deserialize, Serialize};

use super::CallError;
use super::time_rounding::ROUNDING;

/// How far time may go back: not beyond the last event, nor beyond the completed step before the last one (FMI 2.0.5,
/// section 3.2.2; FMI 3.0.2, section 3.2.1). Within that a solver may look at an earlier time again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct EarliestTime {
    /// \[s\]
    time: f64,
    /// Time of the last completed step or, after it, of the last event \[s\].
    last_completed: f64,
}

impl EarliestTime {
    /// Right after an event at `time` \[s\]; initialisation counts as one.
    pub fn at_event(time: f64) -> Self {
        Self { time, last_completed: time }
    }

    pub fn completed_step(&mut self, time: f64) {
        *self = Self { time: self.last_completed, last_completed: time };
    }

    /// Time of the last completed step or, after it, of the last event \[s\].
    pub fn last_completed(&self) -> f64 {
        self.last_completed
    }

    pub fn is_finite(&self) -> bool {
        self.time.is_finite() && self.last_completed.is_finite()
    }

    pub fn check(&self, time: f64) -> Result<(), CallError> {
        if time >= self.time - ROUNDING * self.time.abs() {
            return Ok(());
        }
        Err(CallError::TimeGoesBack { got: time, earliest: self.time })
    }
}
