//! An instantiated model with its life cycle.

use core::fmt;

use super::earliest_time::EarliestTime;
use super::floating_point::in_default_environment;
use super::fmi3::types::{fmi3ClockUpdateCallback, fmi3InstanceEnvironment};
use super::intermediate_update::{IntermediateUpdate, StepInProgress};
use super::saved_state::InstanceState;
use super::ticking::ClockStates;
use super::{CallError, CommunicationPoint, Function, Interface, Logger, Phase, SavedState, StateError};
use crate::model::sampled::ClockVariable;
use crate::model::variable::Variable;
use crate::model::{ContinuousRows, Edition, LogSink, Model, Solver, TIME, Topic};

/// What a handle (`fmi2Component`, `fmi3Instance`) points to.
pub struct Instance {
    pub(super) model: Box<dyn Model>,
    /// As made, for reset.
    pub(super) start: SavedState,
    pub(super) variables: &'static [Variable],
    /// What the importer has read of the model.
    pub(super) edition: Edition,
    /// Where the table holds what moves in continuous time.
    pub(super) rows: ContinuousRows,
    pub(super) interface: Interface,
    pub(super) phase: Phase,
    pub(super) logger: Logger,
    pub(super) communication: CommunicationPoint,
    /// How far an importer that integrates the model may go back.
    pub(super) earliest_time: EarliestTime,
    pub(super) start_time: f64,
    /// Whether a value was set since the calculated ones were last computed, before the first step.
    pub(super) needs_initialisation: bool,
    /// Whether a state or an input was set since what follows from them was last computed, after initialisation.
    pub(super) needs_evaluation: bool,
    pub(super) clocks: ClockStates,
    /// How the importer wants to be called back within a step.
    pub(super) intermediate_update: Option<IntermediateUpdate>,
    /// The step within which it is called back.
    pub(super) step: Option<StepInProgress>,
    /// How a scheduler wants to be told of the clock `ticked`.
    pub(super) clock_update: Option<(fmi3ClockUpdateCallback, fmi3InstanceEnvironment)>,
}

impl Instance {
    /// An instance of any model, not only of those the library knows by token, in its plain edition.
    pub fn new(mut model: Box<dyn Model>, interface: Interface, logger: Logger) -> Result<Self, StateError> {
        say_who_solves(&mut *model, interface);
        let description = model.description();
        let mut instance = Self {
            start: SavedState::new(description),
            variables: description.variables,
            rows: ContinuousRows::of(description),
            model,
            edition: Edition::Plain,
            interface,
            phase: Phase::Instantiated,
            logger,
            communication: CommunicationPoint::new(0.0, None),
            earliest_time: EarliestTime::at_event(0.0),
            start_time: 0.0,
            needs_initialisation: true,
            needs_evaluation: false,
            clocks: ClockStates::default(),
            intermediate_update: None,
            step: None,
            clock_update: None,
        };
        let mut start = SavedState::new(description);
        instance.save(&mut start)?;
        instance.start = start;
        Ok(instance)
    }

    #[inline]
    pub(super) fn require(&self, function: &Function) -> Result<(), CallError> {
        if function.is_allowed_in(self.phase) {
            Ok(())
        } else if function.is_back_from_callback {
            Err(CallError::LeftByCallback(self.phase.name()))
        } else {
            Err(CallError::WrongPhase(self.phase.name()))
        }
    }

    /// Start and stop time of the experiment \[s\]; nothing is computed past the stop time, if there is one.
    pub(super) fn set_experiment(
        &mut self,
        start_time: f64,
        stop_time: Option<f64>,
    ) -> Result<(), CallError> {
        if !start_time.is_finite() {
            let expected = "a finite time";
            return Err(CallError::WrongTime { argument: "startTime", value: start_time, expected });
        }
        if let Some(stop_time) = stop_time
            && (stop_time.is_nan() || stop_time < start_time)
        {
            let expected = "a time not before startTime";
            return Err(CallError::WrongTime { argument: "stopTime", value: stop_time, expected });
        }
        self.start_time = start_time;
        self.communication = CommunicationPoint::new(start_time, stop_time);
        self.earliest_time = EarliestTime::at_event(start_time);
        self.needs_initialisation = true;
        Ok(())
    }

    pub(super) fn enter_initialization_mode(&mut self) -> Result<(), CallError> {
        self.phase = Phase::InitializationMode;
        self.needs_initialisation = true;
        Ok(())
    }

    /// Computes all calculated values if something changed since the last time.
    pub(super) fn refresh(&mut self) -> Result<(), CallError> {
        if self.needs_initialisation {
            in_default_environment(|| self.model.initialise(self.start_time))?;
            self.needs_initialisation = false;
        }
        Ok(())
    }

    /// Computes what follows from states and inputs at this instant if one of them was set, after initialisation.
    #[inline]
    pub(super) fn evaluate(&mut self) {
        if self.needs_evaluation {
            if let Some(model) = self.model.continuous() {
                in_default_environment(|| model.evaluate());
            }
            self.needs_evaluation = false;
        }
    }

    pub(super) fn exit_initialization_mode(&mut self) -> Result<(), CallError> {
        in_default_environment(|| self.model.start(self.start_time))?;
        self.needs_initialisation = false;
        self.phase = self.interface.first_phase();
        let (name, start_time) = (self.model.description().name, self.start_time);
        self.log_event(format_args!("{name} initialised at t = {start_time} s"));
        Ok(())
    }

    /// One step from `point` over `step_size`, both in s.
    #[inline(always)]
    pub(super) fn do_step(&mut self, point: f64, step_size: f64) -> Result<(), CallError> {
        let duration = self.communication.duration(point, step_size)?;
        self.model.advance(duration, &mut self.logger)?;
        self.needs_evaluation = false;
        self.communication.move_to(point + step_size);
        self.model.values_mut()[TIME] = self.communication.now();
        Ok(())
    }

    pub(super) fn terminate(&mut self) -> Result<(), CallError> {
        self.phase = Phase::Terminated;
        self.log_event(format_args!("terminated at t = {} s", self.communication.now()));
        Ok(())
    }

    /// Back to the state right after instantiation.
    pub(super) fn reset(&mut self) -> Result<(), CallError> {
        self.restart()?;
        self.log_event(format_args!("reset"));
        Ok(())
    }

    /// Clocks that the importer knows of, with their value references.
    pub(super) fn clocks(&self) -> impl Iterator<Item = (usize, &'static ClockVariable)> + use<> {
        self.edition.clocks(self.model.description())
    }

    /// What a saved state has to tell besides the model.
    pub(super) fn instance_state(&self) -> InstanceState {
        let Self {
            phase,
            communication,
            earliest_time,
            start_time,
            needs_initialisation,
            needs_evaluation,
            clocks,
            ..
        } = *self;
        InstanceState {
            phase,
            communication,
            earliest_time,
            start_time,
            needs_initialisation,
            needs_evaluation,
            clocks,
        }
    }

    /// Goes on from a saved state; the model has been restored.
    pub(super) fn resume(&mut self, instance_state: InstanceState) {
        let InstanceState {
            phase,
            communication,
            earliest_time,
            start_time,
            needs_initialisation,
            needs_evaluation,
            clocks,
        } = instance_state;
        self.phase = phase;
        self.communication = communication;
        self.earliest_time = earliest_time;
        self.start_time = start_time;
        self.needs_initialisation = needs_initialisation;
        self.needs_evaluation = needs_evaluation;
        self.clocks = clocks;
        self.step = None;
        // The state may be that of an instance with another interface.
        let is_new = say_who_solves(&mut *self.model, self.interface);
        self.needs_initialisation |=
            is_new && matches!(phase, Phase::Instantiated | Phase::InitializationMode);
    }

    pub(super) fn log_event(&mut self, message: fmt::Arguments<'_>) {
        self.logger.log(Topic::Events, message);
    }
}

/// Tells the model who solves it; whether that is new to it.
fn say_who_solves(model: &mut dyn Model, interface: Interface) -> bool {
    let solver = match interface {
        Interface::ModelExchange => Solver::Importer,
        _ => Solver::Model,
    };
    model.continuous().is_some_and(|model| model.set_solver(solver))
}
