//! Whether a number lies in a range, by its bits: no comparison of numbers, which a host may let trap.

/// The finite numbers of a range, by their bits.
#[derive(Clone, Copy, Debug)]
pub struct AcceptedBits {
    /// [`order`] of the smallest number and of the largest.
    smallest: i64,
    largest: i64,
}

impl AcceptedBits {
    /// None.
    pub const NONE: Self = Self { smallest: 1, largest: 0 };

    /// Those of a range, of whose bounds none is a negative zero.
    pub const fn of((minimum, maximum): (f64, f64)) -> Self {
        let (minimum, maximum) = (order(minimum.max(f64::MIN)), order(maximum.min(f64::MAX)));
        // A negative zero comes right before the other one, and is as good.
        Self { smallest: if minimum == 0 { -1 } else { minimum }, largest: maximum }
    }

    #[inline]
    pub const fn contain(self, value: f64) -> bool {
        let place = order(value);
        self.smallest <= place && place <= self.largest
    }
}

/// Integers in the order of the numbers, with the infinities and what is not a number beyond the finite ones; a negative zero
/// comes before the other one.
#[inline]
const fn order(value: f64) -> i64 {
    let bits = value.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}
