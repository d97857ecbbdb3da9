//! Values that are refused, and that a refused call changes nothing.

use maglev_fmu::fmi::fmi3::fmi3SetInt64;
use maglev_fmu::model::variable::{Causality, Kind, Variable};

use super::harness::{BOTH, CONTROLLER, Component, ERROR, OK, PLANT, Phase, Standard, all, bearing};
use super::values::other_value;

/// Phases in which inputs can be set and everything can be read.
pub const OPEN: [Phase; 2] = [Phase::Initialization, Phase::Step];

fn may_be_set(variable: &Variable, phase: Phase) -> bool {
    use maglev_fmu::model::variable::Variability;
    match variable.causality {
        Causality::Input => true,
        Causality::Parameter => phase != Phase::Step || variable.variability == Variability::Tunable,
        _ => false,
    }
}

#[test]
fn non_finite_reals_are_refused_everywhere() {
    let mut tried = 0;
    for (standard, model) in all() {
        for phase in OPEN {
            let component = Component::in_phase(standard, model, phase);
            let before = component.snapshot();
            for (reference, variable) in (0..).zip(component.description.variables) {
                if !matches!(variable.kind, Kind::Real(_)) || !may_be_set(variable, phase) {
                    continue;
                }
                for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    tried += 1;
                    let status = component.set_reference(reference, value);
                    let said = format!("{} = {value} {}", variable.name, variable.unit());
                    component.assert_refused(status, &[&said, "expected a finite number"]);
                }
            }
            assert_eq!(component.snapshot(), before);
            assert!(component.is_still_in(phase));
        }
    }
    println!("{tried} refused");
    assert!(tried > 250);
}

/// A number as messages show it: nobody reads three hundred digits.
fn shown(value: f64) -> String {
    let has_few_zeros = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    if has_few_zeros { value.to_string() } else { format!("{value:e}") }
}

#[test]
fn values_out_of_range_are_refused_with_the_range() {
    let mut tried = 0;
    for (standard, model) in all() {
        for phase in OPEN {
            let component = Component::in_phase(standard, model, phase);
            let before = component.snapshot();
            for (reference, variable) in (0..).zip(component.description.variables) {
                if !may_be_set(variable, phase) {
                    continue;
                }
                let (minimum, maximum) = variable.range;
                let (wrong, expectation) = match variable.kind {
                    Kind::Real(_) if minimum.is_finite() => (
                        vec![minimum.next_down(), maximum.next_up(), f64::MAX, f64::MIN],
                        format!("expected {} to {} {}", shown(minimum), shown(maximum), variable.unit()),
                    ),
                    Kind::Integer => {
                        let all = vec![minimum - 1.0, maximum + 1.0, f64::from(i32::MIN)];
                        // Nothing above fits the type.
                        let fitting = all.into_iter().filter(|value| *value <= f64::from(i32::MAX));
                        (fitting.collect(), format!("expected {} to {} ", shown(minimum), shown(maximum)))
                    }
                    Kind::Enumeration(enumeration) => {
                        let count = enumeration.items.len();
                        let wrong = vec![0.0, count as f64 + 1.0, -1.0, f64::from(i32::MAX)];
                        (wrong, format!("expected an item of {}, 1 to {count}", enumeration.name))
                    }
                    _ => continue,
                };
                for value in wrong {
                    tried += 1;
                    let status = component.set_reference(reference, value);
                    let said = format!("{} = {}", variable.name, shown(value));
                    component.assert_refused(status, &[&said, &expectation]);
                }
            }
            assert_eq!(component.snapshot(), before);
            assert!(component.is_still_in(phase));
        }
    }
    println!("{tried} refused");
    assert!(tried > 200);
}

#[test]
fn enumeration_numbers_of_64_bits_do_not_wrap() {
    let component = Component::in_phase(Standard::Fmi3, CONTROLLER, Phase::Step);
    let law = component.reference("controller.law");
    for value in [i64::MAX, i64::MIN, (1 << 32) + 1, (1 << 53) + 1] {
        // SAFETY: one reference, one value.
        let status = unsafe { fmi3SetInt64(component.handle, &law, 1, &value, 1) };
        component.assert_refused(status, &["controller.law", "an item of BearingLaw, 1 to 4"]);
    }
    assert_eq!(component.get("controller.law"), 1.0);
}

#[test]
fn a_refused_call_sets_nothing_at_all() {
    for (standard, model) in bearing() {
        for phase in OPEN {
            let component = Component::in_phase(standard, model, phase);
            let twin = Component::in_phase(standard, model, phase);
            let settable: Vec<(u32, f64)> = (0..)
                .zip(component.description.variables)
                .filter(|(_, variable)| matches!(variable.kind, Kind::Real(_)) && may_be_set(variable, phase))
                .map(|(reference, variable)| (reference, other_value(variable)))
                .collect();
            let (references, values): (Vec<_>, Vec<_>) = settable.into_iter().unzip();
            let before = component.snapshot();
            // The bad one comes last, first, in the middle.
            for place in [references.len(), 0, references.len() / 2] {
                for (reference, value) in [(0, 1.0), (999, 1.0), (references[0], f64::NAN)] {
                    let (mut bad_references, mut bad_values) = (references.clone(), values.clone());
                    bad_references.insert(place, reference);
                    bad_values.insert(place, value);
                    assert_eq!(component.set_reals(&bad_references, &bad_values), ERROR);
                    assert_eq!(component.snapshot(), before);
                }
            }
            assert_eq!(component.set_reals(&references, &values), OK);
            assert_ne!(component.snapshot(), before, "the same call without the bad one works");

            // The twin never saw a refused call.
            assert_eq!(twin.set_reals(&references, &values), OK);
            assert!(component.is_still_in(phase) && twin.is_still_in(phase));
            assert_eq!(component.snapshot(), twin.snapshot());
        }
    }
}

#[test]
fn a_reference_given_twice_takes_the_last_value() {
    for standard in BOTH {
        let component = Component::in_phase(standard, PLANT, Phase::Step);
        assert_eq!(component.set_reals(&[1, 1], &[2.0, 3.0]), OK);
        assert_eq!(component.get("voltage"), 3.0);
    }
}
