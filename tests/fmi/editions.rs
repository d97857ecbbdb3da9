//! Plain and clocked editions of the sampled models: the token selects what an importer may do and sees, and nothing else.

use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::{Edition, models};

use super::harness::clocked::{Choices, co_simulation_of, go_on, sampled_models};
use super::harness::{Component, ERROR, OK, Phase, Recorder, Standard, fmi3_logger, token};

const EVENTS: Choices = Choices { event_mode: true, early_return: true, intermediate_update: None };

/// The one message about an instance that was not made.
fn refusal(recorder: &Recorder, handle: *mut core::ffi::c_void) -> String {
    assert!(handle.is_null());
    let messages = recorder.take();
    assert_eq!(messages.len(), 1, "{messages:?}");
    messages[0].text.clone()
}

fn schedule(edition: Edition, model: &str, recorder: &Recorder) -> *mut core::ffi::c_void {
    let (name, token, log) = (c"x".as_ptr(), token(model, edition), Some(fmi3_logger as _));
    let environment = recorder.environment();
    // SAFETY: C strings, a living recorder, no other callbacks.
    unsafe {
        fmi3InstantiateScheduledExecution(
            name,
            token.as_ptr(),
            null(),
            0,
            0,
            environment,
            log,
            None,
            None,
            None,
        )
    }
}

#[test]
fn what_needs_clocks_is_refused_with_the_package_that_has_it() {
    for model in sampled_models() {
        let recorder = Recorder::default();
        for (edition, is_offered) in [(Edition::Plain, false), (Edition::Clocked, true)] {
            let made = [
                co_simulation_of(edition, model, EVENTS, recorder.environment()),
                schedule(edition, model, &recorder),
            ];
            let asked = ["co-simulation with event mode", "scheduled execution"];
            for (handle, asked) in made.into_iter().zip(asked) {
                if is_offered {
                    assert!(!handle.is_null(), "{model}: {:?}", recorder.messages());
                    drop(Component::from_handle(Standard::Fmi3, model, handle, Box::default()));
                } else {
                    assert!(handle.is_null(), "{model}: {asked}");
                }
            }
            if is_offered {
                continue;
            }
            recorder.clear();
            let said = |asked| {
                format!(
                    "{model} does not offer {asked}, only co-simulation; its package fmi3-clocked/{model}.fmu does"
                )
            };
            let text = refusal(&recorder, co_simulation_of(edition, model, EVENTS, recorder.environment()));
            assert!(text.ends_with(&said(asked[0])), "{text}");
            let text = refusal(&recorder, schedule(edition, model, &recorder));
            assert!(text.ends_with(&said(asked[1])), "{text}");
        }
    }
}

#[test]
fn no_package_is_named_where_none_offers_what_is_asked_for() {
    let recorder = Recorder::default();
    let handle = schedule(Edition::Plain, super::harness::PLANT, &recorder);
    let text = refusal(&recorder, handle);
    assert!(
        text.ends_with("does not offer scheduled execution, only co-simulation, model exchange"),
        "{text}"
    );
}

/// Guards: a recorder that registers every output, clocks among them, and got no instance.
#[test]
fn every_variable_of_the_edition_may_be_registered_for_intermediate_update() {
    let register = |model: &str, edition: Edition, references: &[u32], recorder: &Recorder| {
        let (token, environment) = (token(model, edition), recorder.environment());
        let (log, update) = (Some(fmi3_logger as _), Some(go_on as _));
        let (required, count) = (references.as_ptr(), references.len());
        // SAFETY: C strings, an array as long as its count says, a living recorder.
        let handle = unsafe {
            fmi3InstantiateCoSimulation(
                c"x".as_ptr(),
                token.as_ptr(),
                null(),
                0,
                1,
                0,
                0,
                required,
                count,
                environment,
                log,
                update,
            )
        };
        if !handle.is_null() {
            // SAFETY: a live handle that is not used again.
            unsafe { fmi3FreeInstance(handle) };
        }
        !handle.is_null()
    };
    for model in models().map(|model| model.description) {
        for edition in Edition::ALL.into_iter().filter(|edition| edition.suits(model)) {
            let count = (model.variables.len() + edition.clocks(model).count()) as u32;
            let recorder = Recorder::default();
            let all: Vec<u32> = (0..count).collect();
            assert!(
                register(model.name, edition, &all, &recorder),
                "{}: {:?}",
                model.name,
                recorder.messages()
            );
            assert!(!register(model.name, edition, &[count], &recorder), "{}", model.name);
            let said = format!("value reference {count} is unknown: expected 0 to {}", count - 1);
            assert!(recorder.messages().pop().unwrap().text.ends_with(&said), "{:?}", recorder.messages());
        }
    }
}

#[test]
fn clocks_exist_in_the_clocked_edition_only() {
    for model in sampled_models() {
        for (edition, exist) in [(Edition::Plain, false), (Edition::Clocked, true)] {
            let component = Component::co_simulation_of(edition, model, Choices::default());
            assert_eq!(component.enter_initialization(0.0, None), OK);
            component.recorder.clear();
            let [tick, _] = component.clocks();
            let count = component.description.variables.len();
            let unknown = |clock| format!("value reference {clock} is unknown: expected 0 to {}", count - 1);
            let (mut real, mut qualifier, mut counts) = (0.0, 0, (0, 0));
            // SAFETY: a live handle, one reference and room for one value each.
            let of_tick = unsafe {
                [
                    fmi3GetIntervalDecimal(component.handle, &tick, 1, &mut real, &mut qualifier),
                    fmi3GetIntervalFraction(
                        component.handle,
                        &tick,
                        1,
                        &mut counts.0,
                        &mut counts.1,
                        &mut qualifier,
                    ),
                    fmi3GetShiftDecimal(component.handle, &tick, 1, &mut real),
                    fmi3GetShiftFraction(component.handle, &tick, 1, &mut counts.0, &mut counts.1),
                ]
            };
            assert_eq!(of_tick, [if exist { OK } else { ERROR }; 4], "{model}, {edition:?}");
            if !exist {
                let messages = component.recorder.take();
                assert_eq!(messages.len(), of_tick.len());
                for message in messages {
                    assert!(message.text.contains(&unknown(tick)), "{}", message.text);
                }
            }
            // No getter of another type takes a clock for a variable, and only who knows of clocks is told of one.
            // SAFETY: a live handle, one reference, room for one value.
            let status = unsafe { fmi3GetFloat64(component.handle, &tick, 1, &mut real, 1) };
            let said = if exist { "is a clock".to_owned() } else { unknown(tick) };
            component.recorder.messages().iter().for_each(|message| {
                assert!(message.text.contains(&said), "{}", message.text);
            });
            assert_eq!((status, component.recorder.take().len()), (ERROR, 1));
        }
    }
}

/// Brings a clocked instance with events from communication point `from` to `to`, in steps of 1 ms, one tick each.
fn step_with_events(component: &Component, from: u32, to: u32) {
    for k in from..to {
        let time = f64::from(k) * 1e-3;
        if k > 0 {
            assert_eq!(component.enter_event_mode(), OK);
        }
        component.settle_event();
        assert_eq!(component.enter_step_mode(), OK);
        let step = component.step_to_event(time, 1e-3);
        assert_eq!((step.status, step.is_early), (OK, false), "{:?}", component.recorder.messages());
    }
}

#[test]
fn saved_states_cross_the_editions_where_the_phase_exists() {
    // Not every sample time is 1 ms; the clock is the model's own either way.
    for model in sampled_models().filter(|model| super::harness::description(model).step_size == 1e-3) {
        let clocked = Component::co_simulation(model, EVENTS);
        clocked.initialise(0.0);
        let in_event_mode = clocked.saved_bytes();
        step_with_events(&clocked, 0, 20);
        let bytes = clocked.saved_bytes();

        let plain = Component::in_phase(Standard::Fmi3, model, Phase::Step);
        assert_eq!(plain.restore_bytes(&bytes), OK, "{:?}", plain.recorder.messages());
        assert_eq!(plain.snapshot(), clocked.snapshot());
        for k in 20..40 {
            assert_eq!(plain.step(f64::from(k) * 1e-3, 1e-3), OK);
        }
        step_with_events(&clocked, 20, 40);
        assert_eq!(plain.snapshot(), clocked.snapshot(), "{model}: clocked to plain");

        assert_eq!(clocked.restore_bytes(&plain.saved_bytes()), OK, "{:?}", clocked.recorder.messages());
        step_with_events(&clocked, 40, 60);
        for k in 40..60 {
            assert_eq!(plain.step(f64::from(k) * 1e-3, 1e-3), OK);
        }
        assert_eq!(plain.snapshot(), clocked.snapshot(), "{model}: plain to clocked");

        // Event mode is a place where a plain instance never is.
        plain.recorder.clear();
        plain.assert_refused(plain.restore_bytes(&in_event_mode), &["event mode", "never reaches"]);
    }
}

#[test]
fn clocked_editions_of_models_without_clocks_do_not_exist() {
    let recorder = Recorder::default();
    let model = super::harness::PLANT;
    // The token is the plain one's, and so is what it selects.
    assert_eq!(token(model, Edition::Clocked), token(model, Edition::Plain));
    let handle = co_simulation_of(Edition::Clocked, model, EVENTS, recorder.environment());
    assert_eq!(handle, null_mut());
}
