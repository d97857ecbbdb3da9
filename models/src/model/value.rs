//! Checks that a value may be given to a variable.

use core::fmt;

use super::variable::{Kind, Variable};
use thiserror::Error;

/// Why a value was refused; names the variable, the value, its unit and what was expected.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ValueError {
    #[error("{name} = {value} {unit}: expected a finite number", value = Readable(*value))]
    NotFinite { name: &'static str, value: f64, unit: &'static str },
    #[error("derivative of {name} = {value} {unit}/s: expected a finite number")]
    SlopeNotFinite { name: &'static str, value: f64, unit: &'static str },
    #[error(
        "{name} = {value} {unit}: expected {minimum} to {maximum} {unit}",
        value = Readable(*value), minimum = Readable(*minimum), maximum = Readable(*maximum)
    )]
    OutOfRange { name: &'static str, value: f64, unit: &'static str, minimum: f64, maximum: f64 },
    #[error("{name} = {value}: expected an item of {enumeration}, 1 to {count}", value = Readable(*value))]
    NoItem { name: &'static str, value: f64, enumeration: &'static str, count: usize },
}

/// A number for people: with an exponent where it would have many zeros otherwise.
pub(super) struct Readable(pub(super) f64);

impl fmt::Display for Readable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        let is_handy = value == 0.0 || !value.is_finite() || (1e-4..1e7).contains(&value.abs());
        if is_handy { write!(formatter, "{value}") } else { write!(formatter, "{value:e}") }
    }
}

/// As `f64::is_finite`, by the bits: no comparison of numbers, which a host may let trap.
#[inline]
pub fn is_finite(value: f64) -> bool {
    const EXPONENT: u64 = 0x7FF << 52;
    value.to_bits() & EXPONENT != EXPONENT
}

impl Variable {
    /// Whether `value` fits the variable's kind and range.
    #[inline]
    pub fn check(&self, value: f64) -> Result<(), ValueError> {
        if self.accepted.contain(value) {
            return Ok(());
        }
        self.check_item_or_refuse(value)
    }

    /// Whether `value` is an item of the variable's enumeration; if it has none, why the value does not fit.
    #[inline(never)]
    fn check_item_or_refuse(&self, value: f64) -> Result<(), ValueError> {
        let (name, (minimum, maximum)) = (self.name, self.range);
        if !is_finite(value) {
            return Err(ValueError::NotFinite { name, value, unit: self.unit() });
        }
        let Kind::Enumeration(enumeration) = self.kind else {
            return Err(ValueError::OutOfRange { name, value, unit: self.unit(), minimum, maximum });
        };
        let count = enumeration.items.len();
        if value.fract() == 0.0 && value >= 1.0 && value <= count as f64 {
            return Ok(());
        }
        Err(ValueError::NoItem { name, value, enumeration: enumeration.name, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::quantity::{DURATION, Enumeration};

    static COLOUR: Enumeration =
        Enumeration { name: "Colour", description: "", items: &[("red", ""), ("blue", "")] };

    #[test]
    fn the_order_of_bits_is_that_of_numbers() {
        let numbers = [f64::MIN, -1.5, -1.0, -5e-324, -0.0, 0.0, 5e-324, 1e-310, 1.0, 1.5, f64::MAX];
        for value in numbers {
            assert!(is_finite(value));
            for (minimum, maximum) in numbers.iter().flat_map(|a| numbers.map(|b| (*a, b))) {
                let expected = value >= minimum && value <= maximum;
                let row = Variable::parameter("length", Kind::Real(&DURATION), 0.0).range(minimum, maximum);
                assert_eq!(row.check(value).is_ok(), expected, "{minimum} {value} {maximum}");
            }
        }
        assert!(![f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY].into_iter().any(is_finite));
    }

    #[test]
    fn messages_name_value_unit_and_expectation() {
        let period = Variable::parameter("sample_time", Kind::Real(&DURATION), 1e-3).range(1e-6, 1.0);
        assert_eq!(period.check(1e-6), Ok(()));
        assert_eq!(period.check(0.0).unwrap_err().to_string(), "sample_time = 0 s: expected 1e-6 to 1 s");
        assert_eq!(
            period.check(f64::NAN).unwrap_err().to_string(),
            "sample_time = NaN s: expected a finite number"
        );
        assert_eq!(
            period.check(-1e300).unwrap_err().to_string(),
            "sample_time = -1e300 s: expected 1e-6 to 1 s"
        );
        let colour = Variable::tunable("colour", Kind::Enumeration(&COLOUR), 1.0);
        assert_eq!(colour.check(2.0), Ok(()));
        for wrong in [0.0, 3.0, 1.5] {
            assert!(colour.check(wrong).unwrap_err().to_string().contains("an item of Colour, 1 to 2"));
        }
    }
}
