//! Event mode of the sampled models: when events are announced, what happens at them, and what clocks tell.

use core::ptr::null_mut;

use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::variable::Causality;

use super::harness::clocked::{Choices, Step, Update, co_simulation, sampled_models};
use super::harness::{CONTROLLER, Component, ERROR, OK, PLANT, Phase, Recorder, Standard};

const EVENTS: Choices = Choices { event_mode: true, early_return: true, intermediate_update: None };

/// In the event mode that follows initialisation.
fn initialised(model: &str, start_time: f64) -> Component {
    let component = Component::co_simulation(model, EVENTS);
    component.initialise(start_time);
    component
}

/// In step mode, the events at the start behind it.
fn stepping(model: &str) -> Component {
    let component = initialised(model, 0.0);
    component.settle_event();
    assert_eq!(component.enter_step_mode(), OK);
    component.recorder.clear();
    component
}

#[test]
fn steps_end_at_ticks() {
    for model in sampled_models() {
        let component = initialised(model, 0.0);
        assert_eq!(component.set("sample_time", 1e-3), ERROR, "fixed");
        let period = component.get("sample_time");
        assert_eq!(component.settle_event(), period);
        assert_eq!(component.get("tick_time"), 0.0);
        assert_eq!(component.enter_step_mode(), OK);

        let (h, mut time) = (2.5 * period, 0.0);
        let early = Step { status: OK, is_event: true, is_early: true, reached: period };
        assert_eq!(component.step_to_event(time, h), early);
        assert_eq!(component.get("time"), period);
        assert_eq!(component.get("tick_time"), 0.0, "the tick is the importer's to run");
        // Until it does, time stands still.
        let again = component.step_to_event(period, h);
        assert_eq!(again, Step { reached: period, ..early });

        assert_eq!(component.enter_event_mode(), OK);
        assert_eq!(component.settle_event(), 2.0 * period, "the event after this one");
        assert_eq!(component.get("tick_time"), 0.0, "whose clock was not activated");
        assert_eq!(component.enter_step_mode(), OK);
        assert_eq!(component.get("tick_time"), period);
        time += period;
        // A tick at the end is an event, too, but ends nothing early.
        let step = component.step_to_event(time, period);
        assert_eq!(step, Step { is_early: false, reached: time + period, ..early });
        // Half a period on there is none.
        assert_eq!(component.enter_event_mode(), OK);
        component.settle_event();
        assert_eq!(component.enter_step_mode(), OK);
        let step = component.step_to_event(step.reached, 0.5 * period);
        assert!(!step.is_event && !step.is_early);
        // An event for any other reason runs no tick.
        assert_eq!(component.enter_event_mode(), OK);
        let update = component.end_event_iteration();
        assert_eq!(update, Update { status: OK, is_unfinished: false, next_event_time: Some(3.0 * period) });
        assert_eq!(component.enter_step_mode(), OK);
        assert_eq!(component.get("tick_time"), 2.0 * period);
    }
}

#[test]
fn a_tick_runs_when_its_clock_was_activated() {
    for model in sampled_models() {
        let component = initialised(model, 0.0);
        let [tick, ticked] = component.clocks();
        // Some outputs start from the inputs, so that the first tick would change nothing.
        move_inputs(&component, 0);
        let before = component.snapshot();
        let clocks = || [tick, ticked].map(|clock| component.get_clock(clock));
        assert_eq!(clocks(), [(OK, 0); 2]);
        let idle = component.end_event_iteration();
        let period = component.get("sample_time");
        assert_eq!(idle, Update { status: OK, is_unfinished: false, next_event_time: Some(period) });
        assert_eq!(component.snapshot(), before, "nobody has activated the clock");

        assert_eq!(component.set_clock(tick, 1), OK);
        assert_eq!(clocks(), [(OK, 1); 2], "the output clock is active with the input clock");
        assert_eq!(component.snapshot(), before, "by the model structure outputs depend on no clock");
        let update = component.end_event_iteration();
        assert_eq!(update, Update { is_unfinished: true, ..idle });
        assert_eq!(clocks(), [(OK, 0); 2], "the model deactivates its clocks");
        assert_ne!(component.snapshot(), before, "{model}");
        // "Periodic clocks must not be active for more than one call of fmi3UpdateDiscreteStates per Event Mode."
        let after = component.snapshot();
        component.recorder.clear();
        component.assert_refused(component.set_clock(tick, 1), &["no tick is due"]);
        assert_eq!(component.end_event_iteration(), idle);
        assert_eq!(component.enter_step_mode(), OK);
        assert_eq!(component.snapshot(), after, "ticked once");
    }
}

/// Sets another value in every input of a model.
fn move_inputs(component: &Component, k: u32) {
    let inputs = component.description.variables.iter().filter(|row| row.causality == Causality::Input);
    for (number, input) in inputs.enumerate() {
        let value = 1e-3 * f64::from(1 + k) * (1 + number) as f64;
        assert_eq!(component.set(input.name, value), OK, "{}", input.name);
    }
}

#[test]
fn a_tick_reads_the_inputs_at_its_activation_or_at_the_end_of_the_event() {
    for model in sampled_models() {
        let [iterating, ignorant, stepping] = [EVENTS, EVENTS, Choices::default()].map(|choices| {
            let component = Component::co_simulation(model, choices);
            component.initialise(0.0);
            component
        });
        let [tick, _] = iterating.clocks();
        let period = iterating.get("sample_time");
        for k in 0..20 {
            let time = f64::from(k) * period;
            // The event iterations of the plant come first, with the inputs of the last event.
            for component in [&iterating, &ignorant] {
                component.settle_event();
                move_inputs(component, k);
            }
            assert_eq!(iterating.set_clock(tick, 1), OK);
            iterating.settle_event();
            move_inputs(&stepping, k);
            assert_eq!(stepping.step(time, period), OK);
            for component in [&iterating, &ignorant] {
                assert_eq!(component.enter_step_mode(), OK);
                let step = component.step_to_event(time, period);
                assert!(step.status == OK && step.is_event, "{step:?}");
                assert_eq!(component.snapshot(), stepping.snapshot(), "{model}, tick {k}");
                assert_eq!(component.enter_event_mode(), OK);
            }
        }
    }
}

#[test]
fn clocks_are_refused_where_they_make_no_sense() {
    let component = initialised(CONTROLLER, 0.0005);
    let [tick, ticked] = component.clocks();
    component.recorder.clear();
    component.assert_refused(
        component.set_clock(tick, 1),
        &["no tick is due at t = 0.0005 s: expected t = 0.001 s"],
    );
    component.assert_refused(component.set_clock(ticked, 1), &["ticked", "the model itself activates"]);
    component.assert_refused(component.set_clock(ticked + 1, 1), &["value reference", "is unknown"]);
    component
        .assert_refused(component.get_clock(0).0, &["time (value reference 0) is a variable, not a clock"]);
    component
        .assert_refused(component.get_reals(&[tick], &mut [0.0]), &["tick", "is a clock, not a Float64"]);
    assert_eq!(component.set_clock(tick, 0), OK);
    let due = initialised(CONTROLLER, 0.0);
    assert_eq!(due.set_clock(tick, 1), OK);
    due.recorder.clear();
    due.assert_refused(due.set_clock(tick, 0), &["stays active"]);

    assert_eq!(component.enter_step_mode(), OK);
    component.assert_refused(component.get_clock(tick).0, &["step mode"]);
    component.assert_refused(component.set_clock(tick, 1), &["step mode"]);
}

#[test]
fn models_without_ticks_have_no_event_mode() {
    let recorder = Recorder::default();
    assert!(co_simulation(PLANT, EVENTS, recorder.environment()).is_null());
    assert!(
        recorder.messages().last().unwrap().text.contains("does not offer co-simulation with event mode")
    );
    for model in [PLANT, CONTROLLER] {
        let component = Component::in_phase(Standard::Fmi3, model, Phase::Step);
        component.assert_refused(component.enter_event_mode(), &["fmi3EnterEventMode: not offered"]);
    }
}

#[test]
fn the_phase_decides_what_may_be_called() {
    let component = initialised(CONTROLLER, 0.0);
    component.recorder.clear();
    component.assert_refused(component.step_to_event(0.0, 1e-3).status, &["fmi3DoStep", "event mode"]);
    component.assert_refused(component.enter_event_mode(), &["event mode"]);
    component.assert_refused(component.activate(0.0), &["event mode"]);
    assert_eq!(component.set("controller.k2", 1.0), OK);
    component.assert_refused(component.set("sample_time", 0.1), &["a fixed parameter"]);
    assert_eq!(component.enter_step_mode(), OK);
    component.assert_refused(component.end_event_iteration().status, &["step mode"]);
    component.assert_refused(component.enter_step_mode(), &["step mode"]);
    // SAFETY: a live handle.
    let status = unsafe { fmi3EvaluateDiscreteStates(component.handle) };
    component.assert_refused(status, &["step mode"]);
    assert_eq!(component.enter_event_mode(), OK);
    // SAFETY: a live handle.
    let status = unsafe { fmi3EvaluateDiscreteStates(component.handle) };
    assert_eq!(status, OK, "ignored, as the standard wants it where providesEvaluateDiscreteStates is false");
    // SAFETY: a live handle; the results are not wanted.
    let status = unsafe {
        let none = null_mut();
        fmi3UpdateDiscreteStates(component.handle, none, none, none, none, none, null_mut())
    };
    assert_eq!(status, OK);
    assert_eq!(component.terminate(), OK);
    assert_eq!(component.reset(), OK);
    component.initialise(0.0);
    assert_eq!(component.set_clock(component.clocks()[0], 1), OK);
    assert!(component.end_event_iteration().is_unfinished, "the first tick, again");
}

#[test]
fn a_start_between_two_ticks_waits_for_the_next_one() {
    let component = initialised(CONTROLLER, 0.0025);
    let update = component.end_event_iteration();
    assert_eq!((update.is_unfinished, update.next_event_time), (false, Some(0.003)));
    assert_eq!(component.enter_step_mode(), OK);
    let step = component.step_to_event(0.0025, 0.1);
    assert_eq!((step.is_event, step.is_early, step.reached), (true, true, 0.003));
}

#[test]
fn a_refused_step_changes_nothing() {
    let component = stepping(CONTROLLER);
    let before = component.snapshot();
    for (time, h) in [(0.0, 0.0), (0.0, f64::NAN), (1.0, 1e-3), (0.0, f64::INFINITY), (f64::NAN, 1e-3)] {
        let step = component.step_to_event(time, h);
        assert_eq!((step.status, step.is_event, step.is_early, step.reached), (ERROR, false, false, 0.0));
    }
    assert_eq!(component.snapshot(), before);
    // Any step that would be too long otherwise ends at the next tick.
    assert_eq!(component.step_to_event(0.0, 1e300).reached, 1e-3);
}

#[test]
fn a_state_saved_at_an_event_goes_on_with_the_event() {
    let component = initialised(CONTROLLER, 0.0);
    let [tick, ticked] = component.clocks();
    assert_eq!(component.set_clock(tick, 1), OK);
    let set = component.saved_bytes();
    component.end_event_iteration();
    let after = component.snapshot();
    assert_eq!(component.restore_bytes(&set), OK);
    assert_eq!([component.get_clock(tick), component.get_clock(ticked)], [(OK, 1); 2]);
    let other = Component::co_simulation(CONTROLLER, EVENTS);
    assert_eq!(other.restore_bytes(&set), OK);
    assert!(other.end_event_iteration().is_unfinished);
    assert_eq!(other.snapshot(), after);
    assert_eq!(other.settle_event(), 1e-3);

    // An instance without event mode, or of FMI 2.0, cannot go on from there.
    for standard in [Standard::Fmi2, Standard::Fmi3] {
        let simple = Component::new(standard, CONTROLLER);
        simple.recorder.clear();
        simple.assert_refused(simple.restore_bytes(&set), &["event mode", "never reaches"]);
        // From step mode it can, whatever made the ticks before.
        let source = stepping(CONTROLLER);
        assert_eq!(simple.restore_bytes(&source.saved_bytes()), OK);
        assert_eq!(simple.step(0.0, 1e-3), OK);
        assert_eq!(simple.step(1e-3, 1e-3), OK);
        assert_eq!(simple.get("tick_time"), 1e-3);
    }
}
