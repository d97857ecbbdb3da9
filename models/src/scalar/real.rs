//! What equations ask of a number, and that of the processor.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A real number that equations can be computed with.
///
/// Comparisons go through [`Scalar::if_at_most`], so that a number that follows dependencies sees both sides.
pub trait Scalar:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// `then` if this number is at most `bound`, else, and if either is not a number, `otherwise`.
    fn if_at_most(self, bound: Self, then: Self, otherwise: Self) -> Self;

    fn abs(self) -> Self;

    /// Nearest integer, the even one of two.
    fn rint(self) -> Self;

    /// Whether the number is certainly 0.
    fn is_zero(self) -> bool;

    fn is_finite(self) -> bool;

    /// The larger one; this one if they are equal.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.if_at_most(self, self, other)
    }

    /// The smaller one; this one if they are equal.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.if_at_most(other, self, other)
    }

    /// This number limited to `minimum` .. `maximum`.
    #[inline(always)]
    fn clamp(self, minimum: Self, maximum: Self) -> Self {
        self.max(minimum).min(maximum)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn if_at_most(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self <= bound { then } else { otherwise }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn rint(self) -> Self {
        libm::rint(self)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.is_finite()
    }
}
