//! Intermediate update: callbacks at the ticks within a step, inputs set there, and steps that end there.

use core::cell::RefCell;
use core::ffi::c_void;

use maglev_fmu::fmi::fmi3::types::fmi3Boolean;
use maglev_fmu::fmi::fmi3::{fmi3DoStep, fmi3GetFloat64, fmi3Reset, fmi3SetFloat64, fmi3SetInt64};

use super::harness::clocked::Choices;
use super::harness::{CONTROLLER, Component, ERROR, OK, PLANT, Standard};

/// What the callback does and sees.
#[derive(Default)]
struct Script {
    handle: usize,
    /// Input to set as a function of time.
    signal: Option<fn(f64) -> f64>,
    /// Callback at which to ask for the end of the step, and the end asked for \[s\].
    early_return: Option<(usize, f64)>,
    times: Vec<f64>,
    may_return_early: Vec<bool>,
}

thread_local! {
    static SCRIPT: RefCell<Script> = RefCell::default();
}

unsafe extern "C-unwind" fn callback(
    _: *mut c_void,
    time: f64,
    set_requested: fmi3Boolean,
    get_allowed: fmi3Boolean,
    step_finished: fmi3Boolean,
    can_return_early: fmi3Boolean,
    early_return_requested: *mut fmi3Boolean,
    early_return_time: *mut f64,
) {
    assert_eq!((set_requested, get_allowed, step_finished), (1, 1, 1));
    let (handle, signal, early_return) = SCRIPT.with_borrow_mut(|script| {
        script.times.push(time);
        script.may_return_early.push(can_return_early != 0);
        (script.handle as *mut c_void, script.signal, script.early_return)
    });
    let call = SCRIPT.with_borrow(|script| script.times.len() - 1);
    // SAFETY: the instance lives and waits; the results are writable.
    unsafe {
        let mut now = 0.0;
        assert_eq!(fmi3GetFloat64(handle, &0, 1, &mut now, 1), OK);
        assert_eq!(now, time);
        if let Some(signal) = signal {
            assert_eq!(fmi3SetFloat64(handle, &1, 1, &signal(time), 1), OK);
        }
        // Neither what was not registered, nor parameters, nor other functions.
        assert_eq!(fmi3SetFloat64(handle, &2, 1, &0.0, 1), ERROR);
        assert_eq!(fmi3SetInt64(handle, &1, 1, &1, 1), ERROR);
        let [mut a, mut b, mut c] = [0; 3];
        assert_eq!(fmi3DoStep(handle, time, 1.0, 1, &mut a, &mut b, &mut c, &mut now), ERROR);
        if let Some((_, end)) = early_return.filter(|(at, _)| *at == call) {
            early_return_requested.write(1);
            early_return_time.write(end);
        }
    }
}

/// An instance with the callback; its first real input is the second row of the table.
fn instance(early_return: bool, script: Script) -> Component {
    let choices = Choices { early_return, intermediate_update: Some(callback), ..Choices::default() };
    let component = Component::co_simulation(CONTROLLER, choices);
    assert_eq!((component.reference("position"), component.reference("voltage_applied")), (1, 2));
    component.initialise(0.0);
    SCRIPT.set(Script { handle: component.handle as usize, ..script });
    component
}

fn signal(time: f64) -> f64 {
    0.01 + 0.003 * (300.0 * time).sin()
}

#[test]
fn every_tick_but_the_first_of_a_step_calls_back() {
    let component = instance(false, Script::default());
    assert_eq!(component.step(0.0, 3.5e-3), OK);
    assert_eq!(SCRIPT.with_borrow(|script| script.times.clone()), [1e-3, 2e-3, 3e-3]);
    assert_eq!(component.step(3.5e-3, 0.5e-3), OK);
    assert_eq!(SCRIPT.with_borrow(|script| script.times.len()), 3);
    assert_eq!(component.step(4e-3, 1.5e-3), OK);
    assert_eq!(SCRIPT.with_borrow(|script| script.times[3..].to_vec()), [5e-3]);
    assert!(SCRIPT.with_borrow(|script| script.may_return_early.iter().all(|may| !may)));
    assert_eq!(component.get("time"), 5.5e-3);
}

#[test]
fn inputs_set_at_ticks_are_those_of_steps_from_tick_to_tick() {
    let stepped = Component::new(Standard::Fmi3, CONTROLLER);
    stepped.initialise(0.0);
    for k in 0..500 {
        let time = f64::from(k) * 1e-3;
        assert_eq!(stepped.set("position", signal(time)), OK);
        assert_eq!(stepped.step(time, 1e-3), OK);
    }
    let component = instance(false, Script { signal: Some(signal), ..Script::default() });
    assert_eq!(component.set("position", signal(0.0)), OK);
    assert_eq!(component.step(0.0, 0.25), OK);
    assert_eq!(component.set("position", signal(0.25)), OK);
    assert_eq!(component.step(0.25, 0.25), OK);
    let times = SCRIPT.with_borrow(|script| script.times.clone());
    assert_eq!(times.len(), 498, "500 ticks, two of which begin a step");
    let rows = |component: &Component| component.snapshot()[1..].to_vec();
    assert_eq!(rows(&component), rows(&stepped));
}

#[test]
fn a_step_ends_where_the_importer_wants_it_to() {
    for (asked, reached, ticks) in [
        // At the tick, which then belongs to the next step.
        (2e-3, 2e-3, 1e-3),
        // In the past or not a number: at once.
        (0.0, 2e-3, 1e-3),
        (f64::NAN, 2e-3, 1e-3),
        // Later.
        (2.5e-3, 2.5e-3, 2e-3),
        (4e-3, 4e-3, 3e-3),
    ] {
        let component = instance(true, Script { early_return: Some((1, asked)), ..Script::default() });
        let step = component.step_to_event(0.0, 0.01);
        assert_eq!((step.status, step.is_event, step.is_early, step.reached), (OK, false, true, reached));
        assert_eq!(component.get("tick_time"), ticks, "asked for {asked}");
        // The rest, as if nothing had happened.
        let step = component.step_to_event(reached, 0.01 - reached);
        assert_eq!((step.status, step.is_early), (OK, false));
        let straight = Component::new(Standard::Fmi3, CONTROLLER);
        straight.initialise(0.0);
        assert_eq!(straight.step(0.0, 0.01), OK);
        assert_eq!(component.snapshot()[1..], straight.snapshot()[1..]);
    }
    // Beyond the end, or not allowed at instantiation: no early return.
    for (early_return, asked) in [(true, 0.02), (false, 2e-3)] {
        let script = Script { early_return: Some((1, asked)), ..Script::default() };
        let step = instance(early_return, script).step_to_event(0.0, 0.01);
        assert_eq!((step.status, step.is_early, step.reached), (OK, false, 0.01));
    }
}

#[test]
fn plants_call_nobody() {
    let choices = Choices { intermediate_update: Some(callback), ..Choices::default() };
    let component = Component::co_simulation(PLANT, choices);
    component.initialise(0.0);
    SCRIPT.set(Script::default());
    assert_eq!(component.step(0.0, 0.1), OK);
    assert!(SCRIPT.with_borrow(|script| script.times.is_empty()));
}

#[test]
fn steps_that_are_refused_call_nobody() {
    let component = instance(true, Script::default());
    let before = component.snapshot();
    for (time, h) in [(0.0, -1.0), (1.0, 0.01), (0.0, 1e300), (0.0, 1e9)] {
        assert_eq!(component.step(time, h), ERROR, "{time} {h}");
    }
    assert_eq!(component.snapshot(), before);
    assert!(SCRIPT.with_borrow(|script| script.times.is_empty()));
}

unsafe extern "C-unwind" fn resetting(
    _: *mut c_void,
    _: f64,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: *mut fmi3Boolean,
    _: *mut f64,
) {
    // SAFETY: the instance lives and waits.
    assert_eq!(unsafe { fmi3Reset(SCRIPT.with_borrow(|script| script.handle) as *mut c_void) }, OK);
}

#[test]
fn a_callback_that_resets_the_instance_ends_the_step() {
    let choices = Choices { intermediate_update: Some(resetting), ..Choices::default() };
    let component = Component::co_simulation(CONTROLLER, choices);
    component.initialise(0.0);
    SCRIPT.set(Script { handle: component.handle as usize, ..Script::default() });
    component.recorder.clear();
    assert_eq!(component.step(0.0, 0.01), ERROR);
    let told = component.recorder.messages().pop().unwrap().text;
    assert!(told.starts_with("fmi3DoStep: ended by its callback, which has reset"), "{told}");
    assert!(told.ends_with("it is now in the phase \"instantiated\""), "{told}");
    component.initialise(0.0);
    // None of the callbacks is due before the second tick.
    assert_eq!(component.step(0.0, 1e-3), OK);
}
