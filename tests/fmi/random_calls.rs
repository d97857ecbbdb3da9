//! Random sequences of calls, sensible or not: nothing crashes, nothing non-finite comes out, and what is refused
//! leaves no trace.

use core::ptr::{null, null_mut};
use std::cell::Cell;

use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::harness::clocked::Choices;
use super::harness::{CONTROLLER, Component, ERROR, OK, PLANT, Standard, State};
use super::{allowed_calls_fmi2, allowed_calls_fmi3};

/// A call with its arguments. Times are relative to where the instance stands.
#[derive(Clone, Debug)]
enum Call {
    Enter {
        start: f64,
        stop: Option<f64>,
    },
    Exit,
    Terminate,
    Reset,
    Step {
        offset: f64,
        size: f64,
    },
    /// With the function of the variable's type, if there is such a variable.
    Set {
        reference: u32,
        value: f64,
    },
    SetReals {
        values: Vec<(u32, f64)>,
    },
    /// Integers with any reference.
    SetIntegers {
        values: Vec<(u32, i32)>,
    },
    Get {
        references: Vec<u32>,
    },
    NullArrays,
    /// In new memory, or in that of the state before.
    Save {
        anew: bool,
    },
    /// The state saved last, if there is one, or null.
    Restore,
    /// Through bytes, one of them perhaps damaged.
    Deserialise {
        damage: Option<usize>,
    },
    FreeState,
    EnterEventMode,
    UpdateDiscreteStates,
    EnterStepMode,
    /// One of the clocks, or what is none.
    SetClock {
        clock: u32,
        value: u8,
    },
    GetClock {
        clock: u32,
    },
    Activate {
        offset: f64,
    },
    /// Row of the table of all functions.
    Any {
        row: usize,
    },
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0f64,
        2 => select(vec![0.0, 1.0, 2.0, 3.0, 1e-3, 0.0022, -150.0, 0.01]),
        1 => any::<f64>(),
        1 => select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, -0.0, 1e154,
        ]),
    ]
}

fn reference() -> impl Strategy<Value = u32> {
    prop_oneof![8 => 0..34u32, 1 => any::<u32>()]
}

/// Bounded where a step is long, so that the test is not: ticks cost time.
fn step_size() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => select(vec![1e-3, 2.5e-4, 3.7e-3, 1.0 / 60.0, 0.0009999999999999998]),
        1 => select(vec![0.0, -1e-3, f64::NAN, f64::INFINITY, f64::MAX, 1e300, 5e-324, 1e-12]),
    ]
}

fn call() -> impl Strategy<Value = Call> {
    let times = select(vec![0.0, 0.0, 1.0, -2.5, 1e9, f64::NAN, f64::INFINITY, 1.7e308]);
    prop_oneof![
        2 => (times, prop::option::of(number())).prop_map(|(start, stop)| Call::Enter { start, stop }),
        2 => Just(Call::Exit),
        1 => prop::bool::weighted(0.3).prop_map(|end| if end { Call::Terminate } else { Call::NullArrays }),
        1 => prop::bool::weighted(0.3).prop_map(|end| if end { Call::Reset } else { Call::NullArrays }),
        8 => (prop_oneof![6 => Just(0.0), 1 => Just(1e-16), 1 => number()], step_size())
            .prop_map(|(offset, size)| Call::Step { offset, size }),
        8 => (reference(), number()).prop_map(|(reference, value)| Call::Set { reference, value }),
        3 => prop::collection::vec((reference(), number()), 0..5).prop_map(|values| Call::SetReals { values }),
        2 => prop::collection::vec((reference(), -2..200i32), 0..3).prop_map(|values| Call::SetIntegers { values }),
        2 => prop::collection::vec(reference(), 0..6).prop_map(|references| Call::Get { references }),
        2 => any::<bool>().prop_map(|anew| Call::Save { anew }),
        3 => Just(Call::Restore),
        2 => prop::option::of(0..5000usize).prop_map(|damage| Call::Deserialise { damage }),
        1 => Just(Call::FreeState),
        3 => select(vec![Call::EnterEventMode, Call::UpdateDiscreteStates, Call::EnterStepMode]),
        1 => (0..3u32, 0..3u8).prop_map(|(clock, value)| Call::SetClock { clock, value }),
        1 => (0..3u32).prop_map(|clock| Call::GetClock { clock }),
        2 => prop_oneof![3 => Just(1e-3), 1 => number()].prop_map(|offset| Call::Activate { offset }),
        2 => (0..80usize).prop_map(|row| Call::Any { row }),
    ]
}

/// An instance with the state saved last.
struct Actor {
    component: Component,
    state: Cell<State>,
}

impl Actor {
    fn new(component: Component) -> Self {
        Self { component, state: Cell::new(null_mut()) }
    }

    fn save(&self, anew: bool) -> i32 {
        if anew {
            self.free();
        }
        let mut state = self.state.get();
        let status = self.component.get_state(&mut state);
        self.state.set(state);
        status
    }

    fn free(&self) -> i32 {
        let mut state = self.state.get();
        let status = self.component.free_state(&mut state);
        self.state.set(state);
        status
    }

    fn deserialise(&self, damage: Option<usize>) -> i32 {
        let (mut state, mut size) = (self.state.get(), 0);
        let status = self.component.state_size(state, &mut size);
        if status != OK {
            return status;
        }
        let mut bytes = vec![0; size];
        assert_eq!(self.component.serialise_state(state, &mut bytes), OK);
        if let Some(place) = damage {
            bytes[place % size] ^= 1;
        }
        let status = self.component.deserialise_state(&bytes, &mut state);
        self.state.set(state);
        status
    }

    /// Sends a call to the instance, which stands at `now`.
    fn send(&self, now: f64, call: &Call) -> i32 {
        match call {
            Call::Save { anew } => self.save(*anew),
            Call::Restore => self.component.set_state(self.state.get()),
            Call::Deserialise { damage } => self.deserialise(*damage),
            Call::FreeState => self.free(),
            Call::EnterEventMode => self.component.enter_event_mode(),
            _ if self.component.standard == Standard::Fmi3 => self.send_to_clocks(now, call),
            _ => send(&self.component, now, call),
        }
    }
}

impl Actor {
    /// Functions that only FMI 3.0 has.
    fn send_to_clocks(&self, now: f64, call: &Call) -> i32 {
        let component = &self.component;
        let first = component.clocks()[0];
        match call {
            Call::UpdateDiscreteStates => component.end_event_iteration().status,
            Call::EnterStepMode => component.enter_step_mode(),
            Call::SetClock { clock, value } => component.set_clock(first + clock, *value),
            Call::GetClock { clock } => component.get_clock(first + clock).0,
            Call::Activate { offset } => component.activate(now + offset),
            _ => send(component, now, call),
        }
    }
}

impl Drop for Actor {
    fn drop(&mut self) {
        assert_eq!(self.free(), OK);
    }
}

/// Sends a call that needs no state to an instance that stands at `now`.
fn send(component: &Component, now: f64, call: &Call) -> i32 {
    match call {
        // Of these FMI 2.0 has none.
        Call::UpdateDiscreteStates
        | Call::EnterStepMode
        | Call::SetClock { .. }
        | Call::GetClock { .. }
        | Call::Activate { .. } => OK,
        Call::Save { .. }
        | Call::Restore
        | Call::Deserialise { .. }
        | Call::FreeState
        | Call::EnterEventMode => unreachable!(),
        Call::Enter { start, stop } => component.enter_initialization(*start, *stop),
        Call::Exit => component.exit_initialization(),
        Call::Terminate => component.terminate(),
        Call::Reset => component.reset(),
        Call::Step { offset, size } => component.step(now + offset, *size),
        // A sample time below 1 ms would make the steps expensive.
        Call::Set { reference, value } if component.description.variables.len() as u32 <= *reference => {
            component.set_reals(&[*reference], &[*value])
        }
        Call::Set { reference, value } => component.set_reference(*reference, *value),
        Call::SetReals { values } => {
            let (references, values): (Vec<_>, Vec<_>) = values.iter().copied().unzip();
            component.set_reals(&references, &values)
        }
        Call::SetIntegers { values } => {
            let (r, v): (Vec<u32>, Vec<i32>) = values.iter().copied().unzip();
            // SAFETY: as many values as references.
            unsafe {
                match component.standard {
                    Standard::Fmi2 => fmi2SetInteger(component.handle, r.as_ptr(), r.len(), v.as_ptr()),
                    Standard::Fmi3 => {
                        fmi3SetInt32(component.handle, r.as_ptr(), r.len(), v.as_ptr(), v.len())
                    }
                }
            }
        }
        Call::Get { references } => component.get_reals(references, &mut vec![0.0; references.len()]),
        // SAFETY: null is checked.
        Call::NullArrays => unsafe {
            match component.standard {
                Standard::Fmi2 => fmi2SetReal(component.handle, null(), 3, null()),
                Standard::Fmi3 => fmi3GetFloat64(component.handle, null(), 2, null_mut(), 2),
            }
        },
        Call::Any { row } => {
            let table = match component.standard {
                Standard::Fmi2 => allowed_calls_fmi2::table(),
                Standard::Fmi3 => allowed_calls_fmi3::table(),
            };
            // SAFETY: a live handle, valid arguments.
            unsafe { (table[row % table.len()].call)(component.handle) }
        }
    }
}

/// Half of the sequences begin with an instance that is ready to step.
fn calls() -> impl Strategy<Value = Vec<Call>> {
    (any::<bool>(), prop::collection::vec(call(), 1..80)).prop_map(|(is_ready, mut calls)| {
        if is_ready {
            calls.splice(0..0, [Call::Enter { start: 0.0, stop: None }, Call::Exit]);
        }
        calls
    })
}

/// Where the instance stands, as far as it can be asked.
fn now(component: &Component) -> f64 {
    match component.get_reference(0) {
        (OK, time) => time,
        _ => 0.0,
    }
}

/// The wild one gets every call, the tidy one only those that the wild one did not refuse.
fn check(make: fn() -> Component, calls: &[Call], counts: &mut [u32; 2]) -> Result<(), TestCaseError> {
    let (wild_actor, tidy_actor) = (Actor::new(make()), Actor::new(make()));
    let (wild, tidy) = (&wild_actor.component, &tidy_actor.component);
    // Steps are cheap only if there are few ticks in them.
    let sample_time = wild.description.is_sampled().then(|| wild.reference("sample_time"));
    for call in calls {
        let shortens = match call {
            Call::Set { reference, value } => Some(*reference) == sample_time && *value < 1e-3,
            Call::SetReals { values } => {
                values.iter().any(|(reference, value)| Some(*reference) == sample_time && *value < 1e-3)
            }
            _ => false,
        };
        if shortens {
            continue;
        }
        let time = now(wild);
        wild.recorder.clear();
        let status = wild_actor.send(time, call);
        if status == OK {
            counts[0] += 1;
            prop_assert_eq!(tidy_actor.send(time, call), OK, "{:?}", call);
        } else {
            counts[1] += 1;
            // Discard is for FMI 2.0's status functions.
            prop_assert!(status == ERROR || status == 2, "{:?} {}", call, status);
            prop_assert!(!wild.recorder.messages().is_empty());
        }
        let values = wild.snapshot();
        prop_assert!(values.iter().all(|bits| f64::from_bits(*bits).is_finite()), "{:?}", call);
        prop_assert_eq!(values, tidy.snapshot(), "after {:?}", call);
    }
    Ok(())
}

fn run(make: fn() -> Component) {
    let config = Config { cases: 250, failure_persistence: None, ..Config::default() };
    let generator = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut counts = [0, 0];
    let counts_cell = std::cell::RefCell::new(&mut counts);
    TestRunner::new_with_rng(config, generator)
        .run(&calls(), |calls| check(make, &calls, &mut counts_cell.borrow_mut()))
        .unwrap();
    println!("{} calls done, {} refused", counts[0], counts[1]);
    assert!(counts.iter().all(|count| *count > 1000), "{counts:?}");
}

#[test]
fn fmi2_plant_survives_anything() {
    run(|| Component::new(Standard::Fmi2, PLANT));
}

#[test]
fn fmi2_controller_survives_anything() {
    run(|| Component::new(Standard::Fmi2, CONTROLLER));
}

#[test]
fn fmi3_plant_survives_anything() {
    run(|| Component::new(Standard::Fmi3, PLANT));
}

#[test]
fn fmi3_controller_survives_anything() {
    run(|| Component::new(Standard::Fmi3, CONTROLLER));
}

#[test]
fn a_controller_with_events_survives_anything() {
    const EVENTS: Choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
    run(|| Component::co_simulation(CONTROLLER, EVENTS));
}

#[test]
fn a_scheduled_controller_survives_anything() {
    run(|| Component::scheduled(CONTROLLER, None));
}
