//! No call that an importer repeats touches the heap: neither when it works, nor when it logs, nor when it is refused.

use core::ffi::{c_char, c_void};
use core::mem::transmute;
use core::ptr::null_mut;
use core::sync::atomic::{AtomicU32, Ordering};
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::fmi2CallbackLogger;
use maglev_fmu::fmi::fmi3::fmi3SetDebugLogging;

use super::allocator::{blocks, uses_of_the_heap};
use super::harness::clocked::{self, Choices};
use super::harness::{
    BOTH, CONTROLLER, Component, ERROR, OK, PLANT, Standard, State, all, bearing, description,
    instantiate_with,
};

/// Loggers that count messages in the environment, an [`AtomicU32`].
unsafe extern "C-unwind" fn count_fmi2(
    environment: *mut c_void,
    _: *const c_char,
    _: i32,
    _: *const c_char,
    _: *const c_char,
) {
    // SAFETY: the environment that the instance was given.
    unsafe { &*environment.cast::<AtomicU32>() }.fetch_add(1, Ordering::Relaxed);
}

unsafe extern "C-unwind" fn count_fmi3(environment: *mut c_void, _: i32, _: *const c_char, _: *const c_char) {
    // SAFETY: the environment that the instance was given.
    unsafe { &*environment.cast::<AtomicU32>() }.fetch_add(1, Ordering::Relaxed);
}

fn counting(standard: Standard, model: &str, messages: &AtomicU32, logging_on: bool) -> Component {
    type Fixed = unsafe extern "C-unwind" fn(*mut c_void, *const c_char, i32, *const c_char, *const c_char);
    // SAFETY: as for the recording logger of the harness.
    let logger2 = unsafe { transmute::<Fixed, fmi2CallbackLogger>(count_fmi2) };
    let token = CString::new(description(model).token().as_str()).unwrap();
    let environment = core::ptr::from_ref(messages).cast_mut().cast();
    let none = core::ptr::null();
    // SAFETY: C strings; the counter outlives the instance.
    let handle = unsafe {
        let (logger2, logger3) = (Some(logger2), Some(count_fmi3 as _));
        instantiate_with(standard, none, token.as_ptr(), none, environment, logger2, logger3, logging_on)
    };
    assert!(!handle.is_null());
    let component = Component::from_handle(standard, model, handle, Box::default());
    component.initialise(0.0);
    messages.store(0, Ordering::Relaxed);
    component
}

#[test]
fn the_counter_counts() {
    assert_eq!(uses_of_the_heap(|| drop(std::hint::black_box(Box::new(1)))), 2);
}

#[test]
fn steps_gets_and_sets_use_no_heap() {
    for (standard, model) in bearing() {
        for logging_on in [false, true] {
            let messages = AtomicU32::new(0);
            let component = counting(standard, model, &messages, logging_on);
            let names = if model == PLANT {
                ["voltage", "sensor.noise", "position", "velocity"]
            } else {
                ["position", "controller.k2", "voltage", "estimate.flux"]
            };
            let [input, tunable, first, second] = names.map(|name| component.reference(name));
            let others: Vec<u32> = (0..component.description.variables.len() as u32).collect();
            let mut values = [0.0; 2];
            let uses = uses_of_the_heap(|| {
                for k in 0..500 {
                    let t = f64::from(k) * 1e-3;
                    // Curved, then straight: the observer converges and diverges again and again.
                    let value = if k % 50 < 25 { 0.01 + t * t } else { 0.01 };
                    assert_eq!(component.set_reals(&[input, tunable], &[value, 1e-3 + t]), OK);
                    assert_eq!(component.step(t, 1e-3), OK);
                    assert_eq!(component.get_reals(&[first, second], &mut values), OK);
                    for reference in &others {
                        assert_eq!(component.get_reference(*reference).0, OK);
                    }
                }
            });
            let messages = messages.load(Ordering::Relaxed);
            println!(
                "{standard:?} {model}, logging {logging_on}: {uses} uses of the heap, {messages} messages"
            );
            assert_eq!(uses, 0);
            assert_eq!(messages > 3, logging_on && model == CONTROLLER, "the observer has something to say");
        }
    }
}

#[test]
fn states_are_one_block_each() {
    for (standard, model) in all() {
        let messages = AtomicU32::new(0);
        let component = counting(standard, model, &messages, true);
        assert_eq!(component.step(0.0, 1e-3), OK);
        let (mut state, mut copy): (State, State) = (null_mut(), null_mut());
        let mut size = 0;
        let before = blocks();
        assert_eq!(uses_of_the_heap(|| assert_eq!(component.get_state(&mut state), OK)), 1);
        assert_eq!(component.state_size(state, &mut size), OK);
        let mut bytes = [0; 4096];
        let bytes = &mut bytes[..size];
        let uses = uses_of_the_heap(|| {
            for _ in 0..10 {
                assert_eq!(component.set_state(state), OK);
                assert_eq!(component.get_state(&mut state), OK);
                assert_eq!(component.serialise_state(state, bytes), OK);
                assert_eq!(component.deserialise_state(bytes, &mut state), OK);
                assert_eq!(component.free_state(&mut null_mut()), OK);
            }
        });
        assert_eq!(uses, 0);
        assert_eq!(uses_of_the_heap(|| assert_eq!(component.deserialise_state(bytes, &mut copy), OK)), 1);
        assert_eq!(blocks(), before + 2);
        // Nothing is leaked by what is refused.
        let refusals = uses_of_the_heap(|| {
            let mut none = null_mut();
            assert_eq!(component.deserialise_state(&bytes[1..], &mut none), ERROR);
            bytes[size - 1] ^= 1;
            assert_eq!(component.deserialise_state(bytes, &mut none), ERROR);
            assert_eq!(component.set_state(none), ERROR);
            assert!(none.is_null());
        });
        assert_eq!(refusals, 0);
        for state in [&mut state, &mut copy] {
            assert_eq!(uses_of_the_heap(|| assert_eq!(component.free_state(state), OK)), 1);
        }
        assert_eq!(blocks(), before);
    }
}

#[test]
fn ticks_at_events_and_on_activation_use_no_heap() {
    for model in clocked::sampled_models() {
        let events = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = Component::co_simulation(model, events);
        component.initialise(0.0);
        component.settle_event();
        assert_eq!(component.enter_step_mode(), OK);
        // Once the log has room for what the observers have to say, there is none of it.
        // SAFETY: a live handle.
        unsafe { fmi3SetDebugLogging(component.handle, 0, 0, null_mut()) };
        let mut time = 0.0;
        let uses = uses_of_the_heap(|| {
            for _ in 0..200 {
                let step = component.step_to_event(time, 1.0);
                assert!(step.is_event && step.is_early);
                time = step.reached;
                assert_eq!(component.enter_event_mode(), OK);
                assert_eq!(component.set_clock(component.clocks()[0], 1), OK);
                assert_eq!(component.get_clock(component.clocks()[1]).0, OK);
                component.settle_event();
                assert_eq!(component.enter_step_mode(), OK);
            }
        });
        assert_eq!(uses, 0, "{model} at events");

        let component = Component::scheduled(model, None);
        component.initialise(0.0);
        // SAFETY: a live handle.
        unsafe { fmi3SetDebugLogging(component.handle, 0, 0, null_mut()) };
        let uses = uses_of_the_heap(|| {
            for k in 0..200 {
                assert_eq!(component.activate(f64::from(k) * 1e-3), OK);
            }
        });
        assert_eq!(uses, 0, "{model} on activation");
    }
}

#[test]
fn refusals_use_no_heap() {
    for (standard, model) in bearing() {
        for logging_on in [false, true] {
            let messages = AtomicU32::new(0);
            let component = counting(standard, model, &messages, logging_on);
            let input = if model == PLANT { "voltage" } else { "position" };
            let input = component.reference(input);
            let uses = uses_of_the_heap(|| {
                for wrong in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
                    assert_eq!(component.step(0.0, wrong), ERROR);
                    assert_eq!(component.step(7.0 + wrong, 1e-3), ERROR);
                }
                assert_eq!(component.step(0.0, f64::MAX), ERROR);
                assert_eq!(component.set_reals(&[input], &[f64::NAN]), ERROR);
                assert_eq!(component.set_reals(&[input, 999], &[1.0, 1.0]), ERROR);
                assert_eq!(component.set_reals(&[0], &[1.0]), ERROR);
                assert_eq!(component.get_reals(&[999], &mut [0.0]), ERROR);
                assert_eq!(component.exit_initialization(), ERROR);
            });
            assert_eq!(uses, 0, "{standard:?} {model}, logging {logging_on}");
            assert_eq!(messages.load(Ordering::Relaxed), 14, "each with a message, logging on or off");
        }
    }
}

#[test]
fn an_instance_gives_back_what_it_took() {
    for standard in BOTH {
        let before = blocks();
        let messages = AtomicU32::new(0);
        let component = counting(standard, PLANT, &messages, true);
        assert!(blocks() > before);
        drop(component);
        assert_eq!(blocks(), before);
    }
}
