//! Bytes that are no state of this instance change nothing.

use core::ptr::null_mut;

use super::harness::{BOTH, Component, ERROR, FATAL, OK, Phase, Standard};
use super::saved_state::{Choice, configured, names, plan};

#[test]
fn what_is_no_state_is_recognised() {
    let component = Component::in_phase(Standard::Fmi3, super::harness::CONTROLLER, Phase::Step);
    let before = component.snapshot();
    let mut memory = [0u64; 1024];
    let elsewhere = memory.as_mut_ptr();
    // SAFETY: within the array.
    for mut state in [elsewhere.cast(), unsafe { elsewhere.cast::<u8>().add(1) }.cast()] {
        let said = "the handle is not that of a saved state";
        component.assert_refused(component.set_state(state), &[said]);
        component.assert_refused(component.get_state(&mut state), &[said]);
        component.assert_refused(component.free_state(&mut state), &[said]);
        component.assert_refused(component.state_size(state, &mut 0), &[said]);
    }
    assert_eq!((component.snapshot(), memory), (before, [0; 1024]));
}

#[test]
fn a_buffer_of_the_wrong_size_is_refused() {
    let component = Component::in_phase(Standard::Fmi2, super::harness::PLANT, Phase::Step);
    let bytes = component.saved_bytes();
    let mut state = null_mut();
    assert_eq!(component.get_state(&mut state), OK);
    let mut short = vec![9; bytes.len() - 1];
    let said = format!("{} bytes: expected {}, the size of this state", short.len(), bytes.len());
    component
        .assert_refused(component.serialise_state(state, &mut short), &["fmi2SerializeFMUstate: ", &said]);
    assert!(short.iter().all(|byte| *byte == 9));
    let mut long = vec![9; bytes.len() + 3];
    assert_eq!(component.serialise_state(state, &mut long), OK);
    assert_eq!((&long[..bytes.len()], &long[bytes.len()..]), (&bytes[..], &[9; 3][..]));
    assert_eq!(component.free_state(&mut state), OK);
}

/// Deserialising `bytes` is refused with a message that holds `said`, and changes nothing.
#[track_caller]
fn assert_no_state(component: &Component, bytes: &[u8], said: &[&str]) {
    let before = component.snapshot();
    component.assert_refused(component.restore_bytes(bytes), said);
    assert_eq!(component.snapshot(), before);
}

#[test]
fn damaged_bytes_are_refused() {
    for model in names() {
        let component = Component::in_phase(Standard::Fmi3, model, Phase::Step);
        let bytes = component.saved_bytes();
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert_no_state(&component, &flipped, &["fmi3DeserializeFMUState: ", "expected"]);
        }
        for length in 0..bytes.len() {
            assert_no_state(&component, &bytes[..length], &[&format!("{length} bytes: expected")]);
        }
        for excess in [1, 2, 100, 5000] {
            let longer = [&bytes[..], &vec![0; excess]].concat();
            assert_no_state(&component, &longer, &[&format!("{} bytes: expected", longer.len())]);
        }
        assert_eq!(component.restore_bytes(&bytes), OK);
    }
}

#[test]
fn foreign_bytes_are_refused_by_name() {
    for standard in BOTH {
        for model in names() {
            let component = Component::in_phase(standard, model, Phase::Step);
            for other in names().filter(|other| *other != model) {
                let foreign = Component::in_phase(standard, other, Phase::Step);
                let said = format!("a state of {other}: expected {model}");
                assert_no_state(&component, &foreign.saved_bytes(), &[&said]);
                // The same in memory.
                let mut state = null_mut();
                assert_eq!(foreign.get_state(&mut state), OK);
                component.assert_refused(component.set_state(state), &[&said]);
                assert_eq!(component.free_state(&mut state), OK, "any instance frees");
            }
            let mut bytes = component.saved_bytes();
            let version = bytes[8];
            bytes[8] = 77;
            assert_no_state(&component, &bytes, &[&format!("version 77 of the format: expected {version}")]);
            bytes[8] = version;
            bytes[20] ^= 1;
            assert_no_state(&component, &bytes, &["a state of another release", "expected "]);
            assert_no_state(&component, &[b'x'; 200], &["the bytes begin with", "the mark of a saved state"]);
        }
    }
}

/// The bytes with a checksum that fits, as only somebody who means to deceive makes them.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&bytes[..54]);
    hasher.update(&bytes[58..]);
    let checksum = hasher.finalize().to_le_bytes();
    bytes[54..58].copy_from_slice(&checksum);
    bytes
}

#[test]
fn contents_that_lie_do_no_harm() {
    let (mut accepted, mut refused) = (0, 0);
    for model in names() {
        let mut choice = Choice::new(5);
        for round in 0..40 {
            let (configuration, _) = plan(model, &mut choice);
            let source = configured(Standard::Fmi3, model, &configuration);
            if round > 0
                && (source.enter_initialization(0.0, None) != OK || source.exit_initialization() != OK)
            {
                continue;
            }
            (0..round).for_each(|k| {
                source.step(f64::from(k) * 1e-3, 1e-3);
            });
            let bytes = source.saved_bytes();
            assert_eq!(source.restore_bytes(&sealed(bytes.clone())), OK);
            for _ in 0..300 {
                let mut forged = bytes.clone();
                for _ in 0..1 + choice.below(3) {
                    let place = 58 + choice.below(bytes.len() as u32 - 58) as usize;
                    forged[place] = match choice.below(3) {
                        0 => 0xff,
                        1 => forged[place] ^ (1 << choice.below(8)),
                        _ => choice.below(256) as u8,
                    };
                }
                let component = Component::with_logging(Standard::Fmi3, model, false);
                let status = component.restore_bytes(&sealed(forged));
                if status == ERROR {
                    refused += 1;
                    continue;
                }
                assert_eq!(status, OK);
                accepted += 1;
                for reference in 0..component.description.variables.len() as u32 {
                    assert_ne!(component.get_reference(reference).0, FATAL);
                }
                // Before the first step a start time may be so far away that nothing can be read.
                let (_, now) = component.get_reference(component.reference("time"));
                for k in 0..3 {
                    assert_ne!(component.step(now + f64::from(k) * 1e-3, 1e-3), FATAL);
                }
                assert_ne!(component.enter_initialization(0.0, None), FATAL);
                assert_ne!(component.exit_initialization(), FATAL);
                component.saved_bytes();
            }
        }
    }
    println!("{accepted} forged states accepted, {refused} refused");
    assert!(accepted > 1000 && refused > 1000);
}
