//! What may be reached may be saved and restored: after any legal calls, with values at declared limits and beyond what
//! can be computed, an instance takes its own state.

use maglev_fmu::fmi::fmi2::fmi2SetRealInputDerivatives;
use maglev_fmu::model::models;
use maglev_fmu::model::variable::{Causality, Kind, Variability, Variable};
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::harness::{BOTH, Component, ERROR, OK, Standard};

#[derive(Clone, Debug)]
enum Call {
    /// Row, as a share of the table, and which of its values.
    Set(f64, Choice),
    Slope(f64, f64),
    Step(f64),
    States(Vec<f64>),
    EnterEventMode,
    EndIteration,
    EnterContinuousTime,
    Time(f64),
}

#[derive(Clone, Debug)]
enum Choice {
    Smallest,
    Largest,
    Start,
    Between(f64),
    Any(f64),
}

fn huge() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0f64,
        2 => select(vec![1e200, -1e200, 1.7e308, -1.7e308, 1e154, 5e-324, 0.0, 1e6]),
        1 => prop::num::f64::NORMAL,
    ]
}

fn call() -> impl Strategy<Value = Call> {
    let choice = prop_oneof![
        Just(Choice::Smallest),
        Just(Choice::Largest),
        Just(Choice::Start),
        (0.0..1.0f64).prop_map(Choice::Between),
        huge().prop_map(Choice::Any),
    ];
    prop_oneof![
        6 => (0.0..1.0f64, choice).prop_map(|(row, choice)| Call::Set(row, choice)),
        3 => (0.0..1.0f64, huge()).prop_map(|(row, slope)| Call::Slope(row, slope)),
        6 => select(vec![1e-3, 1e-4, 1.0 / 60.0, 3.7e-3]).prop_map(Call::Step),
        4 => prop::collection::vec(huge(), 3).prop_map(Call::States),
        2 => Just(Call::EnterEventMode),
        2 => Just(Call::EndIteration),
        3 => Just(Call::EnterContinuousTime),
        2 => huge().prop_map(Call::Time),
    ]
}

/// A value of the variable, cheap to compute with: few iterations, no short sample times.
fn value(variable: &Variable, choice: &Choice) -> f64 {
    let (smallest, largest) = match (variable.kind, variable.name) {
        (Kind::Boolean, _) => (0.0, 1.0),
        (Kind::Enumeration(enumeration), _) => (1.0, enumeration.items.len() as f64),
        (_, "observer.max_iterations" | "observer.substeps") => (variable.range.0, 20.0),
        (_, "sample_time") => (1e-4, 1.0),
        _ => (variable.range.0.max(-1.7e308), variable.range.1.min(1.7e308)),
    };
    let chosen = match choice {
        Choice::Smallest => smallest,
        Choice::Largest => largest,
        Choice::Start => variable.start,
        Choice::Between(share) => smallest + share * (largest - smallest).min(f64::MAX),
        Choice::Any(value) => *value,
    };
    let chosen = chosen.clamp(smallest, largest);
    if matches!(variable.kind, Kind::Real(_)) { chosen } else { chosen.floor() }
}

fn send(component: &Component, call: &Call, is_initialised: bool) -> i32 {
    let of = |share: f64, keep: fn(&Variable) -> bool| {
        let count = component.description.variables.len() as u32;
        let rows: Vec<u32> = (0..count).filter(|row| keep(component.variable(*row))).collect();
        rows[(share * rows.len() as f64) as usize]
    };
    let may_change = |row: &Variable| {
        row.causality == Causality::Input
            || row.causality == Causality::Parameter && row.variability == Variability::Tunable
    };
    match call {
        Call::Set(share, choice) => {
            let row = of(*share, if is_initialised { may_change } else { |row| !row.is_calculated() });
            component.set_reference(row, value(component.variable(row), choice))
        }
        Call::Slope(share, slope) if component.standard == Standard::Fmi2 => {
            let row = of(*share, |row| row.causality == Causality::Input);
            // SAFETY: a live handle, arrays of one element.
            unsafe { fmi2SetRealInputDerivatives(component.handle, &row, 1, &1, slope) }
        }
        Call::Slope(..) => OK,
        Call::Step(size) => component.step(component.get("time"), *size),
        Call::States(states) => {
            let count = component.state_count().min(states.len());
            component.set_states(&states[..count])
        }
        Call::EnterEventMode => component.enter_event_mode(),
        Call::EndIteration => component.try_update_discrete_states().0,
        Call::EnterContinuousTime => component.enter_continuous_time(),
        Call::Time(time) => component.set_time(*time),
    }
}

/// The bytes of the state, which have to be taken back.
fn round_trip(component: &Component, context: &dyn core::fmt::Debug) -> Result<(), TestCaseError> {
    let mut state = core::ptr::null_mut();
    prop_assert_eq!(component.get_state(&mut state), OK);
    let status = component.set_state(state);
    prop_assert_eq!(status, OK, "after {:?}: {:?}", context, component.recorder.messages());
    prop_assert_eq!(component.free_state(&mut state), OK);
    let bytes = component.saved_bytes();
    prop_assert_eq!(component.restore_bytes(&bytes), OK, "after {:?}", context);
    prop_assert_eq!(component.saved_bytes(), bytes, "after {:?}", context);
    Ok(())
}

#[test]
fn every_state_that_is_reached_is_taken_back() {
    for model in models().map(|model| model.description) {
        let makes = BOTH.into_iter().flat_map(|standard| {
            let stepped = move || Component::with_logging(standard, model.name, true);
            let exchanged = move || Component::exchanged(standard, model.name);
            let mut makes: Vec<Box<dyn Fn() -> Component>> = vec![Box::new(stepped)];
            if model.offers_model_exchange() {
                makes.push(Box::new(exchanged));
            }
            makes
        });
        for make in makes {
            let config = Config { cases: 150, failure_persistence: None, ..Config::default() };
            let calls = || prop::collection::vec(call(), 1..30);
            TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
                .run(&(calls(), calls()), |(before, after)| {
                    let component = make();
                    prop_assert_eq!(component.enter_initialization(0.0, None), OK);
                    for call in before.iter().filter(|call| matches!(call, Call::Set(..))) {
                        prop_assert_eq!(send(&component, call, false), OK, "{:?}", call);
                        round_trip(&component, call)?;
                    }
                    // Parameters that do not fit together.
                    if component.exit_initialization() == ERROR {
                        return Ok(());
                    }
                    for call in &after {
                        send(&component, call, true);
                        component.recorder.clear();
                        round_trip(&component, call)?;
                    }
                    Ok(())
                })
                .unwrap();
        }
    }
}

#[test]
fn a_force_that_would_leave_its_range_is_refused_at_the_step() {
    for model in models().map(|model| model.description).filter(|model| model.offers_model_exchange()) {
        for row in model.variables.iter().filter(|row| row.causality == Causality::Input) {
            let component = Component::new(Standard::Fmi2, model.name);
            component.initialise(0.0);
            component.recorder.clear();
            let largest = row.range.1.min(f64::MAX);
            assert_eq!(component.set(row.name, largest), OK);
            let (reference, slope) = (component.reference(row.name), largest);
            // SAFETY: a live handle, arrays of one element.
            let status = unsafe { fmi2SetRealInputDerivatives(component.handle, &reference, 1, &1, &slope) };
            assert_eq!(status, OK);
            let said = ["an input with a slope leaves its range within the step", row.name];
            component.assert_refused(component.step(0.0, 1e-3), &said);
            assert_eq!(component.get(row.name), largest);
            assert_eq!(component.restore_bytes(&component.saved_bytes()), OK);
        }
    }
}
