//! The stop time is the end of time: "If the environment tries to compute past stopTime, the FMU has to return Error"
//! (FMI 2.0.5, section 2.1.6; FMI 3.0.2, section 2.3.2). And how far time goes back.

use super::harness::clocked::{Choices, sampled_models};
use super::harness::{BOTH, Component, OK, all, plants};

const STOP: f64 = 0.01;
/// Rounding of a last step of 1 ms, a billionth of it, and what is more than that \[s\].
const ROUNDING: f64 = 1e-12;
const MORE_THAN_ROUNDING: f64 = 1e-11;

fn stepping(component: Component) -> Component {
    assert_eq!(component.enter_initialization(0.0, Some(STOP)), OK);
    assert_eq!(component.exit_initialization(), OK);
    component.recorder.clear();
    component
}

#[test]
fn steps_end_at_the_stop_time() {
    for (standard, model) in all() {
        let component = stepping(Component::new(standard, model));
        let twin = stepping(Component::new(standard, model));
        let unstopped = Component::new(standard, model);
        unstopped.initialise(0.0);
        let said = "past the stop time: expected at most 0.01 s";
        component.assert_refused(component.step(0.0, 1.0), &[said, "= 1 s"]);
        for k in 0..9 {
            for instance in [&component, &twin, &unstopped] {
                assert_eq!(instance.step(f64::from(k) * 1e-3, 1e-3), OK, "{model}, step {k}");
            }
        }
        let before = component.snapshot();
        component.recorder.clear();
        component.assert_refused(component.step(9e-3, 1e-3 + MORE_THAN_ROUNDING), &[said]);
        assert_eq!(component.snapshot(), before);
        assert_eq!(component.step(9e-3, 1e-3 + ROUNDING), OK, "rounding");
        for instance in [&twin, &unstopped] {
            assert_eq!(instance.step(9e-3, 1e-3), OK);
        }
        twin.recorder.clear();
        for k in 10..15 {
            let time = f64::from(k) * 1e-3;
            twin.assert_refused(twin.step(time.min(STOP), 1e-3), &[said]);
            assert_eq!(unstopped.step(time, 1e-3), OK);
        }
        assert!((twin.get("time") - STOP).abs() <= 4.0 * f64::EPSILON * STOP);
    }
}

/// Guards: the last step of a long run refused, since the sum of its steps is 0.1 ns late and more.
#[test]
fn importers_that_add_up_their_steps_finish() {
    for standard in BOTH {
        for (h, steps) in [(1e-3, 100_000), (1e-4, 1_000_000)] {
            let component = Component::new(standard, "MagneticBearingController");
            let stop = 100.0;
            assert_eq!(component.enter_initialization(0.0, Some(stop)), OK);
            assert_eq!(component.exit_initialization(), OK);
            let mut time = 0.0;
            for step in 1..=steps {
                assert_eq!(component.step(time, h), OK, "step {step} of {h} s");
                time += h;
            }
            assert!(time - stop > 1e-7 * h, "late by more than 1e-9 of a step: {time}");
            // The model went along with the importer, and its clock with the number of steps.
            assert_eq!(component.get("time"), time);
            assert!((component.get("tick_time") - (stop - 1e-3)).abs() < 1e-9);
            component.recorder.clear();
            component.assert_refused(component.step(time, 1e-3 * h), &["past the stop time"]);
        }
    }
}

#[test]
fn saved_states_remember_the_stop_time() {
    for (standard, model) in all() {
        let component = stepping(Component::new(standard, model));
        let bytes = component.saved_bytes();
        let other = Component::new(standard, model);
        other.initialise(0.0);
        assert_eq!(other.restore_bytes(&bytes), OK);
        other.recorder.clear();
        other.assert_refused(other.step(0.0, 2.0 * STOP), &["past the stop time"]);
        // A new run has its own.
        assert_eq!(other.reset(), OK);
        other.initialise(0.0);
        assert_eq!(other.step(0.0, 2.0 * STOP), OK);
    }
}

#[test]
fn steps_that_end_at_ticks_are_asked_for_within_the_stop_time() {
    for model in sampled_models() {
        let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = stepping(Component::co_simulation(model, choices));
        assert_eq!(component.enter_step_mode(), OK);
        component.assert_refused(component.step_to_event(0.0, 1.0).status, &["past the stop time"]);
        assert_eq!(component.step_to_event(0.0, STOP).status, OK);
    }
}

#[test]
fn schedulers_activate_up_to_the_stop_time() {
    for model in sampled_models() {
        let component = stepping(Component::scheduled(model, None));
        assert_eq!(component.activate(0.0), OK);
        let said = "activationTime = 0.011 s is past the stop time: expected at most 0.01 s";
        component.assert_refused(component.activate(0.011), &[said]);
        assert_eq!(component.activate(STOP), OK);
    }
}

/// A solver that takes steps as it likes evaluates beyond the stop time and interpolates back (CVODE, as FMPy runs it).
#[test]
fn an_integration_ends_at_the_stop_time_though_its_solver_looks_beyond() {
    for (standard, model) in plants() {
        let component = stepping(Component::exchanged(standard, model));
        component.update_discrete_states();
        assert_eq!(component.enter_continuous_time(), OK);
        assert_eq!(component.set_time(9e-3), OK);
        assert_eq!(component.complete_integrator_step(), OK);
        component.recorder.clear();
        // Guards: rounding measured by the way since the step before the last one.
        assert_eq!(component.set_time(STOP + 1.5 * ROUNDING), OK);
        component.assert_refused(component.complete_integrator_step(), &["past the stop time"]);
        component.assert_refused(component.enter_event_mode(), &["past the stop time"]);
        assert_eq!(component.set_time(0.02), OK);
        assert!(component.derivatives().iter().all(|rate| rate.is_finite()));
        let said = "time = 0.02 s is past the stop time: expected at most 0.01 s";
        component.assert_refused(component.complete_integrator_step(), &[said]);
        component.assert_refused(component.enter_event_mode(), &[said]);
        assert_eq!(component.set_time(STOP + ROUNDING), OK, "interpolated, rounded");
        // Guards: the second call of either was measured by a way of no length.
        for _ in 0..2 {
            assert_eq!(component.complete_integrator_step(), OK);
            assert_eq!(component.complete_integrator_step(), OK);
            assert_eq!(component.enter_event_mode(), OK);
            component.update_discrete_states();
            assert_eq!(component.enter_continuous_time(), OK);
        }
        assert_eq!(component.enter_event_mode(), OK);
    }
}

#[test]
fn time_of_an_integration_goes_back_to_the_step_before_the_last() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        let complete = |time| {
            assert_eq!(component.set_time(time), OK);
            assert_eq!(component.complete_integrator_step(), OK);
        };
        component.assert_refused(component.set_time(-1e-3), &["time = -0.001 s", "expected at least 0 s"]);
        complete(1e-3);
        assert_eq!(component.set_time(0.0), OK, "back to the start");
        complete(1e-3);
        complete(2e-3);
        assert_eq!(component.set_time(1.5e-3), OK, "a value at an output point");
        component.assert_refused(component.set_time(0.5e-3), &["expected at least 0.001 s"]);
        assert_eq!(component.set_time(3e-3), OK);
        let bytes = component.saved_bytes();
        let enter_event = |instance: &Component| {
            assert_eq!(instance.enter_event_mode(), OK);
            instance.update_discrete_states();
            assert_eq!(instance.enter_continuous_time(), OK);
            instance.recorder.clear();
        };
        enter_event(&component);
        component.assert_refused(component.set_time(2.5e-3), &["expected at least 0.003 s"]);
        assert_eq!(component.set_time(3e-3), OK, "the event itself");
        // The state before the event knows nothing of it.
        assert_eq!(component.restore_bytes(&bytes), OK);
        assert_eq!(component.set_time(2.5e-3), OK);
    }
}
