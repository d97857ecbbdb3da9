//! One communication step: times that make no sense, results, experiments with and without an end.

use core::ptr::null_mut;

use maglev_fmu::fmi::fmi2::types::FMI2_LAST_SUCCESSFUL_TIME;
use maglev_fmu::fmi::fmi2::{fmi2EnterInitializationMode, fmi2GetRealStatus};
use maglev_fmu::fmi::fmi3::fmi3DoStep;

use super::harness::{BOTH, CONTROLLER, Component, ERROR, OK, PLANT, Phase, Standard, all};

#[test]
fn a_refused_step_names_its_numbers_and_changes_nothing() {
    for (standard, model) in all() {
        let component = Component::in_phase(standard, model, Phase::Step);
        let twin = Component::in_phase(standard, model, Phase::Step);
        let before = component.snapshot();
        let now = Component::STEPPED_TO;
        for h in [0.0, -0.0, -1e-3, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let said =
                format!("DoStep: communicationStepSize = {h} s: expected a finite step greater than 0 s");
            component.assert_refused(component.step(now, h), &[&said]);
        }
        for t in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let said = format!("DoStep: currentCommunicationPoint = {t} s: expected a finite time");
            component.assert_refused(component.step(t, 1e-3), &[&said]);
        }
        for t in [0.0, now - 1e-3, now + 1e-3, now + 1e-5, now - 1e-5, -now, 1e300] {
            let said =
                format!("currentCommunicationPoint = {t} s does not follow the last one: expected {now} s");
            component.assert_refused(component.step(t, 1e-3), &[&said]);
        }
        component.assert_refused(component.step(f64::MAX, f64::MAX), &["DoStep", "ends at a finite time"]);
        assert_eq!(component.snapshot(), before);

        for k in 0..3 {
            for instance in [&component, &twin] {
                assert_eq!(instance.step(now + f64::from(k) * 1e-3, 1e-3), OK);
            }
            assert_eq!(component.snapshot(), twin.snapshot());
        }
    }
}

#[test]
fn a_step_ends_at_a_finite_time() {
    let start = 1.7e308;
    for (standard, model) in all() {
        let component = Component::new(standard, model);
        if component.description.is_sampled() {
            // So far away no tick can be counted.
            let (_, sample_time) = component.description.find("sample_time").unwrap();
            assert_eq!(component.enter_initialization(start, None), OK);
            component.recorder.clear();
            let ticks = format!("so that ticks every {} s can be counted", sample_time.start);
            let said = ["ExitInitializationMode", "startTime = 1.7e308 s", &ticks];
            component.assert_refused(component.exit_initialization(), &said);
            continue;
        }
        component.initialise(start);
        component.recorder.clear();
        let before = component.snapshot();
        component.assert_refused(component.step(start, 1.7e308), &["communicationStepSize"]);
        assert_eq!(component.snapshot(), before);
        assert_eq!(component.get("time"), start);
    }
}

#[test]
fn a_state_that_would_not_be_finite_is_refused() {
    for standard in BOTH {
        let component = Component::in_phase(standard, PLANT, Phase::Step);
        let now = Component::STEPPED_TO;
        for (voltage, h) in [(1e300, 1e-3), (-1e200, 1.0), (1.0, 1e250)] {
            assert_eq!(component.set("voltage", voltage), OK);
            let before = component.snapshot();
            component.assert_refused(component.step(now, h), &["DoStep: ", "expected a finite number"]);
            assert_eq!(component.snapshot(), before);
        }
        assert_eq!(component.set("voltage", 4e-3), OK);
        let twin = Component::in_phase(standard, PLANT, Phase::Step);
        for instance in [&component, &twin] {
            assert_eq!(instance.step(now, 1e-3), OK);
        }
        assert_eq!(component.snapshot(), twin.snapshot());
    }
}

#[test]
fn a_step_with_too_many_ticks_is_refused_instead_of_never_ending() {
    for standard in BOTH {
        let component = Component::in_phase(standard, CONTROLLER, Phase::Step);
        let twin = Component::in_phase(standard, CONTROLLER, Phase::Step);
        let before = component.snapshot();
        for h in [1e12, 1e300, f64::MAX] {
            component.assert_refused(
                component.step(Component::STEPPED_TO, h),
                &["DoStep: a step of ", "expected at most "],
            );
        }
        assert_eq!(component.snapshot(), before);
        for instance in [&component, &twin] {
            assert_eq!(instance.step(Component::STEPPED_TO, 0.5), OK);
        }
        assert_eq!(component.snapshot(), twin.snapshot());
        assert!((component.get("tick_time") - 0.504).abs() < 1e-12);
    }
}

#[test]
fn results_of_fmi3_steps_are_set_when_asked_for() {
    for model in [PLANT, CONTROLLER] {
        let component = Component::in_phase(Standard::Fmi3, model, Phase::Step);
        let now = Component::STEPPED_TO;
        let (mut event, mut terminate, mut early, mut reached) = (7, 7, 7, -1.0);
        let mut step = |time| {
            // SAFETY: a live handle, room for the results.
            unsafe {
                fmi3DoStep(
                    component.handle,
                    time,
                    1e-3,
                    1,
                    &mut event,
                    &mut terminate,
                    &mut early,
                    &mut reached,
                )
            }
        };
        assert_eq!(step(now), OK);
        assert_eq!(step(now + 0.5), ERROR);
        assert_eq!((event, terminate, early), (0, 0, 0));
        assert_eq!(reached, now + 1e-3, "a refused step reaches nothing new");
        assert_eq!(component.get("time"), now + 1e-3);
        let [event, terminate, early] = [null_mut(); 3];
        // SAFETY: the results are not wanted.
        let status =
            unsafe { fmi3DoStep(component.handle, now + 1e-3, 1e-3, 1, event, terminate, early, null_mut()) };
        assert_eq!(status, OK);
        assert_eq!(component.get("time"), now + 2e-3);
    }
}

#[test]
fn last_successful_time_is_told_in_fmi2() {
    let component = Component::in_phase(Standard::Fmi2, PLANT, Phase::Step);
    let mut time = -1.0;
    // SAFETY: a live handle, room for the result, null.
    unsafe {
        assert_eq!(fmi2GetRealStatus(component.handle, FMI2_LAST_SUCCESSFUL_TIME, &mut time), OK);
        assert_eq!(fmi2GetRealStatus(component.handle, FMI2_LAST_SUCCESSFUL_TIME, null_mut()), OK);
    }
    assert_eq!(time, Component::STEPPED_TO);
}

/// A step may begin where the last one ended but for rounding, however long it is.
#[test]
fn a_step_that_does_not_follow_is_refused_however_long() {
    for (standard, model) in all() {
        let component = Component::in_phase(standard, model, Phase::Step);
        let now = Component::STEPPED_TO;
        let before = component.snapshot();
        for (time, h) in [
            (0.9, 1000.0),
            (0.9, 9e8),
            (0.9, 1e12),
            (0.0, 1e300),
            (now + 1e-6, 1e-3),
            (now - 1e-6, 1e-3),
            (0.0, 100.0),
        ] {
            let said = format!("currentCommunicationPoint = {time} s does not follow the last one");
            component.assert_refused(component.step(time, h), &[&said, "expected 0.005 s"]);
        }
        assert_eq!(component.snapshot(), before);
        assert_eq!(component.step(now + 1e-18, 1e-3), OK);
    }
}

#[test]
fn experiments_that_make_no_sense_are_refused() {
    for (standard, model) in all() {
        let component = Component::in_phase(standard, model, Phase::Instantiated);
        for (start, stop, said) in [
            (f64::NAN, None, "startTime = NaN s: expected a finite time"),
            (f64::INFINITY, None, "startTime = inf s"),
            (1.0, Some(0.5), "stopTime = 0.5 s: expected a time not before startTime"),
            (1.0, Some(f64::NAN), "stopTime = NaN s"),
        ] {
            component.assert_refused(component.enter_initialization(start, stop), &[said]);
        }
        // DBL_MAX and infinity stand for "no end".
        for stop in [f64::MAX, f64::INFINITY] {
            assert_eq!(component.enter_initialization(1.0, Some(stop)), OK);
            assert_eq!(component.get("time"), 1.0);
            assert_eq!(component.reset(), OK);
        }
    }
}

#[test]
fn time_starts_where_the_experiment_does() {
    for (standard, model) in all() {
        for start in [-3.0, 0.0025, 1e3, 1.7e9] {
            let component = Component::new(standard, model);
            component.initialise(start);
            component.recorder.clear();
            let said = format!("does not follow the last one: expected {start} s");
            component.assert_refused(component.step(start + 0.5, 1e-3), &[&said]);
            for k in 0..100 {
                assert_eq!(component.step(start + f64::from(k) * 1e-3, 1e-3), OK, "{start}");
            }
            assert!((component.get("time") - start - 0.1).abs() <= 4.0 * f64::EPSILON * start.abs().max(1.0));
        }
    }
}

#[test]
fn the_trajectory_does_not_depend_on_the_start_time() {
    for standard in BOTH {
        // Multiples of the sample time and powers of two: no rounding differs.
        let outputs = [0.0, -8.0, 4096.0].map(|start| {
            let component = Component::new(standard, CONTROLLER);
            component.initialise(start);
            let mut rows = Vec::new();
            for k in 0..50 {
                let t = f64::from(k) * 1e-3;
                assert_eq!(component.set("position", 0.01 - t * t), OK);
                assert_eq!(component.step(start + t, 1e-3), OK);
                assert!((component.get("tick_time") - start - t).abs() < 1e-9);
                rows.push(["voltage", "estimate.velocity", "estimate.flux"].map(|name| component.get(name)));
            }
            rows
        });
        assert!(outputs[0] == outputs[1] && outputs[0] == outputs[2]);
    }
}

#[test]
fn fmi2_starts_at_zero_without_an_experiment() {
    for model in [PLANT, CONTROLLER] {
        let component = Component::new(Standard::Fmi2, model);
        // SAFETY: a live handle.
        assert_eq!(unsafe { fmi2EnterInitializationMode(component.handle) }, OK);
        assert_eq!(component.exit_initialization(), OK);
        assert_eq!(component.get("time"), 0.0);
        assert_eq!(component.step(0.0, 1e-3), OK);
    }
}
