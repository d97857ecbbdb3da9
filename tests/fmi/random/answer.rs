//! What a call returns.

/// Status and results; those that a call does not have stay as they are by default.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    pub status: i32,
    /// Real results, or the integral ones as reals.
    pub values: Vec<f64>,
    /// Activation states of clocks.
    pub active: Vec<u8>,
    /// Where a step has ended.
    pub reached: f64,
    pub is_event: bool,
    pub is_early: bool,
    /// Another event iteration is wanted.
    pub is_unfinished: bool,
    /// Bytes of a saved state.
    pub bytes: Vec<u8>,
}

impl Answer {
    pub fn of(status: i32) -> Self {
        Self { status, ..Self::default() }
    }

    pub fn with_values(status: i32, values: Vec<f64>) -> Self {
        Self { status, values, ..Self::default() }
    }
}

/// The pointer to the elements, or null.
pub fn pointer<T>(elements: &[T], is_null: bool) -> *const T {
    if is_null { core::ptr::null() } else { elements.as_ptr() }
}

/// As [`pointer`], to be written.
pub fn pointer_mut<T>(elements: &mut [T], is_null: bool) -> *mut T {
    if is_null { core::ptr::null_mut() } else { elements.as_mut_ptr() }
}
