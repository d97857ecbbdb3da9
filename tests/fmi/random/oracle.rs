//! What a call has to return, by the tables of the standards and the list of deviations.

use super::super::harness::Standard;
use super::super::standard::{Causality, Condition, Deviations, Interface, Kind, State, Table, Variable};
use super::arguments::{self, Arguments};
use super::call::Call;
use super::model::Model;
use super::scenario::{Choices, Scenario};

/// What the standard says about making a call now.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    Allowed,
    /// Forbidden, but the library does it on purpose.
    Tolerated(Vec<&'static str>),
    Forbidden(&'static str),
    /// Allowed, but the library refuses it on purpose.
    Declined(&'static str),
}

/// What a call may return.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub rule: Rule,
    pub arguments: Arguments,
}

impl Verdict {
    /// Whether the status is one that the call may have.
    pub fn allows(&self, status: i32) -> bool {
        match (&self.rule, self.arguments) {
            (Rule::Forbidden(_) | Rule::Declined(_), _) => status == 3,
            (_, Arguments::Wrong) => status == 2 || status == 3,
            (_, Arguments::Unanswerable) => status == 2,
            (_, Arguments::Good) => status == 0,
            (_, Arguments::Computed) => status == 0 || status == 2,
            (_, Arguments::Open) => (0..=3).contains(&status),
        }
    }
}

pub struct Oracle<'a> {
    pub scenario: &'a Scenario,
    pub choices: &'a Choices,
    pub model: &'a Model,
}

impl Oracle<'_> {
    pub fn judge(&self, call: &Call, saved: &dyn Fn(usize) -> Option<Model>) -> Verdict {
        let rule = self.rule(call, saved);
        Verdict { rule, arguments: arguments::judge(self, call, saved) }
    }

    pub fn standard(&self) -> Standard {
        self.scenario.description.standard
    }

    fn rule(&self, call: &Call, saved: &dyn Fn(usize) -> Option<Model>) -> Rule {
        let function = call.function(self.standard());
        let row = Table::of(self.standard()).row(function);
        // No interval of no clock: nothing is asked for that would have to be declared.
        let is_of_nothing = matches!(call, Call::Timing { references, .. } if references.is_empty());
        let is_declared = row.needs.is_empty()
            || self.scenario.can(&row.needs)
            || (is_of_nothing && row.needs == "intervalDecimal");
        let condition = row.condition(self.scenario.interface, self.model.state);
        let by_state = match self.by_condition(function, condition, call) {
            _ if !is_declared => Rule::Forbidden("a capability that is not declared"),
            rule => rule,
        };
        let Rule::Tolerated(mut deviations) = by_state else {
            return match by_state {
                Rule::Allowed => self.further(call, saved),
                other => other,
            };
        };
        match self.further(call, saved) {
            Rule::Allowed => {}
            Rule::Tolerated(more) => deviations.extend(more),
            other => return other,
        }
        Rule::Tolerated(deviations)
    }

    /// By the table alone.
    fn by_condition(&self, function: &'static str, condition: Condition, call: &Call) -> Rule {
        match condition {
            Condition::Always => Rule::Allowed,
            Condition::Never | Condition::PureDiscreteTime | Condition::ChangingClock => self.never(function),
            Condition::SuperState
                if ["fmi3SetDebugLogging", "fmi3Reset", "fmi3SetFMUState"].contains(&function) =>
            {
                Rule::Allowed
            }
            Condition::SuperState => Rule::Declined("no-way-out-of-a-callback"),
            Condition::AfterSetup if self.model.is_set_up => Rule::Allowed,
            Condition::AfterSetup => tolerated("no-setup-experiment"),
            Condition::EventModeUsed if self.choices.has_events => Rule::Allowed,
            Condition::EventModeUsed => Rule::Forbidden("without event mode"),
            Condition::SettledEvent if self.model.is_settled => Rule::Allowed,
            Condition::SettledEvent => tolerated("event-left-early"),
            _ => self.by_variables(condition, call),
        }
    }

    /// What the library does although the table has nothing.
    fn never(&self, function: &'static str) -> Rule {
        let (interface, state) = (self.scenario.interface, self.model.state);
        match (function, interface, state) {
            ("fmi3SetFMUState", _, State::Update) => tolerated("restored-within-an-activation"),
            (
                "fmi3GetNumberOfEventIndicators" | "fmi3GetNumberOfContinuousStates",
                Interface::ModelExchange,
                _,
            ) => tolerated("counts-at-any-time"),
            _ => Rule::Forbidden("by the table"),
        }
    }

    /// Each variable for itself.
    fn by_variables(&self, condition: Condition, call: &Call) -> Rule {
        let references = match call {
            Call::Get { references, .. }
            | Call::Set { references, .. }
            | Call::GetClocks { references }
            | Call::SetClocks { references, .. }
            | Call::GetSlopes { references, .. } => references,
            _ => unreachable!("{call:?}"),
        };
        let is_set = matches!(call, Call::Set { .. });
        let mut found = Vec::new();
        // Unknown references are wrong arguments.
        for variable in references.iter().filter_map(|reference| self.scenario.description.find(*reference)) {
            let is_registered = self.choices.registered.contains(&variable.reference);
            if condition.allows(variable, is_registered, self.model.is_clock_set) {
                continue;
            }
            match self.deviation(condition, variable, is_set) {
                Some(id) if Deviations::listed().has(id) => found.push(id),
                _ => return Rule::Forbidden("by the variable"),
            }
        }
        found.sort_unstable();
        found.dedup();
        if found.is_empty() { Rule::Allowed } else { Rule::Tolerated(found) }
    }

    fn deviation(&self, condition: Condition, variable: &Variable, is_set: bool) -> Option<&'static str> {
        let is_input = variable.causality == Causality::Input;
        match (condition, self.model.state) {
            (Condition::InitialUnknownOrOutput, _) => Some("all-values-in-initialization"),
            (Condition::HasStart, _) => Some("calculated-values-before-initialization"),
            (Condition::Initial, _) if is_input => Some("inputs-before-initialization"),
            (Condition::Registered, State::Intermediate) if !is_set => Some("unregistered-variables-read"),
            (Condition::ReadableClock, State::Event) if variable.kind == Kind::Clock => {
                Some("output-clock-read-while-input-clock-rests")
            }
            _ => None,
        }
    }

    /// Rules that follow from what was called before, or from the arguments.
    fn further(&self, call: &Call, saved: &dyn Fn(usize) -> Option<Model>) -> Rule {
        let model = self.model;
        let mut found = Vec::new();
        let is_stepping = matches!(model.state, State::Step | State::Activation | State::Intermediate);
        // What was accepted at this point may come again.
        let is_accepted = model.time <= model.last_event.max(model.completed[1]);
        let stays_past_stop = model.state == State::Continuous
            && !is_accepted
            && model.is_past_stop(model.time, model.time - model.earliest());
        match call {
            Call::Get { references, .. } if is_stepping && model.has_set && !references.is_empty() => {
                found.push("read-after-set");
            }
            Call::SetTime(time) if is_clearly_below(*time, model.earliest()) => {
                return Rule::Forbidden("time goes back");
            }
            Call::SetTime(time) if model.stop.is_some_and(|stop| *time > stop) => {
                found.push("solver-past-stop-time");
            }
            Call::CompletedStep { .. } if stays_past_stop => return Rule::Forbidden("past the stop time"),
            Call::Plain(function) if stays_past_stop && function.ends_with("EnterEventMode") => {
                return Rule::Forbidden("past the stop time");
            }
            Call::Activate { time, .. } if model.is_past_stop(*time, model.sample_time) => {
                return Rule::Forbidden("past the stop time");
            }
            Call::Step { point, size, .. } => {
                let begins_there = model.stop.is_some_and(|stop| *point >= stop && point + size > stop);
                if begins_there || model.is_past_stop(point + size, *size) {
                    return Rule::Forbidden("past the stop time");
                }
                if model.stop.is_some_and(|stop| point + size > stop) {
                    found.push("stop-time-by-rounding");
                }
                if model.has_event {
                    found.push("step-with-an-event-left");
                }
                let ticks_alone = self.choices.has_events && !self.choices.may_return_early;
                if ticks_alone && (model.has_event || passes_a_tick(*point, *size, model.sample_time)) {
                    found.push("ticks-within-a-step");
                }
            }
            Call::Activate { time, .. } if !is_multiple(*time, model.sample_time) => {
                found.push("activation-between-ticks");
            }
            Call::Timing { function, .. } if function.starts_with("fmi3SetShift") => {
                return Rule::Declined("shift-not-set");
            }
            Call::SetSlopes { orders, .. } if orders.iter().any(|order| *order > 1) => {
                return Rule::Declined("first-order-slopes");
            }
            Call::Restore { slot } if saved(*slot).is_some_and(|state| state.time < model.promised) => {
                found.push("restored-after-promise");
            }
            Call::SetClocks { values, .. } if values.contains(&0) => found.push("clock-set-inactive"),
            Call::Status { .. } if model.state == State::Step => found.push("status-without-a-reason"),
            Call::Partial { knowns, .. } => self.partial(knowns, &mut found),
            _ => {}
        }
        if is_null_for_nothing(call) {
            found.push("null-for-nothing");
        }
        if model.has_erred {
            found.push("usable-after-error");
        }
        // What is listed no more has to be refused.
        if let Some(id) = found.iter().copied().find(|id| !Deviations::listed().has(id)) {
            return Rule::Forbidden(id);
        }
        if found.is_empty() { Rule::Allowed } else { Rule::Tolerated(found) }
    }

    fn partial(&self, knowns: &[u32], found: &mut Vec<&'static str>) {
        let is_initialised = self.model.state != State::Initialization;
        let find = |reference: &u32| self.scenario.description.find(*reference);
        let is_parameter = |variable: &Variable| variable.causality == Causality::Parameter;
        if self.standard() == Standard::Fmi2
            && is_initialised
            && knowns.iter().filter_map(find).any(is_parameter)
        {
            found.push("derivatives-by-parameters");
        }
    }
}

fn tolerated(id: &'static str) -> Rule {
    if Deviations::listed().has(id) { Rule::Tolerated(vec![id]) } else { Rule::Forbidden(id) }
}

/// By more than rounding.
fn is_clearly_below(time: f64, bound: f64) -> bool {
    time < bound - 1e-12 * bound.abs()
}

fn is_multiple(time: f64, sample_time: f64) -> bool {
    let number = time / sample_time;
    (number - number.round()).abs() < 1e-9 * number.abs().max(1.0)
}

/// Whether a multiple of the sample time lies clearly within a step.
fn passes_a_tick(point: f64, size: f64, sample_time: f64) -> bool {
    let [begin, end] = [point, point + size].map(|time| time / sample_time);
    (end - 1e-6).floor() > (begin + 1e-6).floor()
}

fn is_null_for_nothing(call: &Call) -> bool {
    match call {
        Call::Get { references, is_null, .. } | Call::Set { references, is_null, .. } => {
            *is_null && references.is_empty()
        }
        Call::UpdateDiscreteStates { is_null } | Call::CompletedStep { is_null } => *is_null,
        _ => false,
    }
}
