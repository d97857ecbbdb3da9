//! Who makes a sampled unit tick: the unit within its steps, the importer at events, or a scheduler.
//!
//! All three run the same ticks with the same inputs. Without events a tick at t reads the inputs that were set before
//! the step that starts at or before t. With events a step ends at the tick; the importer enters event mode, sets the
//! inputs, and `fmi3UpdateDiscreteStates` runs the tick. It then asks for another event iteration, in which the new
//! outputs can be read and the clock `ticked` is active. The outputs thus follow from the state alone and never, at
//! one instant, from the inputs: a loop through a plant is no algebraic loop.

use super::{CallError, CommunicationPoint, Instance, Phase};
use crate::unit::sampled::{CLOCKS, TICK, TICKED};
use crate::unit::{Journal, SampledUnit, TIME, Unit};
use serde::{Deserialize, Serialize};

/// How an instance was asked to tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ticking {
    /// Within steps; of units that are not sampled, not at all.
    InSteps,
    /// In event mode. A step that may not return early runs the ticks inside it as [`Ticking::InSteps`] does, and only
    /// a tick at its end is an event.
    AtEvents { may_return_early: bool },
    /// When a scheduler activates the model partition.
    OnActivation,
}

impl Ticking {
    /// Phase that follows initialisation.
    pub(super) fn first_phase(self) -> Phase {
        match self {
            Self::InSteps => Phase::StepMode,
            Self::AtEvents { .. } => Phase::EventMode,
            Self::OnActivation => Phase::ClockActivationMode,
        }
    }

    /// Whether an instance can get into `phase`, one of those after initialisation.
    pub(super) fn reaches(self, phase: Phase) -> bool {
        match phase {
            Phase::StepMode => self != Self::OnActivation,
            Phase::EventMode => matches!(self, Self::AtEvents { .. }),
            Phase::ClockActivationMode => self == Self::OnActivation,
            _ => false,
        }
    }
}

/// Clocks at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ClockStates {
    /// The importer has activated `tick`.
    pub is_tick_set: bool,
    /// `ticked` is active.
    pub has_ticked: bool,
    /// A model partition was activated before.
    pub was_activated: bool,
}

/// What an importer learns from a step.
pub(super) struct StepEnd {
    /// A tick is due.
    pub is_event: bool,
    /// The step ends before the time asked for.
    pub is_early: bool,
}

/// What an importer learns from the end of an event iteration.
pub(super) struct EventEnd {
    /// Another one is needed.
    pub is_unfinished: bool,
    /// \[s\]
    pub next_event_time: f64,
}

impl Instance {
    /// The same instance with other ticks; refused with a message if the unit has none.
    pub(super) fn ticking(mut self, function: &str, ticking: Ticking) -> Option<Self> {
        let name = self.unit.description().name;
        let asked = match ticking {
            Ticking::InSteps => return Some(self),
            Ticking::AtEvents { .. } => "event mode",
            Ticking::OnActivation => "scheduled execution",
        };
        if self.unit.sampled().is_none() {
            self.logger.error(format_args!("{function}: {name} does not offer {asked}, it has no clocks"));
            return None;
        }
        self.ticking = ticking;
        Some(self)
    }

    /// The unit of an instance that ticks at events.
    fn at_events(&mut self) -> Result<(&mut dyn SampledUnit, &mut dyn Journal), CallError> {
        if !matches!(self.ticking, Ticking::AtEvents { .. }) {
            return Err(CallError::NotOffered("the instance was not made for event mode"));
        }
        sampled(&mut *self.unit).map(|unit| (unit, &mut self.logger as &mut dyn Journal))
    }

    /// One step from `point` over `step_size`, both in s, or up to the tick before its end.
    #[inline]
    pub(super) fn step_to_event(&mut self, point: f64, step_size: f64) -> Result<StepEnd, CallError> {
        let Ticking::AtEvents { may_return_early } = self.ticking else {
            self.do_step(point, step_size)?;
            return Ok(StepEnd { is_event: false, is_early: false });
        };
        let duration = self.communication.duration(point, step_size)?;
        let clock = sampled(&mut *self.unit)?.clock_mut();
        let mut is_early = false;
        match clock.until_tick_within(duration) {
            Some(wait) if may_return_early => {
                clock.pass(wait);
                // The importer's time may be off by rounding; a step never goes back nor beyond its end.
                let reached = clock.next_time().max(point).min(point + step_size);
                self.communication = CommunicationPoint::new(if wait > 0.0 { reached } else { point });
                is_early = self.communication.now() < point + step_size;
            }
            _ => {
                self.unit.advance(duration, &mut self.logger)?;
                self.communication.advance(point, step_size);
            }
        }
        self.unit.values_mut()[TIME] = self.communication.now();
        Ok(StepEnd { is_event: sampled(&mut *self.unit)?.clock().is_due(), is_early })
    }

    pub(super) fn enter_event_mode(&mut self) -> Result<(), CallError> {
        self.at_events()?;
        self.phase = Phase::EventMode;
        Ok(())
    }

    pub(super) fn enter_step_mode(&mut self) -> Result<(), CallError> {
        self.at_events()?;
        self.clocks = ClockStates::default();
        self.phase = Phase::StepMode;
        Ok(())
    }

    /// Runs the tick that is due, if there is one.
    pub(super) fn update_discrete_states(&mut self) -> Result<EventEnd, CallError> {
        let (unit, journal) = self.at_events()?;
        let is_due = unit.clock().is_due();
        if is_due {
            let time = unit.clock_mut().take();
            unit.tick(time, journal);
        }
        let next_event_time = unit.clock().next_time();
        self.clocks = ClockStates { has_ticked: is_due, ..ClockStates::default() };
        Ok(EventEnd { is_unfinished: is_due, next_event_time })
    }

    /// Runs the tick that a scheduler calls for at `time` \[s\].
    pub(super) fn activate_model_partition(&mut self, clock: u32, time: f64) -> Result<(), CallError> {
        if self.find_clock(clock)? != TICK {
            return Err(self.no_input_clock());
        }
        let now = self.communication.now();
        if !time.is_finite() || time < now || (time == now && self.clocks.was_activated) {
            return Err(CallError::ActivationTime { got: time, last: now });
        }
        let unit = sampled(&mut *self.unit)?;
        let tick_time = unit.clock_mut().take_at(time);
        unit.tick(tick_time, &mut self.logger);
        self.communication = CommunicationPoint::new(time);
        self.unit.values_mut()[TIME] = time;
        self.clocks.was_activated = true;
        self.clocks.has_ticked = true;
        Ok(())
    }

    /// The importer is told that `ticked` is active.
    pub(super) fn enter_clock_update_mode(&mut self) {
        self.phase = Phase::ClockUpdateMode;
    }

    /// Back from the importer, who may have asked for `ticked` or not.
    pub(super) fn leave_clock_update_mode(&mut self) {
        self.clocks.has_ticked = false;
        self.phase = Phase::ClockActivationMode;
    }

    /// Place of the clock with this value reference in the unit's clocks.
    pub(super) fn find_clock(&self, reference: u32) -> Result<usize, CallError> {
        let description = self.unit.description();
        if let Some(variable) = self.variables.get(reference as usize) {
            return Err(CallError::NoClock { name: variable.name, reference });
        }
        let found = description.clocks().position(|(known, _)| known == reference as usize);
        found.ok_or_else(|| self.unknown_reference(reference))
    }

    fn no_input_clock(&self) -> CallError {
        let why = "a clock that the unit itself activates";
        CallError::NotSettable { name: CLOCKS[TICKED].name, why, phase: self.phase.name() }
    }

    /// Activation states. In scheduled execution `ticked` tells of each tick once.
    pub(super) fn get_clocks(&mut self, references: &[u32], values: &mut [u8]) -> Result<(), CallError> {
        for reference in references {
            self.find_clock(*reference)?;
        }
        for (value, reference) in values.iter_mut().zip(references) {
            *value = match self.find_clock(*reference)? {
                TICK => self.clocks.is_tick_set.into(),
                _ => self.clocks.has_ticked.into(),
            };
        }
        if self.ticking == Ticking::OnActivation && !references.is_empty() {
            self.clocks.has_ticked = false;
        }
        Ok(())
    }

    /// Activates `tick` where a tick is due, which happens then in any case: an importer that knows nothing of clocks
    /// gets the same ticks. A tick that has been run at this instant stays run.
    pub(super) fn set_clocks(&mut self, references: &[u32], values: &[u8]) -> Result<(), CallError> {
        let has_ticked = self.clocks.has_ticked;
        let mut is_tick_set = self.clocks.is_tick_set;
        for (reference, value) in references.iter().zip(values) {
            if self.find_clock(*reference)? != TICK {
                return Err(self.no_input_clock());
            }
            let now = self.communication.now();
            let (unit, _) = self.at_events()?;
            match (*value != 0, unit.clock().is_due() || has_ticked) {
                (true, true) => is_tick_set = true,
                (true, false) => {
                    return Err(CallError::NoTick { now, next: unit.clock().next_time() });
                }
                (false, _) if is_tick_set => return Err(CallError::ClockStaysActive),
                (false, _) => {}
            }
        }
        self.clocks.is_tick_set = is_tick_set;
        Ok(())
    }

    /// Interval \[s\] of an input clock, and the time from the start to its first tick \[s\].
    pub(super) fn interval_and_shift(&mut self, reference: u32) -> Result<(f64, f64), CallError> {
        if self.find_clock(reference)? != TICK {
            return Err(self.no_input_clock());
        }
        self.refresh_before_first_step()?;
        let start_time = self.start_time;
        let clock = sampled(&mut *self.unit)?.clock();
        Ok((clock.period(), (clock.next_time() - start_time).max(0.0)))
    }
}

fn sampled(unit: &mut dyn Unit) -> Result<&mut dyn SampledUnit, CallError> {
    unit.sampled().ok_or(CallError::NotOffered("the unit has no clocks"))
}
