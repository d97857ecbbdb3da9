//! Every function in every phase that an importer can reach, against the standards' own tables.

use core::ffi::c_void;

use maglev_fmu::model::variable::{Causality, Kind};

use super::harness::{Component, DISCARD, ERROR, OK, PHASES, Standard, all};
use super::{allowed_calls_fmi2, allowed_calls_fmi3};

/// What a call does where it is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    Works,
    /// An optional function: Error, with the capability that is missing.
    NotOffered,
    /// Error for this reason, since the table has no argument that would do.
    Refuses(&'static str),
    /// Works for the plants; what moves at ticks only does not offer it.
    PlantsOnly,
    /// FMI 2.0: "If a status is required which cannot be retrieved by the slave it returns fmi2Discard."
    Discards,
}

/// A function of a standard.
pub struct Row {
    pub name: &'static str,
    /// One character per phase: `x` allowed, `.` forbidden, `-` no function of co-simulation at all.
    pub allowed: &'static str,
    pub outcome: Outcome,
    pub call: unsafe fn(*mut c_void) -> i32,
}

fn table(standard: Standard) -> Vec<Row> {
    match standard {
        Standard::Fmi2 => allowed_calls_fmi2::table(),
        Standard::Fmi3 => allowed_calls_fmi3::table(),
    }
}

#[test]
fn calls_are_refused_exactly_where_the_standards_forbid_them() {
    let mut refused = 0;
    for (standard, model) in all() {
        for row in table(standard) {
            for (phase, mark) in PHASES.into_iter().zip(row.allowed.chars()) {
                let component = Component::in_phase(standard, model, phase);
                let before = component.snapshot();
                // SAFETY: a live handle, valid arguments.
                let status = unsafe { (row.call)(component.handle) };
                let messages = component.recorder.take();
                let context = format!("{model}: {} in {}: {messages:?}", row.name, phase.name());
                let text = messages.last().map_or("", |message| &message.text);
                match (mark, row.outcome) {
                    ('x', Outcome::PlantsOnly) if component.description.offers_model_exchange() => {
                        assert_eq!(status, OK, "{context}");
                    }
                    ('x', Outcome::Works) => assert_eq!(status, OK, "{context}"),
                    ('x', Outcome::Discards) => assert_eq!(status, DISCARD, "{context}"),
                    ('x', Outcome::NotOffered | Outcome::PlantsOnly) => {
                        assert_eq!(status, ERROR, "{context}");
                        assert!(text.contains("not offered"), "{context}");
                    }
                    ('x', Outcome::Refuses(why)) => {
                        assert_eq!(status, ERROR, "{context}");
                        assert!(text.contains(why), "{context}");
                    }
                    ('.', _) => {
                        assert_eq!(status, ERROR, "{context}");
                        assert!(text.contains(&format!("phase \"{}\"", phase.name())), "{context}");
                    }
                    ('-', _) => {
                        assert_eq!(status, ERROR, "{context}");
                        assert!(text.contains("not "), "{context}");
                    }
                    _ => panic!("{context}"),
                }
                if status != OK {
                    refused += 1;
                    assert_eq!(messages.len(), 1, "{context}");
                    assert_eq!(messages[0].status, status, "{context}");
                    assert!(text.starts_with(&format!("{}: ", row.name)), "{context}");
                    assert_eq!(component.snapshot(), before, "{context}");
                    assert!(component.is_still_in(phase), "{context}");
                }
            }
        }
    }
    println!("{refused} refusals");
    // 3 functions are not asked here, since they need no instance or end it; see the tests of
    // instantiation.
    assert_eq!((table(Standard::Fmi2).len(), table(Standard::Fmi3).len()), (44 - 4, 75 - 5));
}

#[test]
fn every_function_refuses_a_null_handle() {
    for standard in [Standard::Fmi2, Standard::Fmi3] {
        for row in table(standard) {
            // SAFETY: null is checked.
            assert_eq!(unsafe { (row.call)(core::ptr::null_mut()) }, ERROR, "{}", row.name);
        }
    }
}

#[test]
fn a_reset_instance_repeats_its_life_bit_for_bit() {
    for (standard, model) in all() {
        let fresh = Component::in_phase(standard, model, PHASES[3]);
        let first = |causality: Causality| {
            let mut rows = (0..).zip(fresh.description.variables);
            rows.find(|(_, row)| row.causality == causality && matches!(row.kind, Kind::Real(_))).unwrap()
        };
        let ((input, _), (parameter, row)) = (first(Causality::Input), first(Causality::Parameter));
        let other = if row.start == 0.0 { 1e-3 } else { 0.9 * row.start };
        for phase in PHASES {
            let used = Component::in_phase(standard, model, phase);
            // What was set is forgotten, too.
            used.set_reference(parameter, other);
            assert_eq!(used.reset(), OK);
            used.initialise(0.0);
            for k in 0..5 {
                assert_eq!(used.set_reference(input, 1e-3 * f64::from(k)), OK);
                assert_eq!(used.step(f64::from(k) * 1e-3, 1e-3), OK);
            }
            assert_eq!(used.snapshot(), fresh.snapshot(), "{standard:?} {model} {phase:?}");
        }
    }
}
