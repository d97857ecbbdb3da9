//! Whether arguments make sense, by the model description and by what went before.

use super::super::harness::Standard;
use super::super::standard::{Causality, Kind, ModelDescription, State, Variability, Variable};
use super::call::{Call, Category, Damage, Experiment};
use super::model::Model;
use super::oracle::Oracle;

/// What comes of a call that is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arguments {
    /// OK.
    Good,
    /// OK, or Discard if a value overflows.
    Computed,
    /// The model may have its reasons.
    Open,
    /// Error or Discard.
    Wrong,
    /// Discard.
    Unanswerable,
}
use Arguments::{Computed, Good, Open, Unanswerable, Wrong};

pub fn judge(oracle: &Oracle, call: &Call, saved: &dyn Fn(usize) -> Option<Model>) -> Arguments {
    let (model, description) = (oracle.model, oracle.scenario.description);
    let is_initial = matches!(model.state, State::Instantiated | State::Initialization);
    // What initialisation computes may be refused with the parameters that were set.
    let unless_changed = |otherwise| if is_initial && model.may_be_refused() { Open } else { otherwise };
    match call {
        Call::Logging { categories, is_null, .. } => {
            let is_wrong = |category: &Category| !matches!(category, Category::Declared(_));
            wrong_if((*is_null && !categories.is_empty()) || categories.iter().any(is_wrong))
        }
        Call::Setup(experiment) => begin(experiment),
        Call::EnterInitialization(experiment) if oracle.standard() == Standard::Fmi3 => begin(experiment),
        Call::EnterInitialization(_) => Good,
        Call::Plain(function) if function.ends_with("ExitInitializationMode") => {
            if model.may_be_refused() {
                Open
            } else {
                Good
            }
        }
        // By how much rounding alone carries time past its end is the library's to know.
        Call::Plain("fmi2EnterEventMode" | "fmi3EnterEventMode") | Call::CompletedStep { .. }
            if model.state == State::Continuous && model.stop.is_some_and(|stop| model.time > stop) =>
        {
            Open
        }
        Call::Plain(_) | Call::UpdateDiscreteStates { .. } | Call::CompletedStep { .. } | Call::Count(_) => {
            Good
        }
        Call::Get { function, references, room, is_null } => {
            match access(description, function, references, *room, *is_null) {
                Good if function.ends_with("Real") || function.ends_with("Float64") => {
                    unless_changed(Computed)
                }
                Good => unless_changed(Good),
                other => other,
            }
        }
        Call::Set { function, references, values, room, is_null } => {
            match access(description, function, references, *room, *is_null) {
                Good => set(oracle, function, references, values, is_initial),
                other => other,
            }
        }
        Call::SetTime(time) => {
            // Back by rounding only is nothing to refuse, and nothing to expect.
            let is_past = model.stop.is_some_and(|stop| *time > stop);
            if *time < model.earliest() || is_past { Open } else { wrong_if(!time.is_finite()) }
        }
        Call::SetStates { states, is_null } => {
            let is_wrong = states.len() != description.state_count || (*is_null && !states.is_empty());
            if is_wrong || states.iter().any(|state| !state.is_finite()) { Wrong } else { Computed }
        }
        Call::GetVector { function, length, is_null } => {
            let is_of_indicators = function.ends_with("EventIndicators");
            let expected =
                if is_of_indicators { description.event_indicator_count } else { description.state_count };
            if *length != expected || (*is_null && *length > 0) {
                Wrong
            } else if function.ends_with("NominalsOfContinuousStates") {
                Good
            } else {
                unless_changed(Computed)
            }
        }
        Call::Step { point, size, .. } => step(model, *point, *size),
        Call::Activate { clock, time } => {
            let follows = match model.last_activation {
                Some(last) => *time > last && *time >= model.time,
                None => *time >= model.time,
            };
            let is_wrong = !is_input_clock(description, *clock) || !time.is_finite() || !follows;
            let is_past = model.stop.is_some_and(|stop| *time > stop);
            if !is_wrong && is_past { Open } else { wrong_if(is_wrong) }
        }
        Call::GetClocks { references } => {
            wrong_if(!references.iter().all(|reference| is_clock(description, *reference)))
        }
        Call::SetClocks { references, values } => {
            let are_clocks = references.iter().all(|reference| is_input_clock(description, *reference));
            match (are_clocks, values.is_empty()) {
                (false, _) => Wrong,
                (true, true) => Good,
                (true, false) if values.iter().all(|value| *value == 0) && !model.is_clock_set => Good,
                // Whether a tick is due is the model's to know.
                (true, false) => Open,
            }
        }
        Call::Timing { references, .. } => {
            if !references.iter().all(|reference| is_input_clock(description, *reference)) {
                Wrong
            } else if references.is_empty() {
                unless_changed(Good)
            } else if model.is_changed || model.start != 0.0 {
                // Not every sample time and start time has an exact fraction.
                Open
            } else {
                Good
            }
        }
        Call::Partial { function, unknowns, knowns, seed } => {
            match partial(oracle, function, unknowns, knowns, seed) {
                Good => unless_changed(Computed),
                other => other,
            }
        }
        Call::SetSlopes { references, orders, values } => {
            let is_continuous_input = |variable: &Variable| {
                variable.causality == Causality::Input && variable.variability == Variability::Continuous
            };
            let are_inputs = all(description, references, is_continuous_input);
            let are_finite = values.iter().all(|value| value.is_finite());
            wrong_if(!are_inputs || !are_finite || orders.iter().any(|order| *order != 1))
        }
        Call::GetSlopes { references, orders } => {
            let is_output =
                |variable: &Variable| variable.causality == Causality::Output && variable.kind == Kind::Real;
            let is_wrong = !all(description, references, is_output) || orders.iter().any(|order| *order != 1);
            if is_wrong { Wrong } else { Computed }
        }
        Call::Status { function, kind } => {
            let answers = [
                ("fmi2GetStatus", 0),
                ("fmi2GetStringStatus", 1),
                ("fmi2GetRealStatus", 2),
                ("fmi2GetBooleanStatus", 3),
            ];
            if answers.contains(&(*function, *kind)) { Good } else { Unanswerable }
        }
        Call::Dependencies(_) => Good,
        Call::Save { .. } | Call::Free { .. } => Good,
        Call::Restore { slot } => match saved(*slot) {
            None => Wrong,
            // Made of forged bytes, or by another interface type.
            Some(state) if !state.is_known => Open,
            Some(_) => Good,
        },
        Call::Size { slot } => wrong_if(saved(*slot).is_none()),
        Call::Serialise { slot, shortage } => wrong_if(saved(*slot).is_none() || *shortage > 0),
        // Judged by the session, which has the bytes.
        Call::Deserialise { damage, .. } => match damage {
            Damage::None | Damage::Forge { .. } => Open,
            Damage::Flip { .. } | Damage::Cut { .. } => Wrong,
        },
    }
}

fn wrong_if(is_wrong: bool) -> Arguments {
    if is_wrong { Wrong } else { Good }
}

fn begin(experiment: &Experiment) -> Arguments {
    let Experiment { start, stop, .. } = *experiment;
    wrong_if(!start.is_finite() || stop.is_some_and(|stop| stop.is_nan() || stop < start))
}

/// Kinds of variables that a getter or setter carries; none for types that no model has.
fn kinds(function: &str) -> &'static [Kind] {
    match &function[7..] {
        "Real" | "Float64" => &[Kind::Real],
        "Integer" => &[Kind::Integer, Kind::Enumeration],
        "Int32" => &[Kind::Integer],
        "Int64" => &[Kind::Enumeration],
        "Boolean" => &[Kind::Boolean],
        _ => &[],
    }
}

fn access(
    description: &ModelDescription,
    function: &str,
    references: &[u32],
    room: usize,
    is_null: bool,
) -> Arguments {
    let kinds = kinds(function);
    let is_of_type = |variable: &Variable| kinds.contains(&variable.kind);
    wrong_if(
        room != references.len()
            || (is_null && !references.is_empty())
            || !all(description, references, is_of_type),
    )
}

fn set(oracle: &Oracle, function: &str, references: &[u32], values: &[f64], is_initial: bool) -> Arguments {
    let mut arguments = Good;
    for (reference, value) in references.iter().zip(values) {
        let Some(variable) = oracle.scenario.description.find(*reference) else { return Wrong };
        let value = match &function[7..] {
            "Integer" | "Int32" => f64::from(*value as i32),
            "Int64" => *value as i64 as f64,
            _ => *value,
        };
        let (smallest, largest) = variable.range;
        let fits =
            variable.kind == Kind::Boolean || (value.is_finite() && value >= smallest && value <= largest);
        if !fits {
            return Wrong;
        }
        // Parameters may not go together.
        if !is_initial && variable.causality == Causality::Parameter {
            arguments = Open;
        }
    }
    arguments
}

fn step(model: &Model, point: f64, size: f64) -> Arguments {
    let end = point + size;
    if !(size.is_finite() && size > 0.0 && point.is_finite() && end.is_finite()) {
        return Wrong;
    }
    // A few units in the last place, or as many of the step before as rounding may make of it.
    let rounding = 1e-13 * point.abs().max(model.time.abs());
    if (point - model.time).abs() > rounding.max(2e-9 * model.last_step) { Wrong } else { Open }
}

fn is_clock(description: &ModelDescription, reference: u32) -> bool {
    description.find(reference).is_some_and(|variable| variable.kind == Kind::Clock)
}

fn is_input_clock(description: &ModelDescription, reference: u32) -> bool {
    let is_input = |variable: &Variable| variable.causality == Causality::Input;
    is_clock(description, reference) && description.find(reference).is_some_and(is_input)
}

fn all(description: &ModelDescription, references: &[u32], holds: impl Fn(&Variable) -> bool) -> bool {
    references.iter().all(|reference| description.find(*reference).is_some_and(&holds))
}

/// FMI 2.0.5, sections 2.1.9 and 2.2.8; FMI 3.0.2, sections 2.2.12 and 2.4.8.
fn partial(oracle: &Oracle, function: &str, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Arguments {
    let is_initial = oracle.model.state == State::Initialization;
    let is_real = |variable: &Variable| variable.kind == Kind::Real;
    let is_unknown = |variable: &Variable| {
        is_real(variable)
            && if is_initial {
                variable.is_initial_unknown
            } else {
                variable.causality == Causality::Output || variable.is_state_derivative
            }
    };
    let is_known = |variable: &Variable| {
        is_real(variable)
            && match variable.causality {
                Causality::Input | Causality::Independent | Causality::Parameter => true,
                _ => !is_initial && variable.is_state,
            }
    };
    let expected = if function.ends_with("AdjointDerivative") { unknowns.len() } else { knowns.len() };
    let description = oracle.scenario.description;
    let is_wrong = seed.len() != expected
        || !all(description, unknowns, is_unknown)
        || !all(description, knowns, is_known);
    wrong_if(is_wrong)
}
