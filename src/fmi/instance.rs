//! An instantiated unit with its life cycle.

use core::ffi::CStr;
use core::fmt;

use super::fmi3::types::{fmi3ClockUpdateCallback, fmi3InstanceEnvironment};
use super::intermediate_update::{IntermediateUpdate, StepInProgress};
use super::saved_state::Life;
use super::ticking::ClockStates;
use super::{CallError, Callback, CommunicationPoint, Function, Interface, Logger, Phase};
use crate::unit::start_values::read_token;
use crate::unit::variable::Variable;
use crate::unit::{ContinuousRows, Description, Journal, Solver, TIME, Topic, Unit};

/// What a handle (`fmi2Component`, `fmi3Instance`) points to.
pub struct Instance {
    pub(super) unit: Box<dyn Unit>,
    /// The unit as made, for reset.
    template: Box<dyn Unit>,
    pub(super) variables: &'static [Variable],
    /// Where the table holds what moves in continuous time.
    pub(super) rows: ContinuousRows,
    pub(super) interface: Interface,
    pub(super) phase: Phase,
    pub(super) logger: Logger,
    pub(super) communication: CommunicationPoint,
    pub(super) start_time: f64,
    /// Whether a value was set since the calculated ones were last computed, before the first step.
    pub(super) is_stale: bool,
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
    /// An instance of any unit, not only of those the library knows by token.
    pub fn new(mut unit: Box<dyn Unit>, interface: Interface, logger: Logger) -> Self {
        say_who_solves(&mut *unit, interface);
        Self {
            template: unit.boxed_clone(),
            variables: unit.description().variables,
            rows: ContinuousRows::of(unit.description()),
            unit,
            interface,
            phase: Phase::Instantiated,
            logger,
            communication: CommunicationPoint::new(0.0),
            start_time: 0.0,
            is_stale: true,
            needs_evaluation: false,
            clocks: ClockStates::default(),
            intermediate_update: None,
            step: None,
            clock_update: None,
        }
    }

    #[inline]
    pub(super) fn require(&self, function: &Function) -> Result<(), CallError> {
        if function.is_allowed_in(self.phase) {
            Ok(())
        } else {
            Err(CallError::WrongPhase(self.phase.name()))
        }
    }

    /// Start and stop time of the experiment \[s\]; the stop time only has to make sense, steps may go beyond.
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
        self.communication = CommunicationPoint::new(start_time);
        self.is_stale = true;
        Ok(())
    }

    pub(super) fn enter_initialization_mode(&mut self) -> Result<(), CallError> {
        self.phase = Phase::InitializationMode;
        self.is_stale = true;
        Ok(())
    }

    /// Computes all calculated values if something changed since the last time.
    pub(super) fn refresh(&mut self) -> Result<(), CallError> {
        if self.is_stale {
            self.unit.initialise(self.start_time)?;
            self.is_stale = false;
        }
        Ok(())
    }

    /// Computes what follows from states and inputs at this instant if one of them was set, after initialisation.
    #[inline]
    pub(super) fn evaluate(&mut self) {
        if self.needs_evaluation {
            if let Some(unit) = self.unit.continuous() {
                unit.evaluate();
            }
            self.needs_evaluation = false;
        }
    }

    pub(super) fn exit_initialization_mode(&mut self) -> Result<(), CallError> {
        self.unit.check_parameters()?;
        self.is_stale = true;
        self.refresh()?;
        self.phase = self.interface.first_phase();
        let (name, start_time) = (self.unit.description().name, self.start_time);
        self.note(format_args!("{name} initialised at t = {start_time} s"));
        Ok(())
    }

    /// One step from `point` over `step_size`, both in s.
    #[inline]
    pub(super) fn do_step(&mut self, point: f64, step_size: f64) -> Result<(), CallError> {
        let duration = self.communication.duration(point, step_size)?;
        self.unit.advance(duration, &mut self.logger)?;
        self.needs_evaluation = false;
        self.communication.advance(point, step_size);
        self.unit.values_mut()[TIME] = self.communication.now();
        Ok(())
    }

    pub(super) fn terminate(&mut self) -> Result<(), CallError> {
        self.phase = Phase::Terminated;
        self.note(format_args!("terminated at t = {} s", self.communication.now()));
        Ok(())
    }

    /// Back to the state right after instantiation.
    pub(super) fn reset(&mut self) -> Result<(), CallError> {
        self.unit = self.template.boxed_clone();
        self.phase = Phase::Instantiated;
        self.start_time = 0.0;
        self.communication = CommunicationPoint::new(0.0);
        self.is_stale = true;
        self.clocks = ClockStates::default();
        self.needs_evaluation = false;
        self.note(format_args!("reset"));
        Ok(())
    }

    /// Whether the instance can get into `phase`.
    pub(super) fn reaches(&self, phase: Phase) -> bool {
        self.interface.reaches(phase)
    }

    /// What a saved state has to tell besides the unit.
    pub(super) fn life(&self) -> Life {
        let Self { phase, communication, start_time, is_stale, needs_evaluation, clocks, .. } = *self;
        Life { phase, communication, start_time, is_stale, needs_evaluation, clocks }
    }

    /// Goes on from a saved state; the unit has been restored.
    pub(super) fn resume(&mut self, life: Life) {
        let Life { phase, communication, start_time, is_stale, needs_evaluation, clocks } = life;
        self.phase = phase;
        self.communication = communication;
        self.start_time = start_time;
        self.is_stale = is_stale;
        self.needs_evaluation = needs_evaluation;
        self.clocks = clocks;
        // The state may be that of an instance with another interface.
        let is_new = say_who_solves(&mut *self.unit, self.interface);
        self.is_stale |= is_new && matches!(phase, Phase::Instantiated | Phase::InitializationMode);
    }

    pub(super) fn note(&mut self, message: fmt::Arguments<'_>) {
        self.logger.note(Topic::Events, message);
    }
}

/// Tells the unit who solves it; whether that is new to it.
fn say_who_solves(unit: &mut dyn Unit, interface: Interface) -> bool {
    let solver = match interface {
        Interface::ModelExchange => Solver::Importer,
        _ => Solver::Unit,
    };
    unit.continuous().is_some_and(|unit| unit.set_solver(solver))
}

/// Makes an instance of the unit whose token is `token`, with the start values in it, for an interface type, or logs why
/// not. `interface` is the name of what was asked for if no unit offers it.
pub(super) fn instantiate(
    function: &str,
    name: Option<&CStr>,
    token: Option<&CStr>,
    callback: Callback,
    logging_on: bool,
    interface: Result<Interface, &str>,
) -> Option<Instance> {
    let logger = Logger::new(callback, name.unwrap_or_default().into(), logging_on);
    let interface = match interface {
        Ok(interface) => interface,
        Err(asked) => {
            logger.error(format_args!("{function}: {asked} is not offered"));
            return None;
        }
    };
    let token = token.unwrap_or_default().to_str().unwrap_or_default();
    let (unit, start_values) = match read_token(token) {
        Ok(found) => found,
        Err(error) => {
            logger.error(format_args!("{function}: {error}"));
            return None;
        }
    };
    if !interface.is_offered_by(unit.description) {
        let (name, asked) = (unit.description.name, interface.name());
        let offered = Offered(unit.description);
        logger.error(format_args!("{function}: {name} does not offer {asked}, only {offered}"));
        return None;
    }
    let mut made = (unit.create)();
    start_values.apply(&mut *made);
    let mut instance = Instance::new(made, interface, logger);
    instance.note(format_args!("{} instantiated", unit.description.name));
    Some(instance)
}

/// The interface types of a unit, for an error message.
struct Offered(&'static Description);

impl fmt::Display for Offered {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let offered = Interface::ALL.iter().filter(|interface| interface.is_offered_by(self.0));
        offered.enumerate().try_for_each(|(index, interface)| {
            write!(formatter, "{}{}", if index == 0 { "" } else { ", " }, interface.name())
        })
    }
}
