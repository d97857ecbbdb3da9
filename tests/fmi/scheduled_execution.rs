//! Scheduled execution of the sampled models: intervals of the clock, activations, callbacks.

use core::cell::Cell;
use core::ffi::c_void;

use maglev_fmu::fmi::fmi3::types::{FMI3_INTERVAL_CHANGED, FMI3_INTERVAL_UNCHANGED};
use maglev_fmu::fmi::fmi3::*;

use super::harness::clocked::{Choices, sampled_models};
use super::harness::{CONTROLLER, Component, ERROR, OK};

type Timing = ([f64; 2], [(u64, u64); 2], [i32; 2]);

/// Interval and shift of `tick`: as decimals, as fractions, and the qualifiers in the order in which they were told.
fn timing(component: &Component) -> Option<Timing> {
    let tick = component.clocks()[0];
    let (mut interval, mut shift, mut qualifiers) = (0.0, 0.0, [7; 2]);
    let mut fractions = [(0, 0); 2];
    let [(c0, r0), (c1, r1)] = &mut fractions;
    // SAFETY: a live handle, one reference, room for the results.
    let statuses = unsafe {
        let handle = component.handle;
        let [decimal, fraction] = &mut qualifiers;
        [
            fmi3GetIntervalDecimal(handle, &tick, 1, &mut interval, decimal),
            fmi3GetIntervalFraction(handle, &tick, 1, c0, r0, fraction),
            fmi3GetShiftDecimal(handle, &tick, 1, &mut shift),
            fmi3GetShiftFraction(handle, &tick, 1, c1, r1),
        ]
    };
    (statuses == [OK; 4]).then_some(([interval, shift], fractions, qualifiers))
}

/// In initialisation mode.
fn initialising(sample_time: f64, start_time: f64) -> Component {
    let component = Component::scheduled(CONTROLLER, None);
    assert_eq!(component.set("sample_time", sample_time), OK);
    assert_eq!(component.enter_initialization(start_time, None), OK);
    component
}

const NEWS: [i32; 2] = [FMI3_INTERVAL_CHANGED, FMI3_INTERVAL_UNCHANGED];
const NO_NEWS: [i32; 2] = [FMI3_INTERVAL_UNCHANGED; 2];

#[test]
fn intervals_follow_from_the_sample_time() {
    let component = Component::scheduled(CONTROLLER, None);
    assert_eq!(timing(&component), None, "before initialisation");
    let component = initialising(1e-3, 0.0025);
    assert_eq!(timing(&component), Some(([1e-3, 5e-4], [(1, 1000), (1, 2000)], NEWS)));
    assert_eq!(timing(&component), Some(([1e-3, 5e-4], [(1, 1000), (1, 2000)], NO_NEWS)));
    assert_eq!(component.set("sample_time", 0.3e-3), OK);
    let first_tick = "the first tick is at 2.7 ms";
    assert_eq!(timing(&component), Some(([0.3e-3, 2e-4], [(3, 10_000), (1, 5000)], NEWS)), "{first_tick}");
    assert_eq!(component.set("controller.k1", 1.0), OK);
    assert_eq!(timing(&component).unwrap().2, NO_NEWS, "another parameter");

    let interval_of = |component: &Component, clock: usize| {
        let (mut interval, mut qualifier) = (0.0, 7);
        // SAFETY: a live handle, one reference, room for the results.
        let status = unsafe {
            let reference = component.clocks()[clock];
            fmi3GetIntervalDecimal(component.handle, &reference, 1, &mut interval, &mut qualifier)
        };
        (status, interval, qualifier)
    };
    component.recorder.clear();
    component.assert_refused(
        interval_of(&component, 1).0,
        &["ticked", "expected one that the importer activates"],
    );
    assert_eq!(component.exit_initialization(), OK);
    component.recorder.clear();
    component.assert_refused(interval_of(&component, 0).0, &["clock activation mode", "IntervalDecimal"]);

    let events = Choices { event_mode: true, early_return: true, intermediate_update: None };
    let component = Component::co_simulation(CONTROLLER, events);
    component.initialise(0.0);
    assert_eq!(interval_of(&component, 0), (OK, 1e-3, FMI3_INTERVAL_CHANGED), "never asked before");
    component.settle_event();
    assert_eq!(interval_of(&component, 0), (OK, 1e-3, FMI3_INTERVAL_UNCHANGED));
}

#[test]
fn shifts_are_exact() {
    for (sample_time, start_time, shift, fraction) in [
        (1e-4, 0.00025, 5e-5, (1, 20_000)),
        (1e-3, 0.0, 0.0, (0, 1)),
        (1e-3, 7.0, 0.0, (0, 1)),
        (1e-4, -0.00025, 5e-5, (1, 20_000)),
        (1.0 / 60.0, 0.01, 1.0 / 150.0, (1, 150)),
    ] {
        let told = timing(&initialising(sample_time, start_time)).unwrap();
        assert_eq!((told.0[1], told.1[1]), (shift, fraction), "{sample_time} {start_time}");
    }
    // Where 64 bits are too few for the fraction of what the numbers stand for, that of the difference of the doubles.
    let (sample_time, start_time) = (7e-4, 0.1 + 0.2);
    let told = timing(&initialising(sample_time, start_time)).unwrap();
    let (counter, resolution) = told.1[1];
    assert_eq!(told.0[1], 429.0 * sample_time - start_time);
    assert_eq!(counter as f64 / resolution as f64, told.0[1]);
}

#[test]
fn an_importer_may_set_the_interval() {
    let component = initialising(1e-3, 0.0);
    let tick = component.clocks()[0];
    let set = |interval: f64| {
        // SAFETY: a live handle, one reference, one value.
        unsafe { fmi3SetIntervalDecimal(component.handle, &tick, 1, &interval) }
    };
    let set_fraction = |counter: u64, resolution: u64| {
        // SAFETY: a live handle, one reference, one value each.
        unsafe { fmi3SetIntervalFraction(component.handle, &tick, 1, &counter, &resolution) }
    };
    assert_eq!(set(2e-3), OK);
    assert_eq!(component.get("sample_time"), 2e-3);
    assert_eq!(timing(&component).unwrap().1[0], (1, 500));
    assert_eq!(set_fraction(1, 3000), OK);
    assert_eq!(component.get("sample_time"), 1.0 / 3000.0);
    component.recorder.clear();
    for interval in [0.0, -1e-3, 100.0] {
        component.assert_refused(set(interval), &["sample_time", "expected 1e-6 to 1 s"]);
    }
    for interval in [f64::NAN, f64::INFINITY] {
        component.assert_refused(set(interval), &["sample_time", "expected a finite number"]);
    }
    for counter in [0, 1] {
        component.assert_refused(set_fraction(counter, 0), &["sample_time", "expected a finite number"]);
    }
    assert_eq!(component.get("sample_time"), 1.0 / 3000.0, "refused ones change nothing");
    assert_eq!(component.exit_initialization(), OK);
    component.recorder.clear();
    component.assert_refused(set(1e-3), &["fmi3SetIntervalDecimal", "clock activation mode"]);
    for k in 0..3 {
        let time = f64::from(k) / 3000.0;
        assert_eq!(component.activate(time), OK);
        assert_eq!(component.get("tick_time"), time);
    }
}

#[test]
fn activations_run_ticks() {
    for model in sampled_models() {
        let component = Component::scheduled(model, None);
        component.initialise(0.0);
        for k in 0..5 {
            let time = f64::from(k) * component.get("sample_time");
            assert_eq!(component.activate(time), OK);
            assert_eq!((component.get("time"), component.get("tick_time")), (time, time));
        }
        // The scheduler decides about time: off the grid, too.
        assert_eq!(component.activate(0.123_45), OK);
        assert_eq!(component.get("tick_time"), 0.123_45);
        assert_eq!(component.terminate(), OK);
    }
}

#[test]
fn times_that_do_not_follow_are_refused() {
    let component = Component::scheduled(CONTROLLER, None);
    component.initialise(1.0);
    component.recorder.clear();
    let before = component.snapshot();
    for time in [0.5, f64::NAN, f64::INFINITY, -1.0] {
        let said = format!("activationTime = {time} s: expected a finite time after 1 s");
        component.assert_refused(component.activate(time), &["fmi3ActivateModelPartition: ", &said]);
    }
    assert_eq!(component.snapshot(), before);
    assert_eq!(component.activate(1.0), OK);
    component.recorder.clear();
    component.assert_refused(component.activate(1.0), &["activationTime = 1 s"]);
    let tick = component.clocks()[0];
    for (clock, said) in [(tick + 1, "ticked"), (tick + 2, "is unknown"), (0, "is a variable, not a clock")] {
        // SAFETY: a live handle.
        let status = unsafe { fmi3ActivateModelPartition(component.handle, clock, 2.0) };
        component.assert_refused(status, &[said]);
    }
    component.assert_refused(component.step(1.0, 1e-3), &["clock activation mode"]);
    component.assert_refused(component.enter_event_mode(), &["clock activation mode"]);
    component.assert_refused(component.set_clock(tick, 1), &["clock activation mode"]);
}

thread_local! {
    /// The instance, and what the callback was told about the clock `ticked`.
    static SUBJECT: Cell<(*mut c_void, u32)> = const { Cell::new((core::ptr::null_mut(), 0)) };
    static TOLD: Cell<(u32, u32, i32)> = const { Cell::new((0, 0, 0)) };
}

unsafe extern "C-unwind" fn clock_update(_: *mut c_void) {
    let (handle, ticked) = SUBJECT.get();
    let (calls, active, refused) = TOLD.get();
    let (mut first, mut second) = (7, 7);
    // SAFETY: the handle lives, one reference, room for one value.
    unsafe {
        assert_eq!(fmi3GetClock(handle, &ticked, 1, &mut first), OK);
        assert_eq!(fmi3GetClock(handle, &ticked, 1, &mut second), OK);
        assert_eq!(second, 0);
        // Nothing that belongs elsewhere.
        let status = fmi3ActivateModelPartition(handle, ticked - 1, 1e9);
        TOLD.set((calls + 1, active + u32::from(first), refused + status));
    }
}

#[test]
fn the_callback_may_ask_for_the_clock() {
    let component = Component::scheduled(CONTROLLER, Some(clock_update));
    component.initialise(0.0);
    let [_, ticked] = component.clocks();
    SUBJECT.set((component.handle, ticked));
    for k in 0..4 {
        assert_eq!(component.activate(f64::from(k) * 1e-3), OK);
    }
    assert_eq!(TOLD.get(), (4, 4, 4 * ERROR));
    assert_eq!(component.get("tick_time"), 3e-3);
    // Clocks are told of in the callback only.
    component.recorder.clear();
    component.assert_refused(component.get_clock(ticked).0, &["fmi3GetClock", "clock activation mode"]);
}

unsafe extern "C-unwind" fn resetting(_: *mut c_void) {
    // SAFETY: the handle lives.
    assert_eq!(unsafe { fmi3Reset(SUBJECT.get().0) }, OK);
}

#[test]
fn a_callback_that_resets_the_instance_ends_the_activation() {
    let component = Component::scheduled(CONTROLLER, Some(resetting));
    component.initialise(0.0);
    SUBJECT.set((component.handle, component.clocks()[1]));
    component.recorder.clear();
    assert_eq!(component.activate(0.0), ERROR);
    let told = component.recorder.messages().pop().unwrap().text;
    assert!(told.starts_with("fmi3ActivateModelPartition: ended by its callback, which has reset"), "{told}");
    assert!(told.ends_with("it is now in the phase \"instantiated\""), "{told}");
    component.initialise(0.0);
}

#[test]
fn states_stay_among_scheduled_instances() {
    let component = Component::scheduled(CONTROLLER, None);
    component.initialise(0.0);
    assert_eq!(component.set("position", 0.01), OK);
    assert_eq!(component.activate(0.0), OK);
    let bytes = component.saved_bytes();
    let other = Component::scheduled(CONTROLLER, None);
    assert_eq!(other.restore_bytes(&bytes), OK);
    assert_eq!(other.activate(0.0), ERROR, "activated at this time before");
    for instance in [&component, &other] {
        assert_eq!(instance.activate(1e-3), OK);
    }
    assert_eq!(component.snapshot(), other.snapshot());
    let stepped = Component::new(component.standard, CONTROLLER);
    stepped.recorder.clear();
    stepped.assert_refused(stepped.restore_bytes(&bytes), &["clock activation mode", "never reaches"]);
}
