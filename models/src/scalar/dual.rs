//! Derivatives without differences: numbers with a tangent.
//!
//! x + x' e with e^2 = 0 (Griewank and Walther, "Evaluating Derivatives", 2nd edition, chapter 3): a function of such
//! numbers is its value and its derivative along the tangents of what it is computed from.

use super::Scalar;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number and how fast it changes along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    pub value: f64,
    pub tangent: f64,
}

/// `tangent` times `factor`; what does not change does not do so times infinity either.
#[inline]
fn scaled(tangent: f64, factor: f64) -> f64 {
    if tangent == 0.0 { 0.0 } else { tangent * factor }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self { value, tangent: 0.0 }
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, tangent: self.tangent + other.tangent }
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, tangent: self.tangent - other.tangent }
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let tangent = scaled(self.tangent, other.value) + scaled(other.tangent, self.value);
        Self { value: self.value * other.value, tangent }
    }
}

impl Div for Dual {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let tangent = scaled(self.tangent, 1.0 / other.value) - scaled(other.tangent, value / other.value);
        Self { value, tangent }
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, tangent: -self.tangent }
    }
}

impl Scalar for Dual {
    fn if_at_most(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value <= bound.value { then } else { otherwise }
    }

    fn abs(self) -> Self {
        if self.value.is_sign_negative() { -self } else { self }
    }

    /// Constant but for its jumps.
    fn rint(self) -> Self {
        Self::from(libm::rint(self.value))
    }

    fn is_zero(self) -> bool {
        self.value == 0.0
    }

    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A function of all operations.
    fn rational<S: Scalar>(x: S, y: S) -> S {
        (x * y - y / x).abs() + (-x).max(y) * x.min(y) + (x + S::from(0.2)).rint() * y
    }

    proptest! {
        #[test]
        fn tangents_are_the_limits_of_differences(x in 0.3..2.0f64, y in -2.0..2.0f64, along in -1.0..1.0f64) {
            let h = 1e-5;
            // Away from kinks and jumps.
            prop_assume!((x * y - y / x).abs() > 1e-3 && (x + y).abs() > 1e-3 && (x - y).abs() > 1e-3);
            prop_assume!(((x + 0.2).fract() - 0.5).abs() > 1e-3);
            let at = |t: f64| rational(x + t, y + along * t);
            let result = rational(Dual { value: x, tangent: 1.0 }, Dual { value: y, tangent: along });
            prop_assert_eq!(result.value, at(0.0));
            let difference = (at(h) - at(-h)) / (2.0 * h);
            prop_assert!((result.tangent - difference).abs() < 1e-7 * (1.0 + difference.abs()),
                "{} {}", result.tangent, difference);
        }
    }

    #[test]
    fn what_does_not_move_has_no_tangent_even_at_infinity() {
        let (still, huge) = (Dual::from(3.0), Dual::from(1e200));
        assert_eq!((huge * huge * still).tangent, 0.0);
        assert_eq!((huge * huge / still).tangent, 0.0);
    }
}
