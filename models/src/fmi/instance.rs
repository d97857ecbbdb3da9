//! An instantiated model with its life cycle.

use core::fmt;

use super::floating_point::in_default_environment;
use super::fmi3::types::{fmi3ClockUpdateCallback, fmi3InstanceEnvironment};
use super::instance_state::InstanceState;
use super::intermediate_update::{IntermediateUpdate, StepInProgress};
use super::{CallError, Function, Interface, Logger, Phase, SavedState, StateError};
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
    pub(super) logger: Logger,
    pub(super) state: InstanceState,
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
        set_solver(&mut *model, interface);
        let description = model.description();
        let mut instance = Self {
            start: SavedState::new(description),
            variables: description.variables,
            rows: ContinuousRows::of(description),
            model,
            edition: Edition::Plain,
            interface,
            logger,
            state: InstanceState::new(),
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
        if function.is_allowed_in(self.state.phase) {
            Ok(())
        } else if function.is_back_from_callback {
            Err(CallError::LeftByCallback(self.state.phase.name()))
        } else {
            Err(CallError::WrongPhase(self.state.phase.name()))
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
        self.state.set_experiment(start_time, stop_time);
        Ok(())
    }

    pub(super) fn enter_initialization_mode(&mut self) -> Result<(), CallError> {
        self.state.phase = Phase::InitializationMode;
        self.state.needs_initialisation = true;
        Ok(())
    }

    /// Computes all calculated values if something changed since the last time.
    pub(super) fn refresh(&mut self) -> Result<(), CallError> {
        if self.state.needs_initialisation {
            in_default_environment(|| self.model.initialise(self.state.start_time))?;
            self.state.needs_initialisation = false;
        }
        Ok(())
    }

    /// Computes what follows from states and inputs at this instant if one of them was set, after initialisation.
    #[inline]
    pub(super) fn evaluate(&mut self) {
        if self.state.needs_evaluation {
            if let Some(model) = self.model.continuous() {
                in_default_environment(|| model.evaluate());
            }
            self.state.needs_evaluation = false;
        }
    }

    pub(super) fn exit_initialization_mode(&mut self) -> Result<(), CallError> {
        in_default_environment(|| self.model.start(self.state.start_time))?;
        self.state.needs_initialisation = false;
        self.state.phase = self.interface.first_phase();
        let (name, start_time) = (self.model.description().name, self.state.start_time);
        self.log_event(format_args!("{name} initialised at t = {start_time} s"));
        Ok(())
    }

    /// One step from `point` over `step_size`, both in s.
    #[inline(always)]
    pub(super) fn do_step(&mut self, point: f64, step_size: f64) -> Result<(), CallError> {
        let duration = self.state.communication.duration(point, step_size)?;
        self.model.advance(duration, &mut self.logger)?;
        self.state.needs_evaluation = false;
        self.state.communication.take_step(point, step_size, duration);
        self.model.values_mut()[TIME] = self.state.communication.now();
        Ok(())
    }

    pub(super) fn terminate(&mut self) -> Result<(), CallError> {
        self.state.phase = Phase::Terminated;
        self.log_event(format_args!("terminated at t = {} s", self.state.communication.now()));
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

    /// Goes on from a saved state; the model has been restored.
    pub(super) fn resume(&mut self, state: InstanceState) {
        self.state = state;
        self.step = None;
        // The state may be that of an instance with another interface.
        let is_new = set_solver(&mut *self.model, self.interface);
        self.state.needs_initialisation |= is_new && self.state.phase.is_before_first_step();
    }

    pub(super) fn log_event(&mut self, message: fmt::Arguments<'_>) {
        self.logger.log(Topic::Events, message);
    }
}

/// Sets the solver of the model; whether it has changed.
fn set_solver(model: &mut dyn Model, interface: Interface) -> bool {
    let solver = match interface {
        Interface::ModelExchange => Solver::Importer,
        _ => Solver::Model,
    };
    model.continuous().is_some_and(|model| model.set_solver(solver))
}
