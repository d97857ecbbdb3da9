//! A step allocates nothing, whatever the observer, the law and the sink.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fmt::{self, Write};

use maglev_fmu::model::system::{BEARING, RIG};
use maglev_fmu::model::{LogSink, NullLogSink, Topic};
use maglev_fmu::study::ball::BallReference;
use maglev_fmu_test::bearing::OBSERVERS;
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::values::{get, set};

use crate::ball::native_loop as ball;

thread_local! {
    /// Allocations of this thread: the other tests of the program run beside it.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

// SAFETY: hands every call on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Wants and formats every remark, and keeps only its length.
#[derive(Default)]
struct Listener(usize);

impl LogSink for Listener {
    fn enabled(&self, _: Topic) -> bool {
        true
    }

    fn log(&mut self, _: Topic, message: fmt::Arguments<'_>) {
        self.write_fmt(message).unwrap();
    }
}

impl Write for Listener {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 += text.len();
        Ok(())
    }
}

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.get();
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(ALLOCATIONS.get(), before + 1);
}

#[test]
fn steps_allocate_nothing() {
    let mut listener = Listener::default();
    for (name, parameters) in OBSERVERS {
        for law in 1..=4 {
            let controller = [parameters, &[("controller.law", f64::from(law))]].concat();
            let mut run =
                closed_loop(&BEARING, &[("sensor.noise", 1e-7), ("process.flux_noise", 1e-6)], &controller);
            let before = ALLOCATIONS.get();
            for tick in 0..200 {
                for input in ["position_measured", "voltage_measured"] {
                    let value = get(&*run.plant, input);
                    let input = if input == "position_measured" { "position" } else { "voltage_applied" };
                    set(&mut *run.controller, input, value);
                }
                if tick == 100 {
                    run.controller.apply_tunable_parameters();
                }
                run.controller.advance(1e-3, &mut listener).unwrap();
                let voltage = get(&*run.controller, "voltage");
                set(&mut *run.plant, "voltage", voltage);
                run.plant.advance(1e-3, &mut NullLogSink).unwrap();
            }
            assert_eq!(ALLOCATIONS.get(), before, "{name}, law {law}");
        }
    }
    assert!(listener.0 > 0, "the observers had something to say");
    for kind in [ball::DREM, ball::POLYNOMIAL_NEWTON, ball::POLYNOMIAL_NEWTON_ADAPTIVE] {
        ball_steps_allocate_nothing(kind, &mut Listener::default());
    }
    rig_steps_allocate_nothing(&mut listener);
}

/// Also when the ball falls onto its stop and when the observer has to start again.
fn ball_steps_allocate_nothing(kind: f64, listener: &mut Listener) {
    let settings =
        [("observer.kind", kind), ("observer.startup_hold", 0.01), ("observer.voltage_source", 2.0)];
    let mut run = ball::BallLoop::new(BallReference::Sinusoids, 0.1, &[("sensor.noise", 1e-6)], &settings);
    let before = ALLOCATIONS.get();
    for tick in 0..600 {
        if tick == 500 {
            run.controller.apply_tunable_parameters();
        }
        run.step();
    }
    set(&mut *run.controller, "voltage_applied", 1e300);
    run.controller.advance(1e-4, listener).unwrap();
    set(&mut *run.plant, "voltage", 0.0);
    run.plant.advance(1.0, listener).unwrap();
    assert_eq!(ALLOCATIONS.get(), before, "observer.kind {kind}");
    assert!(listener.0 > 0, "the observer started again and the ball fell");
}

/// Every observer of the rig with both laws, one of them diverging, the ball lost and found.
fn rig_steps_allocate_nothing(listener: &mut Listener) {
    for index in 0..128 {
        let parameters = [
            ("observer.kind", index % 4),
            ("observer.discretisation", index / 4 % 4),
            ("observer.form", index / 16 % 2),
            ("observer.measurement", index / 32 % 2),
            ("controller.kind", index / 64),
        ];
        let mut controller = parameters.map(|(name, item)| (name, f64::from(item + 1))).to_vec();
        controller.extend([("observer.bandwidth", 3000.0), ("observer.exponent[2]", 0.7)]);
        let mut run = closed_loop(&RIG, &[("sensor.noise", 1e-3)], &controller);
        let before = (ALLOCATIONS.get(), listener.0);
        for tick in 0..200 {
            for (from, to) in
                [("sensor_voltage_measured", "sensor_voltage"), ("voltage_measured", "voltage_applied")]
            {
                let value = get(&*run.plant, from);
                set(&mut *run.controller, to, value);
            }
            if tick == 100 {
                run.controller.apply_tunable_parameters();
            }
            run.controller.advance(1e-3, listener).unwrap();
            let voltage = get(&*run.controller, "voltage");
            set(&mut *run.plant, "voltage", voltage);
            set(&mut *run.plant, "force", 5.0 * f64::from(u8::from(tick > 50)));
            run.plant.advance(1e-3, listener).unwrap();
        }
        assert_eq!(ALLOCATIONS.get(), before.0, "{controller:?}");
        assert!(listener.0 > before.1, "the lost ball is worth a remark");
    }
}
