//! Saving and restoring through either standard.

use core::ffi::c_void;
use core::ptr::null_mut;

use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;

use super::{Component, OK, Standard};

/// Handle of a saved state.
pub type State = *mut c_void;

impl Component {
    pub fn get_state(&self, state: &mut State) -> i32 {
        // SAFETY: a live handle; the tests pass null or living states.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2GetFMUstate(self.handle, state),
                Standard::Fmi3 => fmi3GetFMUState(self.handle, state),
            }
        }
    }

    pub fn set_state(&self, state: State) -> i32 {
        // SAFETY: as above.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SetFMUstate(self.handle, state),
                Standard::Fmi3 => fmi3SetFMUState(self.handle, state),
            }
        }
    }

    pub fn free_state(&self, state: &mut State) -> i32 {
        // SAFETY: as above.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2FreeFMUstate(self.handle, state),
                Standard::Fmi3 => fmi3FreeFMUState(self.handle, state),
            }
        }
    }

    pub fn state_size(&self, state: State, size: &mut usize) -> i32 {
        // SAFETY: as above.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SerializedFMUstateSize(self.handle, state, size),
                Standard::Fmi3 => fmi3SerializedFMUStateSize(self.handle, state, size),
            }
        }
    }

    pub fn serialise_state(&self, state: State, bytes: &mut [u8]) -> i32 {
        let (pointer, size) = (bytes.as_mut_ptr(), bytes.len());
        // SAFETY: as above, and room for the bytes.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SerializeFMUstate(self.handle, state, pointer.cast(), size),
                Standard::Fmi3 => fmi3SerializeFMUState(self.handle, state, pointer, size),
            }
        }
    }

    pub fn deserialise_state(&self, bytes: &[u8], state: &mut State) -> i32 {
        let (pointer, size) = (bytes.as_ptr(), bytes.len());
        // SAFETY: as above.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2DeSerializeFMUstate(self.handle, pointer.cast(), size, state),
                Standard::Fmi3 => fmi3DeserializeFMUState(self.handle, pointer, size, state),
            }
        }
    }

    /// The present state, serialised.
    pub fn saved_bytes(&self) -> Vec<u8> {
        let (mut state, mut size) = (null_mut(), 0);
        assert_eq!(self.get_state(&mut state), OK, "{:?}", self.recorder.messages());
        assert_eq!(self.state_size(state, &mut size), OK);
        let mut bytes = vec![0; size];
        assert_eq!(self.serialise_state(state, &mut bytes), OK);
        assert_eq!(self.free_state(&mut state), OK);
        bytes
    }

    /// Goes on from a serialised state, if it is accepted.
    pub fn restore_bytes(&self, bytes: &[u8]) -> i32 {
        let mut state = null_mut();
        let status = self.deserialise_state(bytes, &mut state);
        if status != OK {
            assert!(state.is_null());
            return status;
        }
        let status = self.set_state(state);
        assert_eq!(self.free_state(&mut state), OK);
        assert!(state.is_null());
        status
    }
}
