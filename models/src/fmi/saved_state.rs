//! The state of an instance, in memory and as bytes that outlive the process.
//!
//! Both forms hold the same payload, written by `postcard`: where the instance stands in its life, then the model. What
//! belongs to the importer, the logger and the instance's name, is not part of it. A state thus fits every instance
//! of the same model, whatever the version of the standard.

use super::instance_state::InstanceState;
use super::state_format::{
    CHECKSUM, HEADER, LONGEST_SAVED_STATE, MARK, StateError, TOKEN, TokenName, VERSION,
};
use super::{Instance, Interface};
use crate::model::Description;

const CAPACITY: usize = LONGEST_SAVED_STATE - HEADER;

/// What a handle `fmi2FMUstate` or `fmi3FMUState` points to.
#[repr(C)]
pub struct SavedState {
    /// [`MARK`], gone once the state is freed.
    mark: [u8; 8],
    model: &'static Description,
    length: usize,
    payload: [u8; CAPACITY],
}

impl SavedState {
    /// A state that is yet to be saved.
    pub(super) fn new(model: &'static Description) -> Self {
        Self { mark: MARK, model, length: 0, payload: [0; CAPACITY] }
    }

    pub(super) fn is_alive(&self) -> bool {
        self.mark == MARK
    }

    /// The handle is about to be freed.
    pub(super) fn invalidate(&mut self) {
        self.mark = [0; 8];
        // Nobody may read the mark again, so the compiler would leave the line above out; an importer that uses the
        // handle all the same should find it gone.
        core::hint::black_box(&self.mark);
    }

    fn payload(&self) -> &[u8] {
        &self.payload[..self.length]
    }

    /// Bytes of the serialised state.
    pub fn size(&self) -> usize {
        HEADER + self.length
    }

    pub(super) fn serialise(&self, target: &mut [u8]) -> Result<(), StateError> {
        let (got, expected) = (target.len(), self.size());
        // An importer may give more room than is needed; what it does not use stays as it is.
        let target = target.get_mut(..expected).ok_or(StateError::Room { got, expected })?;
        let (header, payload) = target.split_at_mut(HEADER);
        payload.copy_from_slice(self.payload());
        header[..8].copy_from_slice(&MARK);
        header[8..12].copy_from_slice(&VERSION.to_le_bytes());
        header[12..16].copy_from_slice(&(self.length as u32).to_le_bytes());
        header[TOKEN].copy_from_slice(self.model.token().as_str().as_bytes());
        let checksum = checksum(header, payload);
        header[CHECKSUM].copy_from_slice(&checksum.to_le_bytes());
        Ok(())
    }

    /// A state of `model` from bytes. Only the frame is checked here, the contents by [`Instance::verify`].
    pub(super) fn deserialise(bytes: &[u8], model: &'static Description) -> Result<Self, StateError> {
        let got = bytes.len();
        if !(HEADER..=LONGEST_SAVED_STATE).contains(&got) {
            return Err(StateError::Length { got });
        }
        let (header, payload) = bytes.split_at(HEADER);
        let mark = array(header, 0);
        if mark != MARK {
            return Err(StateError::Mark { got: mark });
        }
        let version = u32::from_le_bytes(array(header, 8));
        if version != VERSION {
            return Err(StateError::Version { got: version });
        }
        let token = array(header, TOKEN.start);
        if token != model.token().as_str().as_bytes() {
            return Err(StateError::OtherModel { got: TokenName(token), expected: model.name });
        }
        let length = u32::from_le_bytes(array(header, 12)) as usize;
        if length != payload.len() {
            return Err(StateError::Payload { got, expected: length.saturating_add(HEADER) });
        }
        let found = u32::from_le_bytes(array(header, CHECKSUM.start));
        let expected = checksum(header, payload);
        if found != expected {
            return Err(StateError::Checksum { got: found, expected });
        }
        let mut state = Self::new(model);
        state.length = length;
        state.payload[..length].copy_from_slice(payload);
        Ok(state)
    }
}

impl SavedState {
    /// The state of the instance and the bytes of the model, for an instance of `model` that was made for `interface`.
    fn read(
        &self,
        model: &'static Description,
        interface: Interface,
    ) -> Result<(InstanceState, &[u8]), StateError> {
        if !core::ptr::eq(self.model, model) {
            let mut token = [0; TOKEN.end - TOKEN.start];
            token.copy_from_slice(self.model.token().as_str().as_bytes());
            return Err(StateError::OtherModel { got: TokenName(token), expected: model.name });
        }
        let (instance_state, model) = postcard::take_from_bytes::<InstanceState>(self.payload())
            .map_err(|_| StateError::InstanceState)?;
        instance_state.check(|phase| interface.reaches(phase))?;
        Ok((instance_state, model))
    }
}

/// CRC-32 of the header, without the place of the checksum itself, and of the payload: finds every damage to up to
/// 32 bits in a row, and any other but for one in 4e9.
fn checksum(header: &[u8], payload: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&header[..CHECKSUM.start]);
    hasher.update(payload);
    hasher.finalize()
}

fn array<const N: usize>(bytes: &[u8], start: usize) -> [u8; N] {
    core::array::from_fn(|index| bytes[start + index])
}

impl Instance {
    pub(super) fn save(&self, state: &mut SavedState) -> Result<(), StateError> {
        state.model = self.model.description();
        // Nothing to restore, should the rest fail.
        state.length = 0;
        let length =
            postcard::to_slice(&self.state, &mut state.payload).map_err(|_| StateError::InstanceState)?.len();
        state.length = length + self.model.save(&mut state.payload[length..])?;
        Ok(())
    }

    pub(super) fn restore(&mut self, state: &SavedState) -> Result<(), StateError> {
        let (instance_state, model) = state.read(self.model.description(), self.interface)?;
        self.model.restore(model, !instance_state.needs_initialisation)?;
        self.resume(instance_state);
        Ok(())
    }

    /// As [`Instance::restore`], from the state in which the instance was made.
    pub(super) fn restart(&mut self) -> Result<(), StateError> {
        let (instance_state, model) = self.start.read(self.model.description(), self.interface)?;
        self.model.restore(model, !instance_state.needs_initialisation)?;
        self.resume(instance_state);
        Ok(())
    }

    /// Whether [`Instance::restore`] would work.
    pub(super) fn verify(&self, state: &SavedState) -> Result<(), StateError> {
        let (instance_state, model) = state.read(self.model.description(), self.interface)?;
        Ok(self.model.verify(model, !instance_state.needs_initialisation)?)
    }
}
