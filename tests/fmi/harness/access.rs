//! Variables by name, with the data type that the variable's kind has in each standard.

use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::variable::{Kind, Variable};

use super::{Component, DISCARD, ERROR, OK, Phase, Standard};

impl Component {
    pub fn reference(&self, name: &str) -> u32 {
        self.description.find(name).unwrap_or_else(|| panic!("no variable {name}")).0 as u32
    }

    pub fn variable(&self, reference: u32) -> &'static Variable {
        &self.description.variables[reference as usize]
    }

    /// Sets a variable by name with the function of its type.
    pub fn set(&self, name: &str, value: f64) -> i32 {
        self.set_reference(self.reference(name), value)
    }

    pub fn set_reference(&self, r: u32, value: f64) -> i32 {
        // SAFETY: a live handle, one reference, one value.
        unsafe {
            match (self.standard, self.variable(r).kind) {
                (_, Kind::Real(_)) => self.set_reals(&[r], &[value]),
                (Standard::Fmi2, Kind::Integer | Kind::Enumeration(_)) => {
                    fmi2SetInteger(self.handle, &r, 1, &(value as i32))
                }
                (Standard::Fmi2, Kind::Boolean) => fmi2SetBoolean(self.handle, &r, 1, &(value as i32)),
                (Standard::Fmi3, Kind::Integer) => fmi3SetInt32(self.handle, &r, 1, &(value as i32), 1),
                (Standard::Fmi3, Kind::Enumeration(_)) => {
                    fmi3SetInt64(self.handle, &r, 1, &(value as i64), 1)
                }
                (Standard::Fmi3, Kind::Boolean) => fmi3SetBoolean(self.handle, &r, 1, &(value as u8), 1),
            }
        }
    }

    /// The value of a variable by name.
    #[track_caller]
    pub fn get(&self, name: &str) -> f64 {
        let (status, value) = self.get_reference(self.reference(name));
        assert_eq!(status, OK, "{name}: {:?}", self.recorder.messages());
        value
    }

    pub fn get_reference(&self, r: u32) -> (i32, f64) {
        let (mut int32, mut int64, mut byte, mut real) = (-77, -77, 77, [-77.0]);
        // SAFETY: a live handle, one reference, room for one value.
        unsafe {
            match (self.standard, self.variable(r).kind) {
                (_, Kind::Real(_)) => (self.get_reals(&[r], &mut real), real[0]),
                (Standard::Fmi2, Kind::Integer | Kind::Enumeration(_)) => {
                    (fmi2GetInteger(self.handle, &r, 1, &mut int32), f64::from(int32))
                }
                (Standard::Fmi2, Kind::Boolean) => {
                    (fmi2GetBoolean(self.handle, &r, 1, &mut int32), f64::from(int32))
                }
                (Standard::Fmi3, Kind::Integer) => {
                    (fmi3GetInt32(self.handle, &r, 1, &mut int32, 1), f64::from(int32))
                }
                (Standard::Fmi3, Kind::Enumeration(_)) => {
                    (fmi3GetInt64(self.handle, &r, 1, &mut int64, 1), int64 as f64)
                }
                (Standard::Fmi3, Kind::Boolean) => {
                    (fmi3GetBoolean(self.handle, &r, 1, &mut byte, 1), f64::from(byte))
                }
            }
        }
    }

    /// Sets several reals in one call.
    #[inline]
    pub fn set_reals(&self, references: &[u32], values: &[f64]) -> i32 {
        assert_eq!(references.len(), values.len());
        let (r, n, v) = (references.as_ptr(), references.len(), values.as_ptr());
        // SAFETY: a live handle, as many values as references.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SetReal(self.handle, r, n, v),
                Standard::Fmi3 => fmi3SetFloat64(self.handle, r, n, v, n),
            }
        }
    }

    /// Gets several reals in one call.
    #[inline]
    pub fn get_reals(&self, references: &[u32], values: &mut [f64]) -> i32 {
        assert_eq!(references.len(), values.len());
        let (r, n, v) = (references.as_ptr(), references.len(), values.as_mut_ptr());
        // SAFETY: a live handle, as much room as references.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2GetReal(self.handle, r, n, v),
                Standard::Fmi3 => fmi3GetFloat64(self.handle, r, n, v, n),
            }
        }
    }

    /// All values as bits, empty where the standard does not let them be read or one of them cannot be
    /// computed.
    pub fn snapshot(&self) -> Vec<u64> {
        let mut values = Vec::new();
        for reference in 0..self.description.variables.len() as u32 {
            let (status, value) = self.get_reference(reference);
            if status == ERROR || status == DISCARD {
                self.recorder.take();
                return Vec::new();
            }
            assert_eq!(status, OK);
            values.push(value.to_bits());
        }
        values
    }

    /// Whether the instance is where [`Component::in_phase`] left it: the call that leaves the phase succeeds.
    pub fn is_still_in(&self, phase: Phase) -> bool {
        let status = match phase {
            Phase::Instantiated => self.enter_initialization(0.0, None),
            Phase::Initialization => self.exit_initialization(),
            Phase::Step => self.step(Self::STEPPED_TO, 1e-3),
            // Values can still be read, and nothing can be set.
            Phase::Terminated => {
                let readable = self.get_reference(0).0 == OK;
                return readable && self.set_reference(1, 0.0) == ERROR;
            }
        };
        status == OK
    }
}
