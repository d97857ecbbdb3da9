//! Callbacks that do not come back: a C++ exception and a `longjmp` go through to the importer, and the instance can be
//! used as before.

mod importer;

use core::ffi::c_void;
use core::ptr::{null, null_mut};
use std::ffi::CString;

use importer::{Importer, Language};
use maglev_fmu::fmi::fmi3::{fmi3InstantiateCoSimulation, fmi3InstantiateScheduledExecution};
use maglev_fmu::model::Edition;

use super::allocator::blocks;
use super::harness::{self, BOTH, CONTROLLER, Component, ERROR, OK, Standard, description, instantiate_with};

/// Runs `check` with an importer in every language for which there is a compiler.
fn in_each_language(test: &str, check: impl Fn(&Importer)) {
    let importers = [Language::C, Language::Cpp].map(|language| Importer::new(language, test));
    importers.iter().flatten().for_each(check);
}

/// Result of `call` if no callback left it, in a host that traps: its control word stays its own in any case.
#[cfg(target_arch = "x86_64")]
fn protect(importer: &Importer, call: impl FnMut() -> i32) -> Option<i32> {
    use super::floating_point::host::{TRAPPING, hosted};
    hosted(TRAPPING, || importer.protect(call))
}

#[cfg(not(target_arch = "x86_64"))]
fn protect(importer: &Importer, call: impl FnMut() -> i32) -> Option<i32> {
    importer.protect(call)
}

fn token() -> CString {
    harness::token(CONTROLLER, Edition::Clocked)
}

fn instantiate(importer: &Importer, standard: Standard, token: &CString, logging_on: bool) -> *mut c_void {
    let (logger2, logger3) = (Some(importer.log2), Some(importer.log3));
    // SAFETY: C strings, and loggers that need no environment.
    unsafe {
        let (name, none) = (c"left".as_ptr(), null());
        instantiate_with(standard, name, token.as_ptr(), none, null_mut(), logger2, logger3, logging_on)
    }
}

fn component(importer: &Importer, standard: Standard, logging_on: bool) -> Component {
    importer.leave_after(-1);
    let handle = instantiate(importer, standard, &token(), logging_on);
    Component::from_handle(standard, CONTROLLER, handle, Box::default())
}

/// Time and position of step `k`: with curvature and without, so that the observer converges and diverges.
fn sample(k: i32) -> (f64, f64) {
    let time = f64::from(k) * 1e-3;
    (time, if k % 50 < 25 { 0.01 + time * time } else { 0.01 })
}

fn step(component: &Component, (time, position): (f64, f64)) -> i32 {
    assert_eq!(component.set("position", position), OK);
    component.step(time, 1e-3)
}

fn steps(component: &Component, from: i32, to: i32) {
    for k in from..to {
        assert_eq!(step(component, sample(k)), OK);
    }
}

#[test]
fn a_refused_call_may_be_left() {
    in_each_language("a_refused_call_may_be_left", |importer| {
        for standard in BOTH {
            let (component, straight) =
                (component(importer, standard, false), component(importer, standard, false));
            for instance in [&component, &straight] {
                instance.initialise(0.0);
                steps(instance, 0, 10);
            }
            for wrong in [-1.0, f64::NAN, f64::INFINITY] {
                importer.leave_after(0);
                assert_eq!(protect(importer, || component.step(0.01, wrong)), None);
                let messages = importer.take_messages();
                assert!(messages.len() == 1 && messages[0].contains("communicationStepSize"), "{messages:?}");
            }
            assert_eq!(protect(importer, || component.step(0.01, -1.0)), Some(ERROR));
            assert_eq!(importer.take_messages().len(), 1, "each message once");
            for instance in [&component, &straight] {
                steps(instance, 10, 20);
            }
            assert_eq!(component.snapshot(), straight.snapshot());
            assert_eq!(component.reset(), OK);
            component.initialise(0.0);
        }
    });
}

#[test]
fn instantiation_may_be_left_and_leaks_nothing() {
    in_each_language("instantiation_may_be_left_and_leaks_nothing", |importer| {
        let (good, bad) = (token(), CString::new("{}").unwrap());
        for standard in BOTH {
            let before = blocks();
            for (token, logging_on, said) in [
                (&good, true, "instantiated"),
                (&bad, true, "not one of this library"),
                (&bad, false, "not one of this library"),
            ] {
                importer.leave_after(0);
                let left = importer.protect(|| {
                    instantiate(importer, standard, token, logging_on);
                    0
                });
                assert_eq!(left, None);
                let messages = importer.take_messages();
                assert!(messages.len() == 1 && messages[0].contains(said), "{messages:?}");
                drop(messages);
                assert_eq!(blocks(), before);
            }
            importer.leave_after(-1);
        }
    });
}

#[test]
fn a_remark_within_a_step_may_be_left() {
    in_each_language("a_remark_within_a_step_may_be_left", |importer| {
        for standard in BOTH {
            let said = |calls: i32| {
                let component = component(importer, standard, true);
                component.initialise(0.0);
                importer.take_messages();
                let mut times_left = 0;
                for k in 0..200 {
                    let sample = sample(k);
                    importer.leave_after(calls);
                    times_left += i32::from(protect(importer, || step(&component, sample)).is_none());
                }
                // One step over many ticks, with many remarks, each of which is left.
                importer.leave_after(calls);
                let mut end = protect(importer, || component.step(0.2, 0.1));
                while end.is_none() {
                    times_left += 1;
                    importer.leave_after(calls);
                    end = protect(importer, || component.set("position", 0.0));
                }
                assert_eq!(end, Some(OK));
                (times_left, importer.take_messages(), component.snapshot())
            };
            let (never, expected, values) = said(-1);
            let (times_left, messages, snapshot) = said(0);
            assert_eq!((never, times_left), (0, expected.len() as i32));
            assert!(times_left >= 3, "the observer has something to say");
            assert_eq!(messages, expected, "all of them, each once, in order");
            let position = description(CONTROLLER).find("position").unwrap().0;
            let others = |values: Vec<u64>| [&values[..position], &values[position + 1..]].concat();
            assert_eq!(others(snapshot), others(values));
        }
    });
}

fn with_update(importer: &Importer) -> Component {
    importer.leave_after(-1);
    let token = token();
    // SAFETY: C strings, and callbacks that need no environment.
    let handle = unsafe {
        let (name, token, none, log) = (c"left".as_ptr(), token.as_ptr(), null(), Some(importer.log3));
        let update = Some(importer.update);
        fmi3InstantiateCoSimulation(name, token, none, 0, 0, 0, 1, null(), 0, null_mut(), log, update)
    };
    Component::from_handle(Standard::Fmi3, CONTROLLER, handle, Box::default())
}

/// Restoring and resetting are the ways out of a step that an intermediate update has left.
#[test]
fn a_step_may_be_left_in_an_intermediate_update() {
    in_each_language("a_step_may_be_left_in_an_intermediate_update", |importer| {
        let (component, straight) = (with_update(importer), with_update(importer));
        let mut state = null_mut();
        for instance in [&component, &straight] {
            instance.initialise(0.0);
            steps(instance, 0, 5);
        }
        assert_eq!(component.get_state(&mut state), OK);
        for calls in [0, 1, 3] {
            importer.leave_after(calls);
            assert_eq!(protect(importer, || component.step(5e-3, 5e-3)), None);
            assert_eq!(component.step(5e-3, 5e-3), ERROR, "the step is not over");
            assert_eq!(component.set_state(state), OK);
            assert_eq!(component.step(5e-3, 5e-3), OK);
            assert_eq!(component.set_state(state), OK);
        }
        assert_eq!([component.step(5e-3, 5e-3), straight.step(5e-3, 5e-3)], [OK; 2]);
        assert_eq!(component.snapshot(), straight.snapshot());

        importer.leave_after(1);
        assert_eq!(protect(importer, || component.step(0.01, 5e-3)), None);
        for instance in [&component, &straight] {
            assert_eq!(instance.reset(), OK);
            instance.initialise(0.0);
            steps(instance, 0, 5);
        }
        assert_eq!(component.snapshot(), straight.snapshot());
        assert_eq!(component.free_state(&mut state), OK);
        importer.leave_after(0);
        assert_eq!(protect(importer, || component.step(5e-3, 5e-3)), None);
        // Freed here, in the middle of a step.
    });
}

#[test]
fn an_activation_may_be_left_in_a_clock_update() {
    in_each_language("an_activation_may_be_left_in_a_clock_update", |importer| {
        let made = || {
            importer.leave_after(-1);
            let token = token();
            // SAFETY: C strings, and callbacks that need no environment.
            let handle = unsafe {
                fmi3InstantiateScheduledExecution(
                    c"left".as_ptr(),
                    token.as_ptr(),
                    null(),
                    0,
                    0,
                    null_mut(),
                    Some(importer.log3),
                    Some(importer.clock_update),
                    None,
                    None,
                )
            };
            Component::from_handle(Standard::Fmi3, CONTROLLER, handle, Box::default())
        };
        let (component, straight) = (made(), made());
        let mut state = null_mut();
        for instance in [&component, &straight] {
            instance.initialise(0.0);
            assert_eq!(instance.activate(0.0), OK);
        }
        assert_eq!(component.get_state(&mut state), OK);
        importer.leave_after(0);
        assert_eq!(protect(importer, || component.activate(1e-3)), None);
        assert_eq!(component.activate(2e-3), ERROR, "the activation is not over");
        assert_eq!(component.set_state(state), OK);
        for instance in [&component, &straight] {
            assert_eq!([instance.activate(1e-3), instance.activate(2e-3)], [OK; 2]);
        }
        assert_eq!(component.snapshot(), straight.snapshot());
        importer.leave_after(0);
        assert_eq!(protect(importer, || component.activate(3e-3)), None);
        assert_eq!(component.reset(), OK);
        component.initialise(0.0);
        assert_eq!(component.activate(0.0), OK);
        assert_eq!(component.free_state(&mut state), OK);
    });
}
