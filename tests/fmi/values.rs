//! Values go in and out as they are, and take effect when the standards say.

use maglev_fmu::model::variable::{Causality, Kind, Variability, Variable};

use super::harness::{BOTH, CONTROLLER, Component, OK, PLANT, Phase, all, bearing};

/// An allowed value other than the start value.
pub fn other_value(variable: &Variable) -> f64 {
    let (minimum, maximum) = variable.range;
    match variable.kind {
        Kind::Real(_) if minimum.is_finite() => minimum + 0.371 * (maximum - minimum),
        Kind::Real(_) => -0.123_456_789_012_345_68,
        Kind::Integer => ((minimum + maximum) / 3.0).floor(),
        Kind::Boolean => 1.0 - variable.start,
        Kind::Enumeration(enumeration) => enumeration.items.len() as f64,
    }
}

#[test]
fn every_variable_goes_in_and_out_by_reference() {
    for (standard, model) in all() {
        for phase in [Phase::Instantiated, Phase::Initialization, Phase::Step] {
            let mut settable = 0;
            for (reference, variable) in (0..).zip(Component::new(standard, model).description.variables) {
                let component = Component::in_phase(standard, model, phase);
                let context = format!("{standard:?} {model} {} in {}", variable.name, phase.name());
                let value = other_value(variable);
                let status = component.set_reference(reference, value);
                let may = match (variable.causality, variable.variability) {
                    (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) => true,
                    (Causality::Parameter, _) => phase != Phase::Step,
                    _ => false,
                };
                if may {
                    settable += 1;
                    assert_eq!(status, OK, "{context} {:?}", component.recorder.messages());
                    if phase == Phase::Instantiated {
                        assert_eq!(component.enter_initialization(0.0, None), OK);
                    }
                    let (status, read) = component.get_reference(reference);
                    assert_eq!((status, read.to_bits()), (OK, value.to_bits()), "{context}");
                } else {
                    component.assert_refused(status, &[variable.name, "cannot be set", phase.name()]);
                    if phase != Phase::Instantiated {
                        assert!(component.get_reference(reference).1.is_finite(), "{context}");
                    }
                }
            }
            println!("{standard:?} {model} {}: {settable} settable", phase.name());
            assert!(settable >= if phase == Phase::Step { 4 } else { 10 });
        }
    }
}

#[test]
fn extremes_of_every_range_are_accepted() {
    for (standard, model) in all() {
        let component = Component::in_phase(standard, model, Phase::Initialization);
        for (reference, variable) in (0..).zip(component.description.variables) {
            let (minimum, maximum) = match variable.kind {
                Kind::Enumeration(enumeration) => (1.0, enumeration.items.len() as f64),
                _ => variable.range,
            };
            if variable.is_calculated() || !minimum.is_finite() {
                continue;
            }
            for value in [minimum, maximum, variable.start] {
                assert_eq!(component.set_reference(reference, value), OK, "{} = {value}", variable.name);
            }
        }
        assert_eq!(component.exit_initialization(), OK);
    }
}

#[test]
fn calculated_values_follow_during_initialisation() {
    for standard in BOTH {
        let plant = Component::in_phase(standard, PLANT, Phase::Initialization);
        for bias in [0.0, 1e-3, 2.5e-4, 0.0] {
            assert_eq!(plant.set("bias_flux", bias), OK);
            assert_eq!(plant.get("epsilon"), 2.0 * bias / 0.0022);
        }
        assert_eq!(plant.set("saturation_flux", 0.01), OK);
        assert_eq!(plant.set("bias_flux", 0.005), OK);
        assert_eq!(plant.get("epsilon"), 1.0);
        for (parameter, outputs, value) in [
            ("initial.position", &["position", "position_measured"][..], -0.125),
            ("initial.velocity", &["velocity"], 2.0),
            ("initial.flux", &["flux"], -0.5),
        ] {
            assert_eq!(plant.set(parameter, value), OK);
            for output in outputs {
                assert_eq!(plant.get(output), value, "{output}");
            }
        }
        // x2' = epsilon x3 + x3 |x3|
        assert_eq!(plant.get("acceleration"), -0.5 - 0.25);
        assert_eq!(plant.exit_initialization(), OK);
        assert_eq!(["position", "velocity", "flux"].map(|name| plant.get(name)), [-0.125, 2.0, -0.5]);
        // A later bias has no way in.
        assert_ne!(plant.set("bias_flux", 1e-3), OK);
        assert_eq!(plant.get("epsilon"), 1.0);

        let controller = Component::in_phase(standard, CONTROLLER, Phase::Initialization);
        assert_eq!(controller.set("observer.initial.velocity", -3.0), OK);
        assert_eq!(controller.get("estimate.velocity"), -3.0);
    }
}

/// Choices under which a tunable parameter of the controller has anything to say.
fn relevant_choice(name: &str) -> Option<(&'static str, f64)> {
    match name {
        "observer.position_noise" | "observer.flux_noise" => Some(("observer.kind", 4.0)),
        _ if name.starts_with("controller.cascade.") => Some(("controller.law", 4.0)),
        _ => None,
    }
}

/// Outputs of the controller fed with a fixed movement, or of the plant under a fixed voltage; at the start of step
/// `change.0` the variable `change.1` gets another value.
fn run(component: &Component, choice: Option<(&str, f64)>, change: Option<(i32, u32)>) -> Vec<Vec<u64>> {
    if let Some((name, value)) = choice {
        assert_eq!(component.set(name, value), OK);
    }
    component.initialise(0.0);
    let rows = (0..40).map(|k| {
        let t = f64::from(k) * 1e-3;
        if component.description.name == PLANT {
            assert_eq!(component.set("voltage", 20.0 - f64::from(k)), OK);
        } else {
            assert_eq!(component.set("position", 0.01 - 0.3 * t * t + 20.0 * t * t * t), OK);
            assert_eq!(component.set("state.velocity", 0.01), OK);
            assert_eq!(component.set("state.flux", 0.02), OK);
        }
        if let Some((step, reference)) = change
            && step == k
        {
            let variable = component.variable(reference);
            // A limit above the outputs would limit nothing.
            let is_limit = variable.name == "controller.voltage_limit";
            let value = if is_limit { 0.125 } else { other_value(variable) };
            assert_eq!(component.set_reference(reference, value), OK);
        }
        assert_eq!(component.step(t, 1e-3), OK);
        let outputs = component.description.variables.iter().enumerate();
        outputs
            .filter(|(_, variable)| variable.causality == Causality::Output)
            .map(|(reference, _)| component.get_reference(reference as u32).1.to_bits())
            .collect()
    });
    rows.collect()
}

#[test]
fn every_tunable_takes_effect_at_the_next_step_and_not_before() {
    let mut tried = 0;
    for (standard, model) in bearing() {
        for (reference, variable) in (0..).zip(Component::new(standard, model).description.variables) {
            if variable.variability != Variability::Tunable {
                continue;
            }
            tried += 1;
            // Three ticks fill the observer's window; what concerns its iterations shows in the fourth.
            let choice = relevant_choice(variable.name);
            let reference_run = run(&Component::new(standard, model), choice, None);
            let changed = run(&Component::new(standard, model), choice, Some((3, reference)));
            let first_difference = (0..40).find(|k| changed[*k] != reference_run[*k]);
            println!("{standard:?} {model} {}: from step {first_difference:?} on", variable.name);
            assert!(
                first_difference.is_some_and(|k| (3..8).contains(&k)),
                "{} {first_difference:?}",
                variable.name
            );
        }
    }
    assert_eq!(tried, 2 * (3 + 14));
}
