//! Random sequences of calls on plants of both interface types, with what moves in continuous time: nothing crashes,
//! nothing non-finite comes out, and what is refused leaves no trace.

use maglev_fmu::fmi::fmi2::fmi2SetRealInputDerivatives;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::harness::{Component, DISCARD, ERROR, OK, Standard, plants};

/// A call with its arguments.
#[derive(Clone, Debug)]
enum Call {
    Enter,
    Exit,
    EnterEventMode,
    EnterContinuousTimeMode,
    UpdateDiscreteStates,
    SetTime(f64),
    SetStates(Vec<f64>),
    Step(f64),
    Set(u32, f64),
    Slope(u32, i32, f64),
    Directional(u32, u32, f64),
    Reset,
    Terminate,
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -1.0..1.0f64,
        3 => -1e-2..1e-2f64,
        1 => select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::MAX, -1e200, 5e-324, 1e154]),
    ]
}

fn call() -> impl Strategy<Value = Call> {
    let reference = || prop_oneof![4 => 0..12u32, 4 => 0..45u32, 1 => any::<u32>()];
    prop_oneof![
        1 => Just(Call::Enter),
        1 => Just(Call::Exit),
        4 => Just(Call::EnterEventMode),
        4 => Just(Call::EnterContinuousTimeMode),
        4 => Just(Call::UpdateDiscreteStates),
        3 => number().prop_map(Call::SetTime),
        8 => prop::collection::vec(number(), 2..4).prop_map(Call::SetStates),
        6 => select(vec![1e-4, 1e-3, 1.0 / 60.0, 0.0, f64::NAN]).prop_map(Call::Step),
        6 => (reference(), number()).prop_map(|(row, value)| Call::Set(row, value)),
        4 => (reference(), 0..3, number()).prop_map(|(row, order, value)| Call::Slope(row, order, value)),
        4 => (reference(), reference(), -1.0..1.0f64).prop_map(|(one, other, seed)| Call::Directional(one, other, seed)),
        1 => prop::bool::weighted(0.2).prop_map(|end| if end { Call::Reset } else { Call::EnterContinuousTimeMode }),
        1 => prop::bool::weighted(0.1).prop_map(|end| if end { Call::Terminate } else { Call::UpdateDiscreteStates }),
    ]
}

fn send(component: &Component, now: f64, call: &Call) -> i32 {
    match call {
        Call::Enter => component.enter_initialization(0.0, None),
        Call::Exit => component.exit_initialization(),
        Call::EnterEventMode => component.enter_event_mode(),
        Call::EnterContinuousTimeMode => component.enter_continuous_time(),
        Call::UpdateDiscreteStates => component.try_update_discrete_states().0,
        Call::SetTime(time) => component.set_time(*time),
        Call::SetStates(states) => component.set_states(states),
        Call::Step(size) => component.step(now, *size),
        Call::Set(row, value) if (*row as usize) < component.description.variables.len() => {
            component.set_reference(*row, *value)
        }
        Call::Set(row, value) => component.set_reals(&[*row], &[*value]),
        Call::Slope(row, order, value) if component.standard == Standard::Fmi2 => {
            // SAFETY: a live handle, arrays of one element.
            unsafe { fmi2SetRealInputDerivatives(component.handle, row, 1, order, value) }
        }
        Call::Slope(row, _, value) => component.directional(&[*row], &[*row], &[*value], &mut [0.0]),
        Call::Directional(unknown, known, seed) => {
            component.directional(&[*unknown], &[*known], &[*seed], &mut [0.0])
        }
        Call::Reset => component.reset(),
        Call::Terminate => component.terminate(),
    }
}

fn now(component: &Component) -> f64 {
    let (status, time) = component.get_reference(0);
    component.recorder.clear();
    if status == OK { time } else { 0.0 }
}

/// The wild one gets every call, the tidy one only those that the wild one did not refuse.
fn check(new: impl Fn() -> Component, calls: &[Call], counts: &mut [u32; 2]) -> Result<(), TestCaseError> {
    let (wild, tidy) = (new(), new());
    for call in calls {
        let time = now(&wild);
        let status = send(&wild, time, call);
        if status == OK {
            counts[0] += 1;
            prop_assert_eq!(send(&tidy, time, call), OK, "{:?}", call);
        } else {
            counts[1] += 1;
            prop_assert!(status == ERROR || status == DISCARD, "{:?} {}", call, status);
            prop_assert!(!wild.recorder.messages().is_empty());
        }
        let values = wild.snapshot();
        prop_assert!(values.iter().all(|bits| f64::from_bits(*bits).is_finite()), "{:?}", call);
        prop_assert_eq!(values, tidy.snapshot(), "after {:?}", call);
    }
    Ok(())
}

#[test]
fn plants_survive_anything_in_both_interfaces() {
    for (standard, unit) in plants() {
        for exchanged in [false, true] {
            let new = || {
                let component = if exchanged {
                    Component::exchanged(standard, unit)
                } else {
                    Component::new(standard, unit)
                };
                component.initialise(0.0);
                component
            };
            let config = Config { cases: 100, failure_persistence: None, ..Config::default() };
            let mut counts = [0, 0];
            let counts_cell = std::cell::RefCell::new(&mut counts);
            TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
                .run(&prop::collection::vec(call(), 1..80), |calls| {
                    check(new, &calls, &mut counts_cell.borrow_mut())
                })
                .unwrap();
            println!(
                "{standard:?} {unit}, exchanged {exchanged}: {} calls done, {} refused",
                counts[0], counts[1]
            );
            assert!(counts.iter().all(|count| *count > 300), "{counts:?}");
        }
    }
}
