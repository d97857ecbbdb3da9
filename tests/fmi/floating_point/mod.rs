//! Hosts that let exceptions trap, round otherwise or flush small numbers: the models compute the same bits, and the
//! control word is the host's own again after every call and within its callbacks.

mod callbacks;
pub mod host;

use core::ptr::null_mut;
use std::hint::black_box;

use host::{DEFAULT, ENVIRONMENTS, hosted};
use maglev_fmu::model::variable::{Causality, Kind, Variable};
use maglev_fmu::model::{Description, models};
use proptest::prelude::*;
use proptest::sample::select;

use super::harness::clocked::{Choices, sampled_models};
use super::harness::{BOTH, CONTROLLER, Component, description, plants};

/// What a life consists of: parameters, then an input row per step of 1 ms.
#[derive(Clone, Debug, Default)]
struct Script {
    parameters: Vec<(u32, f64)>,
    rows: Vec<Vec<f64>>,
}

type Trace = Vec<(i32, Vec<u64>)>;

fn inputs(component: &Component) -> Vec<u32> {
    let rows = (0u32..).zip(component.description.variables);
    rows.filter(|(_, row)| row.causality == Causality::Input).map(|(reference, _)| reference).collect()
}

/// Every status and every value of a life in a host with this control word.
fn life(
    make: impl Fn() -> Component,
    script: &Script,
    word: u32,
    step: impl Fn(&Component, f64) -> i32,
) -> Trace {
    let component = hosted(word, make);
    let mut trace = Trace::new();
    let mut note = |call: &dyn Fn() -> i32| {
        let status = hosted(word, call);
        trace.push((status, hosted(word, || component.snapshot())));
    };
    for (reference, value) in &script.parameters {
        note(&|| component.set_reference(*reference, *value));
    }
    note(&|| component.enter_initialization(0.0, None));
    note(&|| component.exit_initialization());
    let (mut state, half) = (null_mut(), script.rows.len() / 2);
    let references = inputs(&component);
    for (index, row) in script.rows.iter().enumerate() {
        let time = index as f64 * 1e-3;
        if index == half {
            hosted(word, || component.get_state(&mut state));
        }
        note(&|| component.set_reals(&references, row));
        note(&|| step(&component, time));
    }
    note(&|| component.set_state(state));
    hosted(word, || component.free_state(&mut state));
    note(&|| component.terminate());
    note(&|| component.reset());
    hosted(word, || drop(component));
    trace
}

#[track_caller]
fn assert_same_everywhere(
    make: impl Fn() -> Component,
    script: &Script,
    step: impl Fn(&Component, f64) -> i32,
) {
    let expected = life(&make, script, DEFAULT, &step);
    for word in ENVIRONMENTS {
        let found = life(&make, script, word, &step);
        assert!(found == expected, "{word:#x}: {script:?}");
    }
}

fn do_step(component: &Component, time: f64) -> i32 {
    component.step(time, 1e-3)
}

/// 0/0 in the reduced observer: no flux, no voltage, no movement.
#[test]
fn a_division_of_zero_by_zero_that_is_dropped_does_not_trap() {
    for standard in BOTH {
        let make = || Component::new(standard, CONTROLLER);
        let reference = |name| make().reference(name);
        let parameters =
            [("observer.kind", 2.0), ("observer.initial.flux", 0.0), ("controller.initial_voltage", 0.0)];
        let script = Script {
            parameters: parameters.map(|(name, value)| (reference(name), value)).to_vec(),
            rows: vec![vec![0.0; inputs(&make()).len()]; 20],
        };
        assert_same_everywhere(make, &script, do_step);
    }
}

/// An overflow in the regression: one reading of 1e5 A.
#[test]
fn an_overflow_that_is_dropped_does_not_trap() {
    for standard in BOTH {
        for kind in [1.0, 2.0, 3.0] {
            let make = || Component::new(standard, "LevitatedBallController");
            let component = make();
            let current = component.reference("current");
            let mut rows = vec![vec![0.0; inputs(&component).len()]; 20];
            let place = inputs(&component).iter().position(|input| *input == current).unwrap();
            rows[10][place] = 1e5;
            let parameters = vec![(component.reference("observer.kind"), kind)];
            assert_same_everywhere(make, &Script { parameters, rows }, do_step);
        }
    }
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0f64,
        2 => -1e3..1e3f64,
        2 => any::<f64>(),
        2 => select(vec![0.0, -0.0, 1e5, -1e5, 1e154, -1e300, 5e-324, 1e-310, f64::MAX, f64::NAN, f64::INFINITY]),
    ]
}

/// Where no number makes a plant integrate for minutes.
fn tame_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0..1.0f64, 2 => -50.0..50.0f64, 1 => select(vec![0.0, -0.0, 5e-324, 1e-310, f64::NAN])]
}

/// A value that a parameter takes, more often than not.
fn parameter_value(model: &Description, variable: &'static Variable) -> BoxedStrategy<f64> {
    let (low, high) = variable.range;
    match variable.kind {
        Kind::Real(_) if !model.is_sampled() => {
            let start = variable.start;
            (0.5..2.0f64).prop_map(move |share| share * start).boxed()
        }
        Kind::Real(_) if variable.name == "sample_time" => (1e-3..2e-3f64).boxed(),
        Kind::Real(_) => {
            let start = variable.start;
            prop_oneof![2 => (0.5..2.0f64).prop_map(move |share| share * start),
                1 => select(vec![low, high, 0.0, start]), 1 => number()]
            .boxed()
        }
        Kind::Integer => select(vec![low, variable.start, low + 1.0]).boxed(),
        Kind::Boolean => select(vec![0.0, 1.0]).boxed(),
        Kind::Enumeration(enumeration) => (1..=enumeration.items.len()).prop_map(|item| item as f64).boxed(),
    }
}

fn script(model: &'static str) -> impl Strategy<Value = Script> {
    let description = description(model);
    let rows = || (0u32..).zip(description.variables);
    let parameters: Vec<_> = rows()
        .filter(|(_, row)| row.causality == Causality::Parameter)
        .map(|(reference, row)| (Just(reference), parameter_value(description, row)).boxed())
        .collect();
    let width = rows().filter(|(_, row)| row.causality == Causality::Input).count();
    let parameters = prop::collection::vec(proptest::strategy::Union::new(parameters), 0..5);
    let number = if description.is_sampled() { number().boxed() } else { tame_number().boxed() };
    let rows = prop::collection::vec(prop::collection::vec(number, width), 1..25);
    (parameters, rows).prop_map(|(parameters, rows)| Script { parameters, rows })
}

/// Runs `check` with random lives of every model that `is_meant`.
fn for_random_lives(is_meant: impl Fn(&str) -> bool, check: impl Fn(&'static str, &Script)) {
    for model in models().map(|model| model.description.name).filter(|name| is_meant(name)) {
        let config = ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() };
        proptest!(config, |(script in script(model))| {
            check(model, &script);
        });
    }
}

#[test]
fn steps_of_all_models_are_the_same_in_every_host() {
    for_random_lives(
        |_| true,
        |model, script| {
            for standard in BOTH {
                assert_same_everywhere(|| Component::new(standard, model), script, do_step);
            }
        },
    );
}

#[test]
fn ticks_at_events_and_on_activation_are_the_same_in_every_host() {
    let at_event = |component: &Component, time: f64| {
        component.enter_event_mode();
        component.set_clock(component.clocks()[0], 1);
        while component.end_event_iteration().is_unfinished {}
        component.enter_step_mode();
        component.step_to_event(time, 1e-3).status
    };
    let events = Choices { event_mode: true, early_return: true, intermediate_update: None };
    for_random_lives(
        |model| sampled_models().any(|sampled| sampled == model),
        |model, script| {
            assert_same_everywhere(|| Component::co_simulation(model, events), script, at_event);
            assert_same_everywhere(|| Component::scheduled(model, None), script, Component::activate);
        },
    );
}

#[test]
fn derivatives_are_the_same_in_every_host() {
    let integrate = |component: &Component, time: f64| -> i32 {
        component.set_time(time);
        let state = [time, -time, 1e200, 1e-320];
        let mut sensitivity = [0.0];
        let statuses = [
            component.try_update_discrete_states().0,
            component.enter_continuous_time(),
            component.set_states(&state[..component.state_count()]),
            component
                .description
                .continuous_states()
                .map(|(state, derivative)| {
                    component.directional(&[derivative as u32], &[state as u32], &[1.0], &mut sensitivity)
                })
                .sum(),
            component.enter_event_mode(),
        ];
        black_box(sensitivity);
        statuses.iter().sum()
    };
    for (standard, plant) in plants() {
        for_random_lives(
            |model| model == plant,
            |model, script| {
                assert_same_everywhere(|| Component::exchanged(standard, model), script, integrate)
            },
        );
    }
}
