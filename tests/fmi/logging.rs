//! Messages: when they come, what they carry.

use core::ffi::{CStr, c_char};
use core::ptr::null;

use maglev_fmu::fmi::fmi2::fmi2SetDebugLogging;
use maglev_fmu::fmi::fmi3::fmi3SetDebugLogging;

use super::harness::{
    BOTH, CONTROLLER, Component, ERROR, Message, OK, PLANT, Phase, Recorder, Standard, all, instantiate,
};

const CATEGORIES: [&CStr; 4] = [c"logStatusError", c"logStatusFatal", c"logEvents", c"logObserver"];

fn set_logging(component: &Component, on: bool, categories: &[&CStr]) -> i32 {
    let pointers: Vec<*const c_char> = categories.iter().map(|name| name.as_ptr()).collect();
    let start = if pointers.is_empty() { null() } else { pointers.as_ptr() };
    // SAFETY: a live handle and C strings.
    unsafe {
        match component.standard {
            Standard::Fmi2 => fmi2SetDebugLogging(component.handle, i32::from(on), pointers.len(), start),
            Standard::Fmi3 => fmi3SetDebugLogging(component.handle, u8::from(on), pointers.len(), start),
        }
    }
}

/// Categories of what is logged over a life with a convergence and a refused step.
fn categories_of_a_life(component: &Component) -> Vec<String> {
    component.initialise(0.0);
    for k in 0..6 {
        let t = f64::from(k) * 1e-3;
        component.set("position", 0.01 + t * t);
        assert_eq!(component.step(t, 1e-3), OK);
    }
    assert_eq!(component.get("observer.converged"), 1.0);
    assert_eq!(component.step(0.0, 1e-3), ERROR);
    assert_eq!(component.terminate(), OK);
    let mut categories: Vec<_> =
        component.recorder.take().into_iter().map(|message| message.category).collect();
    categories.sort();
    categories.dedup();
    categories
}

#[test]
fn categories_are_switched_one_by_one() {
    for standard in BOTH {
        let component = Component::new(standard, CONTROLLER);
        assert_eq!(categories_of_a_life(&component), ["logEvents", "logObserver", "logStatusError"]);

        let silent = Component::with_logging(standard, CONTROLLER, false);
        assert!(silent.recorder.take().is_empty(), "instantiation is not logged either");
        assert_eq!(categories_of_a_life(&silent), ["logStatusError"], "errors are always reported");

        for (category, expected) in [(c"logEvents", "logEvents"), (c"logObserver", "logObserver")] {
            let some = Component::with_logging(standard, CONTROLLER, false);
            assert_eq!(set_logging(&some, true, &[category]), OK);
            assert_eq!(categories_of_a_life(&some), [expected, "logStatusError"]);

            let others = Component::new(standard, CONTROLLER);
            others.recorder.clear();
            assert_eq!(set_logging(&others, false, &[category]), OK);
            assert!(!categories_of_a_life(&others).contains(&expected.to_owned()));
        }

        let none = Component::new(standard, CONTROLLER);
        none.recorder.clear();
        assert_eq!(set_logging(&none, false, &[]), OK);
        assert_eq!(categories_of_a_life(&none), ["logStatusError"]);
        let all = Component::with_logging(standard, CONTROLLER, false);
        assert_eq!(set_logging(&all, true, &CATEGORIES), OK);
        assert_eq!(categories_of_a_life(&all), ["logEvents", "logObserver", "logStatusError"]);
    }
}

#[test]
fn unknown_categories_change_nothing_and_are_answered_with_the_list() {
    for (standard, model) in all() {
        let component = Component::with_logging(standard, model, false);
        let status = set_logging(&component, true, &[c"logEvents", c"logEverything"]);
        component.assert_refused(status, &["SetDebugLogging", "\"logEverything\""]);
        let status = set_logging(&component, true, &[c""]);
        let list = CATEGORIES.map(|name| name.to_str().unwrap()).join(", ");
        component.assert_refused(status, &["the category \"\"", &list]);
        component.initialise(0.0);
        assert!(component.recorder.take().is_empty(), "logEvents is still off");
        // SAFETY: null with a count is what is tested; a null name, too.
        let status = unsafe {
            match standard {
                Standard::Fmi2 => [
                    fmi2SetDebugLogging(component.handle, 1, 1, null()),
                    fmi2SetDebugLogging(component.handle, 1, 1, &null()),
                ],
                Standard::Fmi3 => [
                    fmi3SetDebugLogging(component.handle, 1, 1, null()),
                    fmi3SetDebugLogging(component.handle, 1, 1, &null()),
                ],
            }
        };
        assert_eq!(status, [ERROR; 2]);
        let texts: Vec<_> = component.recorder.take().into_iter().map(|message| message.text).collect();
        assert!(texts[0].contains("the argument categories is a null pointer"), "{texts:?}");
        assert!(texts[1].contains("the category of a null pointer"), "{texts:?}");
    }
}

#[test]
fn messages_carry_environment_name_status_and_category() {
    for standard in BOTH {
        let component = Component::new(standard, PLANT);
        component.initialise(0.25);
        let expected_name = (standard == Standard::Fmi2).then(|| "under test".to_owned());
        let events = component.recorder.take();
        let texts: Vec<_> = events.iter().map(|message| message.text.as_str()).collect();
        let initialised = "MagneticBearingPlant initialised at t = 0.25 s";
        assert_eq!(texts, ["MagneticBearingPlant instantiated", initialised]);
        for message in events {
            assert_eq!(message.instance_name, expected_name);
            assert_eq!((message.status, message.category.as_str()), (OK, "logEvents"));
        }
        let status = component.step(0.25, -1.0);
        component.assert_refused(status, &["DoStep: communicationStepSize = -1 s"]);
    }
}

#[test]
fn convergence_is_logged_once_per_change() {
    for standard in BOTH {
        let component = Component::in_phase(standard, CONTROLLER, Phase::Instantiated);
        component.initialise(0.0);
        component.recorder.clear();
        let observed = |component: &Component| -> Vec<Message> {
            let messages = component.recorder.take();
            messages.into_iter().filter(|message| message.category == "logObserver").collect()
        };
        let mut converged = 0.0;
        let mut changes = 0;
        for k in 0..200 {
            let t = f64::from(k) * 1e-3;
            // Curvature, then none at all, where the flux cannot be seen.
            let position = if k % 50 < 25 { 0.01 + t * t } else { 0.01 };
            component.set("position", position);
            assert_eq!(component.step(t, 1e-3), OK);
            let now = component.get("observer.converged");
            let messages = observed(&component);
            assert_eq!(messages.len(), usize::from(now != converged), "k = {k}: {messages:?}");
            if let Some(message) = messages.first() {
                changes += 1;
                let verb = if now == 1.0 { "the observer converged" } else { "did not converge" };
                let time = format!("t = {} s: ", component.get("tick_time"));
                assert!(message.text.starts_with(&time) && message.text.contains(verb), "{message:?}");
                assert_eq!(message.status, OK);
            }
            converged = now;
        }
        println!("{standard:?}: {changes} changes");
        assert!(changes >= 3);
    }
}

/// Refusal of a token, which the message quotes.
fn refusal_of_token(standard: Standard, token: &CStr) -> String {
    let recorder = Recorder::default();
    // SAFETY: C strings, a living recorder.
    let handle =
        unsafe { instantiate(standard, c"100 % #1".as_ptr(), token.as_ptr(), recorder.environment(), false) };
    assert!(handle.is_null());
    let messages = recorder.take();
    assert_eq!(messages.len(), 1);
    // The name is an argument of its own, not part of the format.
    let name = messages[0].instance_name.as_deref();
    assert_eq!(name, (standard == Standard::Fmi2).then_some("100 % #1"));
    messages[0].text.clone()
}

#[test]
fn characters_with_a_meaning_are_escaped() {
    let quoted = "the token \"{50 %s %n ##r1##}\" is not one";
    let text = refusal_of_token(Standard::Fmi3, c"{50 %s %n #r1#}");
    assert!(text.contains(quoted), "{text}");
    // The message of FMI 2.0 is a format of printf.
    let text = refusal_of_token(Standard::Fmi2, c"{50 %s %n #r1#}");
    assert!(text.contains(&quoted.replace('%', "%%")), "{text}");
}

#[test]
fn long_messages_are_cut() {
    for (standard, letter) in
        BOTH.into_iter().flat_map(|standard| ["x", "%", "#", "ü"].map(|x| (standard, x)))
    {
        let token = std::ffi::CString::new(letter.repeat(100_000)).unwrap();
        let text = refusal_of_token(standard, &token);
        assert!((900..1024).contains(&text.len()), "{standard:?} {letter}: {}", text.len());
        // No escape is cut in half.
        let tail = text.chars().rev().take_while(|last| letter.starts_with(*last)).count();
        let escaped = letter == "#" || letter == "%" && standard == Standard::Fmi2;
        assert!(!escaped || tail % 2 == 0, "{standard:?} {letter}: {tail}");
    }
}
