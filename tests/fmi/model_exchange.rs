//! Model exchange: an importer that integrates the plants gets what they compute themselves, discrete values change
//! at events only, and calls are refused where the standards forbid them.

use maglev_fmu::model::variable::{Causality, Kind, Variability};

use super::harness::{CONTROLLER, Component, DISCARD, ERROR, OK, Standard, plants};

/// Classical Runge-Kutta step of the importer from `time` over `h` \[s\].
fn runge_kutta(component: &Component, time: f64, h: f64) {
    let start = component.states();
    let rate = |share: f64, slope: &[f64]| {
        let states: Vec<f64> = start.iter().zip(slope).map(|(x, k)| x + share * h * k).collect();
        assert_eq!(component.set_time(time + share * h), OK);
        assert_eq!(component.set_states(&states), OK);
        component.derivatives()
    };
    let first = rate(0.0, &start);
    let second = rate(0.5, &first);
    let third = rate(0.5, &second);
    let fourth = rate(1.0, &third);
    let mean: Vec<f64> =
        (0..start.len()).map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0).collect();
    rate(1.0, &mean);
}

/// Inputs of a plant with values that move it, without contact for a few milliseconds.
fn excite(component: &Component) {
    for row in component.description.variables.iter().filter(|row| row.causality == Causality::Input) {
        let Kind::Real(quantity) = row.kind else { panic!("{} is not real", row.name) };
        let share = if row.name == "force" { 0.01 } else { 0.3 };
        assert_eq!(component.set(row.name, share * quantity.nominal), OK);
    }
}

#[test]
fn an_importer_that_integrates_gets_the_result_of_co_simulation() {
    for (standard, model) in plants() {
        let (solved, stepped) =
            (Component::in_continuous_time(standard, model), Component::new(standard, model));
        stepped.initialise(0.0);
        excite(&solved);
        excite(&stepped);
        for k in 0..200 {
            let time = f64::from(k) * 1e-4;
            runge_kutta(&solved, time, 1e-4);
            assert_eq!(stepped.step(time, 1e-4), OK);
        }
        let nominals = solved.nominals();
        for ((state, _), nominal) in solved.description.continuous_states().zip(nominals) {
            let name = solved.description.variables[state].name;
            let (one, other) = (solved.get(name), stepped.get(name));
            assert!((one - other).abs() < 1e-9 * nominal.max(other.abs()), "{model} {name}: {one} {other}");
        }
    }
}

#[test]
fn rows_and_vectors_tell_the_same() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        excite(&component);
        runge_kutta(&component, 0.0, 1e-3);
        let value = |row: usize| component.get(component.description.variables[row].name);
        let (states, derivatives): (Vec<f64>, Vec<f64>) = component
            .description
            .continuous_states()
            .map(|(state, derivative)| (value(state), value(derivative)))
            .unzip();
        assert_eq!(component.states(), states);
        assert_eq!(component.derivatives(), derivatives);
        let indicators: Vec<f64> = component.description.event_indicators().map(value).collect();
        assert_eq!(component.event_indicators(), indicators);
        assert!(indicators.iter().all(|indicator| *indicator != 0.0));
        assert!(component.nominals().iter().all(|nominal| *nominal > 0.0));
        assert_eq!(component.get("time"), 1e-3);
    }
}

#[test]
fn discrete_outputs_change_at_events_only() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        let discrete: Vec<u32> = (0..component.description.variables.len() as u32)
            .filter(|reference| component.variable(*reference).variability == Variability::Discrete)
            .collect();
        let read = || -> Vec<f64> { discrete.iter().map(|row| component.get_reference(*row).1).collect() };
        let before = read();
        excite(&component);
        runge_kutta(&component, 0.0, 1e-3);
        assert_eq!(read(), before, "{model}");
        // The voltage that acts is no discrete value: it does so at once.
        assert_eq!(component.get("voltage_measured"), component.get("voltage"));
        let Some((_, stop)) = component.description.find("initial.position") else { unreachable!() };
        if component.description.find("contact").is_some() {
            let mut states = component.states();
            (states[0], states[1]) = (stop.range.0, 0.0);
            assert_eq!(component.set_states(&states), OK);
            assert_eq!(read(), before, "{model}");
            assert_eq!(component.enter_event_mode(), OK);
            assert!(component.update_discrete_states());
            assert_ne!(read(), before, "{model}");
        }
    }
}

#[test]
fn the_bearings_flux_announces_its_sign() {
    for standard in super::harness::BOTH {
        let component = Component::in_continuous_time(standard, super::harness::PLANT);
        for (flux, positive) in [(0.05, true), (-0.05, false), (-1e-12, false), (0.0, false), (1e-9, true)] {
            assert_eq!(component.set_states(&[0.0, 0.0, flux]), OK);
            assert_eq!(
                component.event_indicators()[0] > 0.0,
                positive || flux == 0.0 && flux > 0.0,
                "{flux}"
            );
            assert_eq!(component.enter_event_mode(), OK);
            assert!(!component.update_discrete_states());
            assert_ne!(component.event_indicators()[0], 0.0);
            assert_eq!(component.event_indicators()[0] > 0.0, positive, "{flux}");
            assert_eq!(component.enter_continuous_time(), OK);
        }
    }
}

#[test]
fn states_that_make_no_sense_are_discarded() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        let before = component.snapshot();
        let mut states = component.states();
        states[1] = f64::NAN;
        assert_eq!(component.set_states(&states), DISCARD);
        assert!(component.recorder.take()[0].text.contains("velocity = NaN m/s: expected a finite number"));
        for wrong in [0, 1, states.len() + 1] {
            let said = format!("nx = {wrong}: expected {}", states.len());
            component.assert_refused(component.set_states(&vec![0.0; wrong]), &[&said]);
        }
        let said = "time = inf s: expected a finite time";
        component.assert_refused(component.set_time(f64::INFINITY), &[said]);
        assert_eq!(component.snapshot(), before);
    }
}

#[test]
fn what_may_be_set_depends_on_the_phase() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        assert_eq!(component.set("voltage", 1.0), OK);
        // Both standards let continuous states be set by their references, too.
        assert_eq!(component.set("velocity", 0.125), OK);
        assert_eq!(component.states()[1], 0.125);
        let said = "sensor.noise is a parameter and cannot be set in the phase \"continuous-time mode\"";
        component.assert_refused(component.set("sensor.noise", 1e-3), &[said]);
        component.assert_refused(component.set("voltage_measured", 0.0), &["calculated by the model"]);
        assert_eq!(component.enter_event_mode(), OK);
        assert_eq!(component.set("sensor.noise", 1e-3), OK);
        assert_eq!(component.set("voltage", 2.0), OK);
        component.assert_refused(component.set("initial.position", 0.0), &["a fixed parameter"]);
    }
}

/// In instantiated, initialization mode, event mode, continuous-time mode and terminated: `x` allowed, `.` forbidden.
type Rule = (&'static str, &'static str, fn(&Component) -> i32);

#[rustfmt::skip]
const RULES: &[Rule] = &[
    ("EnterEventMode", "...x.", |c| c.enter_event_mode()),
    ("EnterContinuousTimeMode", "..x..", |c| c.enter_continuous_time()),
    ("SetTime", "...x.", |c| c.set_time(0.0)),
    ("SetContinuousStates", "...x.", |c| c.set_states(&vec![0.001; c.state_count()])),
    ("DoStep", ".....", |c| c.step(0.0, 1e-3)),
    ("EnterInitializationMode", "x....", |c| c.plain(maglev_fmu::fmi::fmi2::fmi2EnterInitializationMode, enter3)),
    ("ExitInitializationMode", ".x...", |c| c.exit_initialization()),
    ("Terminate", "..xx.", |c| c.terminate()),
    ("Reset", "xxxxx", |c| c.reset()),
];

unsafe extern "C-unwind" fn enter3(handle: *mut core::ffi::c_void) -> i32 {
    // SAFETY: the caller's promise.
    unsafe { maglev_fmu::fmi::fmi3::fmi3EnterInitializationMode(handle, 0, 0.0, 0.0, 0, 0.0) }
}

/// An instance in the phase with the given place in the rules.
fn in_phase(standard: Standard, model: &str, phase: usize) -> Component {
    let component = match phase {
        3 => Component::in_continuous_time(standard, model),
        _ => Component::exchanged(standard, model),
    };
    if phase == 1 {
        assert_eq!(component.enter_initialization(0.0, None), OK);
    }
    if matches!(phase, 2 | 4) {
        component.initialise(0.0);
    }
    if phase == 4 {
        assert_eq!(component.terminate(), OK);
    }
    component.recorder.clear();
    component
}

#[test]
fn calls_are_refused_exactly_where_model_exchange_forbids_them() {
    for (standard, model) in plants() {
        for (name, allowed, call) in RULES {
            for (phase, mark) in allowed.chars().enumerate() {
                let component = in_phase(standard, model, phase);
                // FMI 2.0 lets event mode be entered again from itself.
                let again = standard == Standard::Fmi2 && *name == "EnterEventMode" && phase == 2;
                let expected = if mark == 'x' || again { OK } else { ERROR };
                let status = call(&component);
                assert_eq!(status, expected, "{standard:?} {model} {name} in phase {phase}");
                assert_eq!(
                    component.recorder.messages().iter().filter(|m| m.status == ERROR).count(),
                    usize::from(expected == ERROR)
                );
            }
        }
        // Vectors can be had once there is something to compute them from.
        for phase in 1..5 {
            let component = in_phase(standard, model, phase);
            assert_eq!(component.states().len(), component.derivatives().len());
            component.event_indicators();
            component.nominals();
        }
    }
}

#[test]
fn a_reset_instance_starts_anew() {
    for (standard, model) in plants() {
        let fresh = Component::in_continuous_time(standard, model);
        let used = Component::in_continuous_time(standard, model);
        excite(&used);
        runge_kutta(&used, 0.0, 1e-3);
        assert_eq!(used.reset(), OK);
        for row in used.description.variables.iter().filter(|row| row.causality == Causality::Input) {
            assert_eq!(used.set(row.name, row.start), OK);
        }
        used.initialise(0.0);
        used.update_discrete_states();
        assert_eq!(used.enter_continuous_time(), OK);
        assert_eq!(used.snapshot(), fresh.snapshot());
    }
}

#[test]
fn functions_of_the_other_interface_are_refused() {
    for (standard, model) in plants() {
        let stepped = Component::in_phase(standard, model, super::harness::Phase::Initialization);
        let mut room = [0.0; 8];
        // SAFETY: a live handle and room.
        let status = unsafe {
            match standard {
                Standard::Fmi2 => {
                    maglev_fmu::fmi::fmi2::fmi2GetDerivatives(stepped.handle, room.as_mut_ptr(), 3)
                }
                Standard::Fmi3 => maglev_fmu::fmi::fmi3::fmi3GetContinuousStateDerivatives(
                    stepped.handle,
                    room.as_mut_ptr(),
                    3,
                ),
            }
        };
        stepped.assert_refused(status, &["not a function of co-simulation, for which the instance was made"]);
    }
    let controller = Component::in_phase(Standard::Fmi3, CONTROLLER, super::harness::Phase::Step);
    let status = controller.directional(&[], &[], &[], &mut []);
    controller.assert_refused(status, &["not offered by this model: its outputs are held between ticks"]);
}

#[test]
fn status_functions_of_fmi2_are_those_of_co_simulation() {
    let (_, model) = plants().next().unwrap();
    let component = Component::in_continuous_time(Standard::Fmi2, model);
    let mut time = 0.0;
    for terminates in [false, true] {
        if terminates {
            assert_eq!(component.terminate(), OK);
            component.recorder.clear();
        }
        // SAFETY: a live handle, room for the result.
        let status = unsafe {
            use maglev_fmu::fmi::fmi2::{fmi2GetRealStatus, types::FMI2_LAST_SUCCESSFUL_TIME};
            fmi2GetRealStatus(component.handle, FMI2_LAST_SUCCESSFUL_TIME, &mut time)
        };
        let said = if terminates { "not a function of model exchange" } else { "continuous-time mode" };
        component.assert_refused(status, &[said]);
    }
}

/// FMI 2.0.5, table in section 3.2.3, conditions 4 and 5; FMI 3.0.2, section 2.3.5.
#[test]
fn a_state_that_does_not_jump_is_set_at_an_event_by_fmi3_only() {
    for (standard, model) in plants() {
        let component = Component::in_continuous_time(standard, model);
        let states = component.description.continuous_states().map(|(state, _)| state);
        for state in states.map(|state| &component.description.variables[state]) {
            assert_eq!(component.set(state.name, 1e-3), OK, "in continuous time");
            assert_eq!(component.enter_event_mode(), OK);
            let status = component.set(state.name, 1e-3);
            if standard == Standard::Fmi3 && !state.is_reinitialised {
                assert_eq!(status, OK, "{}", state.name);
            } else {
                component.assert_refused(status, &[state.name, "a continuous state", "event mode"]);
            }
            assert_eq!(component.enter_continuous_time(), OK);
        }
    }
}
