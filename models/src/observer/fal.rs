//! Han's function fal, the nonlinear gain of an extended state observer (J. Han, From PID to active disturbance rejection
//! control, IEEE Trans. Ind. Electron. 56(3), 2009; stripped from the maglev rig's paper, which names its parameters):
//!
//! ```text
//! fal(e, al, de) = e / de^(1 - al)    if |e| <= de
//!                  |e|^al sgn(e)      otherwise
//! ```
//!
//! It is continuous, odd, and for al < 1 steep near zero and flat beyond: small errors weigh more than large ones.

use serde::{Deserialize, Serialize};

/// fal with its parameters; de^(al - 1) is computed once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fal {
    exponent: f64,
    linear_zone: f64,
    slope: f64,
}

impl Fal {
    /// `exponent` is al, above 0, usually at most 1; `linear_zone` is de, above 0, in the error's unit.
    pub fn new(exponent: f64, linear_zone: f64) -> Self {
        let slope = power(linear_zone, libm::log(linear_zone), exponent) / linear_zone;
        Self { exponent, linear_zone, slope }
    }

    /// Slope in the linear zone, de^(al - 1).
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// fal(e).
    #[inline]
    pub fn value(&self, error: f64) -> f64 {
        let [value] = values(&[*self], error);
        value
    }
}

/// Several such functions of one error, which share its logarithm.
#[inline]
pub fn values<const N: usize>(functions: &[Fal; N], error: f64) -> [f64; N] {
    let magnitude = error.abs();
    let is_linear = |function: &Fal| magnitude <= function.linear_zone || function.exponent == 1.0;
    if functions.iter().all(is_linear) {
        return core::array::from_fn(|index| functions[index].slope * error);
    }
    let needs_logarithm =
        functions.iter().any(|function| !is_linear(function) && !has_roots_only(function.exponent));
    let logarithm = if needs_logarithm { libm::log(magnitude) } else { 0.0 };
    core::array::from_fn(|index| {
        let function = &functions[index];
        if is_linear(function) {
            function.slope * error
        } else {
            power(magnitude, logarithm, function.exponent).copysign(error)
        }
    })
}

/// Whether [`power`] needs no logarithm.
#[inline]
fn has_roots_only(exponent: f64) -> bool {
    exponent == 1.0 || exponent == 0.5 || exponent == 0.25
}

/// magnitude^exponent, given the logarithm of the magnitude.
///
/// The exponents of the paper, 1, 1/2 and 1/4, are square roots, within an ulp of the power; all others are
/// exp(al log e), good to 1 + al |log e| / 2 ulp: a few for any error of practical size, at a fifth of the time of
/// three calls of `libm::pow`. Both give the same bits on every platform.
#[inline]
fn power(magnitude: f64, logarithm: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        magnitude
    } else if exponent == 0.5 {
        magnitude.sqrt()
    } else if exponent == 0.25 {
        magnitude.sqrt().sqrt()
    } else {
        libm::exp(exponent * logarithm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn function_is_as_defined(
            error in -10.0..10.0f64, linear_zone in 1e-4..1.2f64,
            exponent in prop_oneof![0.05..1.0f64, Just(1.0), Just(0.5), Just(0.25)],
        ) {
            let value = Fal::new(exponent, linear_zone).value(error);
            let defined = if error.abs() <= linear_zone {
                error / libm::pow(linear_zone, 1.0 - exponent)
            } else {
                libm::pow(error.abs(), exponent) * error.signum()
            };
            prop_assert!((value - defined).abs() <= 2e-15 * defined.abs(), "{value} {defined}");
        }

        #[test]
        fn roots_are_powers_within_an_ulp(magnitude in 1e-12..1e12f64) {
            for exponent in [1.0, 0.5, 0.25] {
                let exact = libm::pow(magnitude, exponent);
                let root = power(magnitude, 0.0, exponent);
                prop_assert!(exact.to_bits().abs_diff(root.to_bits()) <= 1, "{magnitude}^{exponent}");
            }
        }

        #[test]
        fn function_is_continuous_and_odd(linear_zone in 1e-4..1.2f64, exponent in 0.05..1.0f64) {
            let function = Fal::new(exponent, linear_zone);
            let (inside, outside) = (function.value(linear_zone), function.value(linear_zone * (1.0 + 1e-15)));
            prop_assert!((inside - outside).abs() < 1e-14 * inside);
            for error in [0.5 * linear_zone, 2.0 * linear_zone] {
                prop_assert_eq!(function.value(-error), -function.value(error));
            }
        }
    }

    #[test]
    fn exponent_one_is_linear_everywhere() {
        let function = Fal::new(1.0, 0.01);
        assert_eq!(function.slope(), 1.0);
        for error in [-3.0, 0.0, 1e-3, 0.5] {
            assert_eq!(function.value(error), error);
        }
    }
}
