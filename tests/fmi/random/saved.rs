//! Saved states: in memory, as bytes, and as bytes that somebody has tampered with.

use core::ffi::c_void;
use core::ptr::null_mut;

use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;

use super::super::harness::Standard;
use super::answer::Answer;
use super::arguments::Arguments;
use super::call::{Call, Damage};
use super::environment::in_host;
use super::model::Model;
use super::oracle::Verdict;
use super::session::Session;

/// `fmi2FMUstate` or `fmi3FMUState`.
pub type Handle = *mut c_void;

/// Bytes of a saved state, and where they come from.
#[derive(Clone)]
pub struct Kept {
    pub bytes: Vec<u8>,
    pub package: &'static str,
    pub name: &'static str,
    /// What the importer knew; nothing of states of other instances.
    pub model: Option<Model>,
}

/// Places of checksum and contents, which an attacker knows, too.
const CHECKSUM: usize = 54;
const CONTENTS: usize = 58;

impl Session {
    pub fn send_about_states(&self, call: &Call) -> Answer {
        let handle =
            |slot: usize| self.slots.borrow()[slot].as_ref().map_or(null_mut(), |(handle, _)| *handle);
        match call {
            Call::Save { slot } => {
                let mut state = handle(*slot);
                let status = self.get_state(&mut state);
                self.keep(*slot, state, status);
                Answer::of(status)
            }
            Call::Restore { slot } => Answer::of(self.set_state(handle(*slot))),
            Call::Free { slot } => {
                let mut state = handle(*slot);
                let status = self.free_state(&mut state);
                if status == 0 {
                    assert!(state.is_null());
                    self.slots.borrow_mut()[*slot] = None;
                }
                Answer::of(status)
            }
            Call::Size { slot } => {
                let mut size = 0;
                Answer::with_values(self.size(handle(*slot), &mut size), vec![size as f64])
            }
            Call::Serialise { slot, shortage } => {
                let (state, mut size) = (handle(*slot), 0);
                self.size(state, &mut size);
                let mut bytes = vec![0; size.saturating_sub(*shortage)];
                self.log.clear();
                Answer { status: self.serialise(state, &mut bytes), bytes, ..Answer::default() }
            }
            Call::Deserialise { slot, source, damage } => {
                let bytes = tampered(&self.kept.borrow()[*source].bytes, *damage);
                let mut state = handle(*slot);
                let status = self.deserialise(&bytes, &mut state);
                self.keep(*slot, state, status);
                Answer::of(status)
            }
            _ => unreachable!("{call:?}"),
        }
    }

    /// A new handle, whose model follows with [`Session::follow_states`].
    fn keep(&self, slot: usize, state: Handle, status: i32) {
        let mut slots = self.slots.borrow_mut();
        match &mut slots[slot] {
            Some((handle, _)) => assert_eq!(*handle, state, "memory is used again"),
            empty if status == 0 => *empty = Some((state, self.model.borrow().clone())),
            None => assert!(state.is_null(), "refused, and yet a handle"),
        }
    }

    pub fn follow_states(&self, call: &Call, answer: &Answer, model: &mut Model) {
        let mut slots = self.slots.borrow_mut();
        match call {
            Call::Save { slot } => {
                if let Some((_, saved)) = &mut slots[*slot] {
                    *saved = model.clone();
                }
            }
            Call::Restore { slot } => {
                if let Some((_, saved)) = &slots[*slot] {
                    model.restore(saved);
                }
            }
            Call::Serialise { slot, .. } => {
                let saved = slots[*slot].as_ref().map(|(_, saved)| saved.clone());
                let description = self.scenario.description;
                let (package, name) = (description.package.as_str(), description.name.as_str());
                let mut kept = self.kept.borrow_mut();
                if kept.len() < 12 {
                    kept.push(Kept { bytes: answer.bytes.clone(), package, name, model: saved });
                }
            }
            Call::Deserialise { slot, source, damage } => {
                if let Some((_, saved)) = &mut slots[*slot] {
                    let known = self.kept.borrow()[*source].model.clone();
                    *saved = match known {
                        Some(known) if *damage == Damage::None => known,
                        // Whatever it says.
                        _ => Model { is_known: false, ..Model::new(f64::NAN) },
                    };
                }
            }
            _ => {}
        }
    }

    /// What the bytes tell about a call that the arguments alone do not.
    pub fn refine(&self, call: &Call, verdict: Verdict) -> Verdict {
        let Call::Deserialise { source, damage, .. } = call else { return verdict };
        let kept = self.kept.borrow();
        let Kept { bytes, package, name, model } = &kept[*source];
        let description = self.scenario.description;
        let is_whole = match damage {
            Damage::Cut { length } => *length >= bytes.len(),
            Damage::Flip { .. } | Damage::Forge { .. } => false,
            Damage::None => true,
        };
        let is_of_this_model = (*name, *package) == (description.name.as_str(), description.package.as_str());
        let arguments = match verdict.arguments {
            Arguments::Wrong if !is_whole => Arguments::Wrong,
            _ if *name != description.name => Arguments::Wrong,
            // The same token in both standards, but not of every package.
            _ if !is_of_this_model => Arguments::Open,
            _ if !is_whole || model.as_ref().is_none_or(|model| !model.is_known) => Arguments::Open,
            _ => Arguments::Good,
        };
        Verdict { arguments, ..verdict }
    }

    pub fn free_states(&self) {
        for (handle, _) in self.slots.borrow_mut().iter_mut().filter_map(Option::take) {
            assert_eq!(self.free_state(&mut { handle }), 0);
        }
        assert_eq!(self.free_state(&mut self.scratch.replace(null_mut())), 0);
    }
}

/// The functions of either standard.
impl Session {
    pub fn is_fmi2(&self) -> bool {
        self.scenario.description.standard == Standard::Fmi2
    }

    pub fn get_state(&self, state: &mut Handle) -> i32 {
        // SAFETY: a live handle; null or a living state, here and below.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2GetFMUstate(self.handle, state))
            } else {
                in_host(|| fmi3GetFMUState(self.handle, state))
            }
        }
    }

    pub fn set_state(&self, state: Handle) -> i32 {
        // SAFETY: as above.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2SetFMUstate(self.handle, state))
            } else {
                in_host(|| fmi3SetFMUState(self.handle, state))
            }
        }
    }

    pub fn free_state(&self, state: &mut Handle) -> i32 {
        // SAFETY: as above.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2FreeFMUstate(self.handle, state))
            } else {
                in_host(|| fmi3FreeFMUState(self.handle, state))
            }
        }
    }

    pub fn size(&self, state: Handle, size: &mut usize) -> i32 {
        // SAFETY: as above.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2SerializedFMUstateSize(self.handle, state, size))
            } else {
                in_host(|| fmi3SerializedFMUStateSize(self.handle, state, size))
            }
        }
    }

    pub fn serialise(&self, state: Handle, bytes: &mut [u8]) -> i32 {
        let (target, size) = (bytes.as_mut_ptr(), bytes.len());
        // SAFETY: as above, room for the bytes.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2SerializeFMUstate(self.handle, state, target.cast(), size))
            } else {
                in_host(|| fmi3SerializeFMUState(self.handle, state, target, size))
            }
        }
    }

    pub fn deserialise(&self, bytes: &[u8], state: &mut Handle) -> i32 {
        let (source, size) = (bytes.as_ptr(), bytes.len());
        // SAFETY: as above.
        unsafe {
            if self.is_fmi2() {
                in_host(|| fmi2DeSerializeFMUstate(self.handle, source.cast(), size, state))
            } else {
                in_host(|| fmi3DeserializeFMUState(self.handle, source, size, state))
            }
        }
    }
}

fn tampered(bytes: &[u8], damage: Damage) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    match damage {
        Damage::None => {}
        Damage::Flip { bit } => {
            let bit = bit % (8 * bytes.len());
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        Damage::Cut { length } => bytes.truncate(length),
        Damage::Forge { place, value } => {
            let place = CONTENTS + place % (bytes.len() - CONTENTS);
            bytes[place] = value;
            let mut checksum = crc32fast::Hasher::new();
            checksum.update(&bytes[..CHECKSUM]);
            checksum.update(&bytes[CONTENTS..]);
            bytes[CHECKSUM..CONTENTS].copy_from_slice(&checksum.finalize().to_le_bytes());
        }
    }
    bytes
}
