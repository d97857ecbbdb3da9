//! The host drives single instances of a small model of both versions.

use maglev_fmu::fmi::Status;
use maglev_fmu::host::{HostError, Logging, ReportedStatus};

use super::small_model::*;

#[test]
fn values_of_every_kind_go_in_and_out() {
    for fmu in both() {
        let mut model = fmu.instantiate("one", Logging::On).unwrap();
        drop(fmu);
        model.set_by_name("mode", "busy").unwrap();
        model.set_by_name("flag", true).unwrap();
        model.set_by_name("b", 2.0).unwrap();
        model.set_by_name("u", 3).unwrap();
        model.initialise(0.0, Some(1.0)).unwrap();
        model.step(0.0, 0.5).unwrap();
        model.step(0.5, 0.5).unwrap();
        let values = ["y", "mode", "flag", "steps"].map(|name| model.get_by_name(name).unwrap());
        assert_eq!(values, [12.0, 5.0, 1.0, 2.0]);

        let mut batch = [0.0; 3];
        model.get_reals(&[1, 3, 0], &mut batch).unwrap();
        assert_eq!(batch, [12.0, 2.0, 3.0]);
        model.set_reals(&[0, 2], &[-1.0, 0.5]).unwrap();
        model.step(1.0, 0.5).unwrap();
        assert_eq!(model.get_by_name("y").unwrap(), 4.0);
        model.terminate().unwrap();
        model.reset().unwrap();
        assert_eq!(model.get_by_name("steps").unwrap(), 0.0);
    }
}

#[test]
fn impossible_values_are_refused_before_they_reach_the_model() {
    for fmu in both() {
        let mut model = fmu.instantiate("one", Logging::Off).unwrap();
        let flag = model.variable("flag").unwrap();
        let mode = model.variable("mode").unwrap();
        assert!(
            matches!(model.set(flag, 0.5), Err(HostError::NotRepresentable { variable, .. }) if variable == "flag")
        );
        assert!(
            matches!(model.set(mode, 2.5), Err(HostError::NotRepresentable { variable, .. }) if variable == "mode")
        );
        assert!(matches!(model.set(mode, f64::NAN), Err(HostError::NotRepresentable { .. })));
        assert_eq!(
            model.set_by_name("mode", "asleep").unwrap_err().to_string(),
            "variable `mode` of instance `one` has no item `asleep`, only `idle`, `busy`"
        );
        assert!(matches!(model.set_by_name("u", true), Err(HostError::WrongKind { .. })));
        assert!(matches!(model.set_by_name("u", "1.0"), Err(HostError::WrongKind { .. })));
        assert!(matches!(model.set_by_name("flag", 1.0), Err(HostError::WrongKind { .. })));
        assert!(matches!(model.set_by_name("v", 1.0), Err(HostError::UnknownVariable { .. })));
        assert!(matches!(
            model.set_reals(&[0, 1], &[0.0]),
            Err(HostError::LengthMismatch { references: 2, values: 1, .. })
        ));
    }
    let [two, three] = both();
    let two = two.instantiate("two", Logging::Off).unwrap();
    assert_eq!(two.get_text(two.variable("text").unwrap()).unwrap(), "text");
    assert!(matches!(two.get_by_name("text"), Err(HostError::WrongKind { given: "number", .. })));
    let three = three.instantiate("three", Logging::Off).unwrap();
    assert!(matches!(three.variable("vector"), Err(HostError::Array { .. })));
    assert!(matches!(
        three.get_by_name("text"),
        Err(HostError::MissingFunction { function: "fmi3GetInt16", .. })
    ));
}

#[test]
fn a_bad_status_is_an_error_with_the_last_log_message() {
    for (fmu, text) in both().into_iter().zip(["100% wrong: %g %d %s", "100% wrong"]) {
        let mut model = fmu.instantiate("one", Logging::On).unwrap();
        model.initialise(0.0, None).unwrap();
        model.step(0.0, 97.0).expect("a warning is accepted");
        let error = model.step(0.0, -1.0).unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with(&format!("DoStep of instance `one` returned Error; its last log message: {text}"))
        );
        let HostError::Call { status, log, .. } = error else { panic!("{error}") };
        assert_eq!((status.known(), log.as_deref()), (Some(Status::Error), Some(text)));
        assert_eq!((model.log().len(), model.log()[0].category.as_str()), (1, "error"));
        assert!(matches!(model.step(0.0, 98.0), Err(HostError::Call { status: ReportedStatus(17), .. })));
        model.step(0.0, 0.1).expect("an error is not the end");
    }
}

#[test]
fn after_fatal_the_model_is_left_alone() {
    for fmu in both() {
        let mut model = fmu.instantiate("one", Logging::Off).unwrap();
        model.initialise(0.0, None).unwrap();
        let error = model.step(0.0, 99.0).unwrap_err();
        assert!(error.to_string().ends_with("DoStep of instance `one` returned Fatal and logged nothing"));
        assert!(matches!(model.step(0.0, 0.1), Err(HostError::Lost { .. })));
        assert!(matches!(model.get_by_name("y"), Err(HostError::Lost { .. })));
    }
}

#[test]
fn a_model_may_ask_to_terminate() {
    let mut model = open(FMI3).unwrap().instantiate("one", Logging::Off).unwrap();
    model.initialise(0.0, None).unwrap();
    assert!(matches!(
        model.step(0.25, 96.0),
        Err(HostError::TerminationRequested { time, .. }) if time == 0.25
    ));
}

#[test]
fn a_wrong_token_is_reported() {
    for fmu in both() {
        let error = fmu.instantiate_with_token("one", "left", Logging::Off).unwrap_err();
        assert!(matches!(&error, HostError::Instantiate { instance, .. } if instance == "one"), "{error}");
        assert!(matches!(fmu.instantiate("a\0b", Logging::Off), Err(HostError::NulInText { .. })));
    }
}

#[test]
fn states_are_saved_and_restored_by_their_own_instance_only() {
    let [two, three] = both();
    let mut model = three.instantiate("one", Logging::Off).unwrap();
    let mut other = three.instantiate("other", Logging::Off).unwrap();
    model.initialise(0.0, None).unwrap();
    model.set_by_name("u", 1.0).unwrap();
    model.step(0.0, 0.1).unwrap();
    let saved = model.save_state().unwrap();
    model.step(0.1, 0.1).unwrap();
    model.restore_state(&saved).unwrap();
    assert_eq!(model.get_by_name("y").unwrap(), 1.0);
    assert!(matches!(other.restore_state(&saved), Err(HostError::ForeignState { .. })));
    model.free_state(saved).unwrap();

    let mut model = two.instantiate("two", Logging::Off).unwrap();
    assert!(matches!(
        model.save_state(),
        Err(HostError::MissingFunction { function: "fmi2GetFMUstate", .. })
    ));
}

#[test]
fn instances_move_between_threads() {
    let fmu = open(FMI3).unwrap();
    let mut model = fmu.instantiate("one", Logging::Off).unwrap();
    let moved = std::thread::spawn(move || {
        model.initialise(0.0, None).unwrap();
        model.set_by_name("u", 2.0).unwrap();
        model.step(0.0, 0.1).unwrap();
        model
    });
    assert_eq!(moved.join().unwrap().get_by_name("y").unwrap(), 2.0);
}

#[test]
fn the_library_must_fit_the_description() {
    let only_version = |version: &str| {
        compile(&format!(
            "#[no_mangle] pub extern \"C\" fn fmi2GetVersion() -> *const std::ffi::c_char {{ c\"{version}\".as_ptr() }}"
        ))
    };
    let two = only_version("2.0");
    assert!(matches!(
        open_with(FMI2, &two),
        Err(HostError::MissingFunction { function: "fmi2Instantiate", .. })
    ));
    assert!(matches!(
        open_with(FMI3, &two),
        Err(HostError::MissingFunction { function: "fmi3GetVersion", .. })
    ));
    assert_eq!(
        open_with(FMI2, &only_version("3.0")).unwrap_err().to_string(),
        "fmi2GetVersion of `Two` returned \"3.0\", but its fmiVersion is 2.0"
    );
}
