//! Wrong types, unknown references and arrays that are not there.

use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::variable::Kind;

use super::harness::clocked::{Choices, sampled_models};
use super::harness::{Component, ERROR, OK, PLANT, Phase, Standard, all};
use super::refused_values::OPEN;

/// Getter and setter of one data type with one reference, and whether it carries a kind.
type Accessors = (&'static str, fn(&Kind) -> bool, fn(&Component, u32) -> [i32; 2]);

macro_rules! accessors {
    (fmi2 $type:literal, $carries:expr, $get:ident, $set:ident, $value:expr) => {
        ($type, $carries, |component, reference| {
            let mut value = $value;
            // SAFETY: one reference, one value.
            unsafe {
                let status = $get(component.handle, &reference, 1, &mut value);
                [status, $set(component.handle, &reference, 1, &value)]
            }
        })
    };
    (fmi3 $type:literal, $carries:expr, $get:ident, $set:ident, $value:expr) => {
        ($type, $carries, |component, reference| {
            let mut value = $value;
            // SAFETY: one reference, one value.
            unsafe {
                let status = $get(component.handle, &reference, 1, &mut value, 1);
                [status, $set(component.handle, &reference, 1, &value, 1)]
            }
        })
    };
}

fn accessors(standard: Standard) -> Vec<Accessors> {
    let is_real = |kind: &Kind| matches!(kind, Kind::Real(_));
    let is_boolean = |kind: &Kind| matches!(kind, Kind::Boolean);
    match standard {
        Standard::Fmi2 => vec![
            accessors!(fmi2 "a Real", is_real, fmi2GetReal, fmi2SetReal, 0.0),
            accessors!(fmi2 "an Integer or Enumeration",
                |kind| matches!(kind, Kind::Integer | Kind::Enumeration(_)), fmi2GetInteger, fmi2SetInteger, 1),
            accessors!(fmi2 "a Boolean", is_boolean, fmi2GetBoolean, fmi2SetBoolean, 1),
            accessors!(fmi2 "a String", |_| false, fmi2GetString, fmi2SetString, c"x".as_ptr()),
        ],
        Standard::Fmi3 => vec![
            accessors!(fmi3 "a Float64", is_real, fmi3GetFloat64, fmi3SetFloat64, 0.0),
            accessors!(fmi3 "an Int32", |kind| matches!(kind, Kind::Integer), fmi3GetInt32, fmi3SetInt32, 1),
            accessors!(fmi3 "an Int64 or Enumeration", |kind| matches!(kind, Kind::Enumeration(_)),
                fmi3GetInt64, fmi3SetInt64, 1),
            accessors!(fmi3 "a Boolean", is_boolean, fmi3GetBoolean, fmi3SetBoolean, 1),
            accessors!(fmi3 "a Float32", |_| false, fmi3GetFloat32, fmi3SetFloat32, 0.0),
            accessors!(fmi3 "an Int8", |_| false, fmi3GetInt8, fmi3SetInt8, 1),
            accessors!(fmi3 "a UInt8", |_| false, fmi3GetUInt8, fmi3SetUInt8, 1),
            accessors!(fmi3 "an Int16", |_| false, fmi3GetInt16, fmi3SetInt16, 1),
            accessors!(fmi3 "a UInt16", |_| false, fmi3GetUInt16, fmi3SetUInt16, 1),
            accessors!(fmi3 "a UInt32", |_| false, fmi3GetUInt32, fmi3SetUInt32, 1),
            accessors!(fmi3 "a UInt64", |_| false, fmi3GetUInt64, fmi3SetUInt64, 1),
            accessors!(fmi3 "a String", |_| false, fmi3GetString, fmi3SetString, c"x".as_ptr()),
            (
                "a Binary",
                |_| false,
                |component, reference| {
                    let (mut size, mut value) = (1, c"x".as_ptr().cast::<u8>());
                    // SAFETY: one reference, one value, one size.
                    unsafe {
                        let status = fmi3GetBinary(component.handle, &reference, 1, &mut size, &mut value, 1);
                        [status, fmi3SetBinary(component.handle, &reference, 1, &size, &value, 1)]
                    }
                },
            ),
        ],
    }
}

#[test]
fn wrong_types_are_named() {
    for (standard, model) in all() {
        for phase in OPEN {
            let component = Component::in_phase(standard, model, phase);
            let before = component.snapshot();
            for (reference, variable) in (0..).zip(component.description.variables) {
                let mut carriers = 0;
                for (name, carries, call) in accessors(standard) {
                    if carries(&variable.kind) {
                        carriers += 1;
                        continue;
                    }
                    assert_eq!(call(&component, reference), [ERROR; 2], "{} as {name}", variable.name);
                    let messages = component.recorder.take();
                    assert_eq!(messages.len(), 2);
                    for message in messages {
                        let said = format!("{} (value reference {reference}) is ", variable.name);
                        let complete =
                            message.text.contains(&said) && message.text.ends_with(&format!("not {name}"));
                        assert!(complete, "{}", message.text);
                    }
                }
                assert_eq!(carriers, 1, "{}", variable.name);
            }
            assert_eq!(component.snapshot(), before);
        }
    }
}

#[test]
fn unknown_references_are_answered_with_the_largest() {
    let plain = all().map(|(standard, model)| (Component::in_phase(standard, model, Phase::Step), 0));
    // An importer that has read of the clocks is told of them, too.
    let clocked = sampled_models().map(|model| {
        let component = Component::co_simulation(model, Choices::default());
        component.initialise(0.0);
        component.recorder.clear();
        let clocks = component.description.clocks().count();
        (component, clocks)
    });
    for (component, clocks) in plain.chain(clocked) {
        let standard = component.standard;
        let count = (component.description.variables.len() + clocks) as u32;
        for (_, _, call) in accessors(standard) {
            for unknown in [count, count + 1, u32::MAX] {
                assert_eq!(call(&component, unknown), [ERROR; 2]);
                for message in component.recorder.take() {
                    let said = format!("value reference {unknown} is unknown: expected 0 to {}", count - 1);
                    assert!(message.text.contains(&said), "{}", message.text);
                }
            }
        }
        // One bad reference among good ones: nothing is written to the caller's array.
        let mut values = [-1.0, -2.0, -3.0];
        let status = component.get_reals(&[0, 1, count], &mut values);
        component.assert_refused(status, &["is unknown"]);
        assert_eq!(values, [-1.0, -2.0, -3.0]);
    }
}

#[test]
fn null_arrays_and_wrong_counts_are_named() {
    let fmi2 = Component::in_phase(Standard::Fmi2, PLANT, Phase::Step);
    let fmi3 = Component::in_phase(Standard::Fmi3, PLANT, Phase::Step);
    let (two, three) = (fmi2.handle, fmi3.handle);
    let (voltage, mut value) = (1, [5.0, 5.0]);
    let write = value.as_mut_ptr();
    // SAFETY: null arrays and lengths that do not fit are what is tested; nothing is read beyond one element.
    unsafe {
        fmi2.assert_refused(fmi2SetReal(two, null(), 1, write), &["argument vr is a null pointer"]);
        fmi2.assert_refused(fmi2SetReal(two, &voltage, 1, null()), &["argument value is a null pointer"]);
        fmi2.assert_refused(fmi2GetReal(two, null(), 1, write), &["argument vr is a null pointer"]);
        fmi2.assert_refused(fmi2GetReal(two, &voltage, 1, null_mut()), &["argument value is a null pointer"]);
        let said = &["argument valueReferences is a null pointer"];
        fmi3.assert_refused(fmi3SetFloat64(three, null(), 1, write, 1), said);
        fmi3.assert_refused(fmi3GetFloat64(three, null(), 1, write, 1), said);
        let said = &["argument values is a null pointer"];
        fmi3.assert_refused(fmi3SetFloat64(three, &voltage, 1, null(), 1), said);
        fmi3.assert_refused(fmi3GetFloat64(three, &voltage, 1, null_mut(), 1), said);
        for wrong in [0, 2, usize::MAX] {
            let said = format!("nValues = {wrong}: expected 1, one value per value reference");
            fmi3.assert_refused(fmi3SetFloat64(three, &voltage, 1, write, wrong), &["fmi3SetFloat64", &said]);
            fmi3.assert_refused(fmi3GetFloat64(three, &voltage, 1, write, wrong), &["fmi3GetFloat64", &said]);
            fmi3.assert_refused(fmi3GetInt8(three, &voltage, 1, null_mut(), wrong), &["fmi3GetInt8", &said]);
            let status = fmi3GetBinary(three, &voltage, 1, null_mut(), null_mut(), wrong);
            fmi3.assert_refused(status, &["fmi3GetBinary", &said]);
        }
        assert_eq!(fmi2SetReal(two, null(), 0, null()), OK);
        assert_eq!(fmi3SetFloat64(three, null(), 0, null(), 0), OK);
    }
    assert_eq!((fmi2.get("voltage"), fmi3.get("voltage")), (4e-3, 4e-3));
}
