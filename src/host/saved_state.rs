//! Saving the state of an instance and going back to it.

use std::ffi::c_void;

use super::error::{HostError, Result};
use super::instance::Instance;
use super::refusal::Subject;

/// The complete state of one instance, held by the FMU.
///
/// Give it back with [`Instance::free_state`]; one that is dropped instead stays allocated inside the FMU.
#[derive(Debug)]
#[must_use = "the state stays allocated inside the FMU until it is freed"]
pub struct SavedState {
    state: *mut c_void,
    owner: u64,
}

// SAFETY: the pointer is used through its instance only, which may move between threads itself.
unsafe impl Send for SavedState {}

impl Instance {
    /// Saves everything needed to go on from here later.
    ///
    /// # Errors
    /// [`HostError::MissingFunction`] if the library cannot, and [`HostError::Call`].
    pub fn save_state(&mut self) -> Result<SavedState> {
        self.usable()?;
        let answer = self.component.get_state();
        let state = self.explain(answer, Subject::none)?;
        self.may_go_back = true;
        Ok(SavedState { state, owner: self.identity })
    }

    /// Goes back to a saved state, which stays valid.
    ///
    /// # Errors
    /// [`HostError::ForeignState`] for a state of another instance, [`HostError::MissingFunction`],
    /// and [`HostError::Call`].
    pub fn restore_state(&mut self, saved: &SavedState) -> Result<()> {
        self.usable()?;
        self.owns(saved)?;
        let answer = self.component.set_state(saved.state);
        self.explain(answer, Subject::none)
    }

    /// Frees a saved state.
    ///
    /// # Errors
    /// As [`Instance::restore_state`].
    pub fn free_state(&mut self, saved: SavedState) -> Result<()> {
        self.usable()?;
        self.owns(&saved)?;
        let answer = self.component.free_state(saved.state);
        self.explain(answer, Subject::none)
    }

    /// A saved state as bytes, which outlive the instance and the process.
    ///
    /// # Errors
    /// As [`Instance::restore_state`].
    pub fn serialise_state(&mut self, saved: &SavedState) -> Result<Vec<u8>> {
        self.usable()?;
        self.owns(saved)?;
        let answer = self.component.serialise_state(saved.state);
        self.explain(answer, Subject::none)
    }

    /// A state from bytes that an instance of the same model has serialised.
    ///
    /// # Errors
    /// As [`Instance::save_state`].
    pub fn deserialise_state(&mut self, bytes: &[u8]) -> Result<SavedState> {
        self.usable()?;
        let answer = self.component.deserialise_state(bytes);
        let state = self.explain(answer, Subject::none)?;
        self.may_go_back = true;
        Ok(SavedState { state, owner: self.identity })
    }

    fn owns(&self, saved: &SavedState) -> Result<()> {
        if saved.owner == self.identity {
            return Ok(());
        }
        Err(HostError::ForeignState { instance: self.name().to_owned() })
    }
}
