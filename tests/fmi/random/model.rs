//! What an importer knows of an instance: where it stands in the standards' state machines, and what was called before.

use super::super::harness::Standard;
use super::super::standard::{Interface, State, Variable};
use super::answer::Answer;
use super::call::{Call, Experiment};
use super::scenario::{Choices, SAMPLE_TIME, Scenario};

#[derive(Clone, Debug)]
pub struct Model {
    pub state: State,
    /// A call has returned Error since the run began.
    pub has_erred: bool,
    /// Whether the model still knows the instance: it does not after a forged state was restored.
    pub is_known: bool,
    /// fmi2SetupExperiment was called.
    pub is_set_up: bool,
    /// Whether a parameter or input was set, which initialisation may refuse to combine.
    pub is_changed: bool,
    pub start: f64,
    pub stop: Option<f64>,
    pub time: f64,
    /// By how much the sum of the steps so far may be off by rounding \[s\].
    pub drift: f64,
    /// Length of the last step \[s\], 0 before the first.
    pub last_step: f64,
    /// Times of the last EnterEventMode and of the last two CompletedIntegratorStep.
    pub last_event: f64,
    pub completed: [f64; 2],
    /// A value was set since the last step, activation or begin of a callback.
    pub has_set: bool,
    /// The last event iteration wanted no other one.
    pub is_settled: bool,
    /// The input clock was set in this event iteration.
    pub is_clock_set: bool,
    /// The last step has ended at an event.
    pub has_event: bool,
    pub last_activation: Option<f64>,
    /// Time before which the importer said it would restore no state.
    pub promised: f64,
    /// Of sampled models, as far as it is known.
    pub sample_time: f64,
}

impl Model {
    pub fn new(sample_time: f64) -> Self {
        Self {
            state: State::Instantiated,
            has_erred: false,
            is_known: true,
            is_set_up: false,
            is_changed: false,
            start: 0.0,
            stop: None,
            time: 0.0,
            drift: 0.0,
            last_step: 0.0,
            last_event: f64::NEG_INFINITY,
            completed: [f64::NEG_INFINITY; 2],
            has_set: false,
            is_settled: false,
            is_clock_set: false,
            has_event: false,
            last_activation: None,
            promised: f64::NEG_INFINITY,
            sample_time,
        }
    }

    /// Takes over what a call that returned OK has done. Restoring is done by [`Model::restore`].
    pub fn follow(&mut self, call: &Call, answer: &Answer, scenario: &Scenario, choices: &Choices) {
        match call {
            Call::Setup(experiment) => {
                self.is_set_up = true;
                self.begin(experiment);
            }
            Call::EnterInitialization(experiment) => {
                if scenario.description.standard == Standard::Fmi3 {
                    self.begin(experiment);
                }
                self.state = State::Initialization;
            }
            Call::Plain(function) => self.follow_plain(function, choices, scenario.sample_time()),
            Call::Set { references, values, .. } if !references.is_empty() => {
                self.has_set = true;
                self.is_changed = true;
                for (reference, value) in references.iter().zip(values) {
                    let is_sample_time = |variable: &Variable| variable.name == SAMPLE_TIME;
                    if scenario.description.find(*reference).is_some_and(is_sample_time) {
                        self.sample_time = *value;
                    }
                }
            }
            Call::UpdateDiscreteStates { is_null } => {
                self.is_settled = !answer.is_unfinished && !is_null;
                self.is_clock_set = false;
            }
            Call::CompletedStep { .. } => {
                self.completed = [self.completed[1], self.time];
                self.promised = self.promised.max(self.time);
            }
            Call::Timing { function, references }
                if function.starts_with("fmi3SetInterval") && !references.is_empty() =>
            {
                self.sample_time = 1e-3;
                self.is_changed = true;
            }
            Call::SetTime(time) => self.time = *time,
            Call::Step { point, is_final, .. } => {
                let way = answer.reached - point;
                self.last_step = if way > 0.0 { way } else { self.last_step };
                self.time = answer.reached;
                self.has_set = false;
                self.has_event = answer.is_event;
                if *is_final {
                    self.promised = self.promised.max(*point);
                }
            }
            Call::Activate { time, .. } => {
                self.time = *time;
                self.last_activation = Some(*time);
                self.has_set = false;
            }
            Call::SetClocks { values, .. } => self.is_clock_set |= values.iter().any(|value| *value != 0),
            _ => {}
        }
        if matches!(call, Call::SetTime(_) | Call::Step { .. } | Call::Activate { .. }) {
            self.drift += f64::EPSILON * self.time.abs();
        }
    }

    /// Whether initialisation may refuse what was set, or a start time so far away that ticks cannot be counted there.
    pub fn may_be_refused(&self) -> bool {
        self.is_changed || self.start.abs() > 1e8
    }

    /// Earliest time that may be set in model exchange (FMI 3.0.2, section 3.2.1) \[s\].
    pub fn earliest(&self) -> f64 {
        self.start.max(self.last_event).max(self.completed[0])
    }

    /// Whether `time` lies after the stop time by more than rounding makes of the `way` that leads there \[s\].
    pub fn is_past_stop(&self, time: f64, way: f64) -> bool {
        let rounding = (2e-9 * way).max((2.0 * self.drift).min(0.02 * way));
        self.stop.is_some_and(|stop| time - stop > rounding + 1e-14 * time.abs())
    }

    /// Goes on from where a state was saved.
    pub fn restore(&mut self, saved: &Self) {
        let promised = self.promised;
        *self = Self { has_erred: false, promised, ..saved.clone() };
    }

    fn begin(&mut self, experiment: &Experiment) {
        self.start = experiment.start;
        self.stop = experiment.stop;
        self.time = experiment.start;
        self.drift = 0.0;
        self.last_step = 0.0;
    }

    fn follow_plain(&mut self, function: &str, choices: &Choices, initial_sample_time: f64) {
        match &function[4..] {
            "ExitInitializationMode" => {
                self.has_set = false;
                self.last_event = self.time;
                self.is_settled = false;
                self.state = match choices.interface {
                    Interface::ModelExchange => State::Event,
                    Interface::CoSimulation if choices.has_events => State::Event,
                    Interface::CoSimulation => State::Step,
                    Interface::ScheduledExecution => State::Activation,
                };
            }
            "Terminate" => self.state = State::Terminated,
            "Reset" => *self = Self::new(initial_sample_time),
            "EnterEventMode" => {
                self.state = State::Event;
                self.last_event = self.time;
                // An event that the importer has gone back to takes back the steps that were completed after it.
                self.completed = self.completed.map(|completed| completed.min(self.time));
                self.is_settled = false;
                self.has_event = false;
            }
            "EnterContinuousTimeMode" => self.state = State::Continuous,
            "EnterStepMode" => {
                self.state = State::Step;
                self.has_set = false;
                self.is_clock_set = false;
            }
            _ => {}
        }
    }
}
