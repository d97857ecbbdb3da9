//! Making instances: what is accepted, what is refused and why.

use core::ffi::{CStr, c_char, c_void};
use core::ptr::{null, null_mut};
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::{FMI2_MODEL_EXCHANGE, fmi2CallbackFunctions};
use maglev_fmu::fmi::fmi2::{
    fmi2FreeInstance, fmi2GetTypesPlatform, fmi2GetVersion, fmi2Instantiate, fmi2SetRealInputDerivatives,
};
use maglev_fmu::fmi::fmi3::{
    fmi3FreeInstance, fmi3GetVersion, fmi3InstantiateCoSimulation, fmi3InstantiateModelExchange,
    fmi3InstantiateScheduledExecution,
};
use maglev_fmu::model::{Edition, editions};

use super::harness::{
    BOTH, CONTROLLER, Component, ERROR, PLANT, Recorder, Standard, all, fmi2_logger, fmi3_logger,
    instantiate_with,
};

fn token(model: &str) -> CString {
    super::harness::token(model, Edition::Plain)
}

/// The one message about a failed instantiation.
#[track_caller]
fn refusal(recorder: &Recorder, handle: *mut c_void) -> String {
    assert!(handle.is_null());
    let messages = recorder.take();
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert_eq!((messages[0].status, messages[0].category.as_str()), (ERROR, "logStatusError"));
    messages[0].text.clone()
}

#[test]
fn versions_are_told() {
    // SAFETY: constant C strings.
    unsafe {
        assert_eq!(CStr::from_ptr(fmi2GetVersion()), c"2.0");
        assert_eq!(CStr::from_ptr(fmi2GetTypesPlatform()), c"default");
        assert_eq!(CStr::from_ptr(fmi3GetVersion()), c"3.0");
    }
}

#[test]
fn a_wrong_token_is_answered_with_the_right_ones() {
    for standard in BOTH {
        let right = token(PLANT);
        let upper = CString::new(right.to_str().unwrap().to_uppercase()).unwrap();
        let bare = CString::new(right.to_str().unwrap().trim_matches(['{', '}'])).unwrap();
        for wrong in [c"{00000000-0000-0000-0000-000000000000}", c"", c"\xff", &upper, &bare] {
            for logging_on in [false, true] {
                let recorder = Recorder::default();
                let logger = Some(fmi2_logger());
                // SAFETY: C strings, a living recorder.
                let handle = unsafe {
                    instantiate_with(
                        standard,
                        c"x".as_ptr(),
                        wrong.as_ptr(),
                        null(),
                        recorder.environment(),
                        logger,
                        Some(fmi3_logger),
                        logging_on,
                    )
                };
                let text = refusal(&recorder, handle);
                assert!(text.contains(&format!("\"{}\"", wrong.to_str().unwrap_or(""))), "{text}");
                for (model, edition) in editions() {
                    let token = edition.token(model.description);
                    let known = format!("{} for {}", token.as_str(), model.description.name);
                    assert!(text.contains(&known), "{text}");
                }
            }
        }
    }
}

#[test]
fn null_is_accepted_for_everything_but_the_token() {
    for (standard, model) in all() {
        let token = token(model);
        for (name, token, expected) in
            [(null(), token.as_ptr(), true), (c"x".as_ptr(), token.as_ptr(), true), (null(), null(), false)]
        {
            // SAFETY: null or C strings; no logger.
            let handle =
                unsafe { instantiate_with(standard, name, token, null(), null_mut(), None, None, true) };
            assert_eq!(!handle.is_null(), expected);
            if expected {
                let component = Component::from_handle(standard, model, handle, Box::default());
                // A refusal has nobody to tell.
                assert_eq!(component.step(0.0, -1.0), ERROR);
                component.initialise(0.0);
                assert_eq!(component.step(0.0, 1e-3), 0);
                assert_eq!(component.step(0.0, 1e-3), ERROR);
            }
        }
    }
    let token = token(PLANT);
    // SAFETY: no callbacks at all.
    unsafe {
        let handle = fmi2Instantiate(null(), 1, token.as_ptr(), null(), null(), 0, 1);
        assert!(!handle.is_null());
        fmi2FreeInstance(handle);
        fmi2FreeInstance(null_mut());
        fmi3FreeInstance(null_mut());
    }
}

#[test]
fn a_null_name_reaches_the_logger_as_an_empty_one() {
    let (recorder, token) = (Box::<Recorder>::default(), token(PLANT));
    let logger = Some(fmi2_logger());
    // SAFETY: null, C strings, a living recorder.
    let handle = unsafe {
        let environment = recorder.environment();
        instantiate_with(Standard::Fmi2, null(), token.as_ptr(), null(), environment, logger, None, true)
    };
    let component = Component::from_handle(Standard::Fmi2, PLANT, handle, recorder);
    assert_eq!(component.recorder.messages()[0].instance_name.as_deref(), Some(""));
}

#[test]
fn every_form_of_resource_path_is_accepted() {
    for (standard, model) in all() {
        let token = token(model);
        let recorder = Box::<Recorder>::default();
        for resources in [
            c"",
            c"file:///srv/fmu/resources",
            c"file:////srv/fmu/resources",
            c"file:/srv/fmu/resources",
            c"file://localhost/srv/fmu%20x/resources",
            c"/srv/fmu/resources/",
            c"/srv/fmu/resources",
            c"//srv//fmu//resources//",
            c"C:\\fmu\\resources\\",
            c"no such place",
            c"\xff\xfe",
        ] {
            let (logger2, logger3) = (Some(fmi2_logger()), Some(fmi3_logger as _));
            let environment = recorder.environment();
            // SAFETY: C strings, a living recorder.
            let handle = unsafe {
                let (name, resources) = (c"x".as_ptr(), resources.as_ptr());
                instantiate_with(
                    standard,
                    name,
                    token.as_ptr(),
                    resources,
                    environment,
                    logger2,
                    logger3,
                    false,
                )
            };
            assert!(!handle.is_null(), "{standard:?} {resources:?}");
            drop(Component::from_handle(standard, model, handle, Box::default()));
        }
        assert!(recorder.take().is_empty());
    }
}

#[test]
fn interfaces_that_are_not_offered_are_refused() {
    // A sampled model cannot be integrated.
    let (recorder, token) = (Recorder::default(), token(CONTROLLER));
    let (environment, token) = (recorder.environment(), token.as_ptr());
    let name: *const c_char = c"x".as_ptr();
    let functions = fmi2CallbackFunctions {
        logger: Some(fmi2_logger()),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: environment,
    };
    // SAFETY: C strings, a living recorder.
    unsafe {
        for kind in [FMI2_MODEL_EXCHANGE, 2, -1] {
            let handle = fmi2Instantiate(name, kind, token, null(), &functions, 0, 0);
            let text = refusal(&recorder, handle);
            assert!(text.starts_with("fmi2Instantiate: ") && text.contains("offer"), "{text}");
            assert_eq!(text.contains("model exchange"), kind == FMI2_MODEL_EXCHANGE, "{text}");
        }
        let log = Some(fmi3_logger as _);
        let handle = fmi3InstantiateModelExchange(name, token, null(), 0, 0, environment, log);
        let text = refusal(&recorder, handle);
        let said = "fmi3InstantiateModelExchange: MagneticBearingController does not offer model exchange";
        assert!(text.starts_with(said), "{text}");
        // A plant has no ticks.
        let token = self::token(PLANT);
        let token = token.as_ptr();
        let handle =
            fmi3InstantiateScheduledExecution(name, token, null(), 0, 0, environment, log, None, None, None);
        let text = refusal(&recorder, handle);
        assert!(
            text.starts_with(
                "fmi3InstantiateScheduledExecution: MagneticBearingPlant does not offer scheduled execution"
            ),
            "{text}"
        );
        let handle =
            fmi3InstantiateCoSimulation(name, token, null(), 0, 0, 1, 0, null(), 0, environment, log, None);
        let text = refusal(&recorder, handle);
        assert!(
            text.starts_with(
                "fmi3InstantiateCoSimulation: MagneticBearingPlant does not offer co-simulation with event \
                 mode, only co-simulation, model exchange"
            ),
            "{text}"
        );

        // Early return may be allowed by the importer, and intermediate variables asked for in vain.
        let wanted = [1, 2];
        let handle = fmi3InstantiateCoSimulation(
            name,
            token,
            null(),
            0,
            0,
            0,
            1,
            wanted.as_ptr(),
            2,
            environment,
            log,
            None,
        );
        assert!(!handle.is_null());
        fmi3FreeInstance(handle);
    }
}

#[test]
fn a_missing_capability_is_named() {
    let component = Component::in_phase(Standard::Fmi2, CONTROLLER, super::harness::Phase::Step);
    // SAFETY: a live handle; nothing is read.
    let status = unsafe { fmi2SetRealInputDerivatives(component.handle, null(), 0, null(), null()) };
    component.assert_refused(status, &["fmi2SetRealInputDerivatives: not offered", "held between ticks"]);
}
