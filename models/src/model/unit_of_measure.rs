//! Units of measure with their dimensions, and how tools should display them.

/// Declares [`Dimension`] from the names that FMI and SSP give to the base units.
macro_rules! base_units {
    ($($name:ident $what:literal),* $(,)?) => {
        /// Exponents of the SI base units and the radian, named as in FMI's `BaseUnit`.
        #[allow(non_snake_case, reason = "A is ampere, K is kelvin")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct Dimension {
            $(#[doc = $what] pub $name: i8,)*
        }

        impl Dimension {
            pub const NONE: Self = Self { $($name: 0,)* };

            /// Names and exponents, in the order of the standards' schemas.
            pub const fn exponents(&self) -> [(&'static str, i8); [$($what),*].len()] {
                [$((stringify!($name), self.$name)),*]
            }
        }
    };
}

base_units! {
    kg "kilogram", m "metre", s "second", A "ampere", K "kelvin", mol "mole", cd "candela", rad "radian",
}

/// Unit of measure: a value in the unit of its dimension is `factor` times the value in this unit plus `offset`.
#[derive(Debug)]
pub struct UnitOfMeasure {
    pub name: &'static str,
    pub dimension: Dimension,
    pub factor: f64,
    pub offset: f64,
    /// What tools should display instead.
    pub display: Option<DisplayUnit>,
}

/// A displayed value is `factor` times the value in the unit of measure plus `offset`.
#[derive(Debug)]
pub struct DisplayUnit {
    pub name: &'static str,
    pub factor: f64,
    pub offset: f64,
}

impl UnitOfMeasure {
    /// The unit of a dimension, such as m or N.
    pub const fn new(name: &'static str, dimension: Dimension) -> Self {
        Self { name, dimension, factor: 1.0, offset: 0.0, display: None }
    }

    /// Displayed in another unit, of which `factor` make one of this unit.
    pub const fn displayed_in(mut self, name: &'static str, factor: f64) -> Self {
        self.display = Some(DisplayUnit { name, factor, offset: 0.0 });
        self
    }

    /// As [`Self::displayed_in`], for a scale with another zero.
    pub const fn displayed_from(mut self, name: &'static str, factor: f64, offset: f64) -> Self {
        self.display = Some(DisplayUnit { name, factor, offset });
        self
    }
}

/// Declares units of measure: their exponents where they are not 0, then how they are displayed.
macro_rules! units_of_measure {
    ($($unit:ident = $name:literal, { $($base:ident: $exponent:literal),* } $(.$display:ident($($argument:expr),*))?;)*) => {
        $(pub static $unit: UnitOfMeasure = UnitOfMeasure::new(
            $name,
            Dimension { $($base: $exponent,)* ..Dimension::NONE },
        )$(.$display($($argument),*))?;)*

        /// All of these.
        pub static UNITS_OF_MEASURE: &[&UnitOfMeasure] = &[$(&$unit),*];
    };
}

units_of_measure! {
    ONE = "1", {};
    KILOGRAM = "kg", { kg: 1 }.displayed_in("g", 1e3);
    METRE = "m", { m: 1 }.displayed_in("mm", 1e3);
    SECOND = "s", { s: 1 };
    AMPERE = "A", { A: 1 };
    KELVIN = "K", { K: 1 }.displayed_from("degC", 1.0, -273.15);
    MOLE = "mol", { mol: 1 };
    CANDELA = "cd", { cd: 1 };
    RADIAN = "rad", { rad: 1 }.displayed_in("deg", 57.295_779_513_082_32);
    PER_SECOND = "1/s", { s: -1 };
    PER_SECOND_SQUARED = "1/s2", { s: -2 };
    PER_SECOND_CUBED = "1/s3", { s: -3 };
    METRE_PER_SECOND = "m/s", { m: 1, s: -1 }.displayed_in("mm/s", 1e3);
    METRE_PER_SECOND_SQUARED = "m/s2", { m: 1, s: -2 };
    RADIAN_PER_SECOND = "rad/s", { s: -1, rad: 1 }.displayed_in("rev/min", 9.549_296_585_513_721);
    RADIAN_PER_SECOND_SQUARED = "rad/s2", { s: -2, rad: 1 };
    NEWTON = "N", { kg: 1, m: 1, s: -2 }.displayed_in("mN", 1e3);
    NEWTON_METRE = "N.m", { kg: 1, m: 2, s: -2 };
    NEWTON_SECOND_PER_METRE = "N.s/m", { kg: 1, s: -1 };
    NEWTON_PER_VOLT = "N/V", { m: -1, s: 1, A: 1 };
    KILOGRAM_METRE_SQUARED = "kg.m2", { kg: 1, m: 2 };
    VOLT = "V", { kg: 1, m: 2, s: -3, A: -1 };
    VOLT_PER_METRE = "V/m", { kg: 1, m: 1, s: -3, A: -1 };
    VOLT_SECOND_PER_METRE = "V.s/m", { kg: 1, m: 1, s: -2, A: -1 };
    WEBER = "Wb", { kg: 1, m: 2, s: -2, A: -1 }.displayed_in("mWb", 1e3);
    OHM = "Ohm", { kg: 1, m: 2, s: -3, A: -2 };
    AMPERE_PER_VOLT = "A/V", { kg: -1, m: -2, s: 3, A: 2 };
    NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE = "N.m2/A2", { kg: 1, m: 3, s: -2, A: -2 };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::MODELS;
    use crate::model::variable::Kind;

    const COUNT: usize = Dimension::NONE.exponents().len();

    /// A unit by its symbol: how many units of its dimension it is, and where its zero is.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Meaning {
        size: f64,
        zero: f64,
        exponents: [i8; COUNT],
    }

    /// Exponents of kg, m, s, A, K, mol, cd, rad from definitions of the SI brochure, 9th edition, tables 2 and 4.
    fn symbol(text: &str) -> Option<Meaning> {
        let (size, zero, exponents) = match text {
            "1" => (1.0, 0.0, [0; COUNT]),
            "g" => (1e-3, 0.0, [1, 0, 0, 0, 0, 0, 0, 0]),
            "m" => (1.0, 0.0, [0, 1, 0, 0, 0, 0, 0, 0]),
            "s" => (1.0, 0.0, [0, 0, 1, 0, 0, 0, 0, 0]),
            "min" => (60.0, 0.0, [0, 0, 1, 0, 0, 0, 0, 0]),
            "A" => (1.0, 0.0, [0, 0, 0, 1, 0, 0, 0, 0]),
            "K" => (1.0, 0.0, [0, 0, 0, 0, 1, 0, 0, 0]),
            "degC" => (1.0, 273.15, [0, 0, 0, 0, 1, 0, 0, 0]),
            "mol" => (1.0, 0.0, [0, 0, 0, 0, 0, 1, 0, 0]),
            "cd" => (1.0, 0.0, [0, 0, 0, 0, 0, 0, 1, 0]),
            "rad" => (1.0, 0.0, [0, 0, 0, 0, 0, 0, 0, 1]),
            "deg" => (core::f64::consts::PI / 180.0, 0.0, [0, 0, 0, 0, 0, 0, 0, 1]),
            "rev" => (core::f64::consts::TAU, 0.0, [0, 0, 0, 0, 0, 0, 0, 1]),
            "N" => (1.0, 0.0, [1, 1, -2, 0, 0, 0, 0, 0]),
            "V" => (1.0, 0.0, [1, 2, -3, -1, 0, 0, 0, 0]),
            "Wb" => (1.0, 0.0, [1, 2, -2, -1, 0, 0, 0, 0]),
            "Ohm" => (1.0, 0.0, [1, 2, -3, -2, 0, 0, 0, 0]),
            prefixed => {
                let prefixes = [("m", 1e-3), ("k", 1e3)];
                let (factor, known) = prefixes.into_iter().find_map(|(prefix, factor)| {
                    Some((factor, prefixed.strip_prefix(prefix).and_then(symbol)?))
                })?;
                return Some(Meaning { size: factor * known.size, ..known });
            }
        };
        Some(Meaning { size, zero, exponents })
    }

    /// Products and a quotient of powers, such as N.m2/A2.
    fn meaning(name: &str) -> Meaning {
        let (above, below) = name.split_once('/').unwrap_or((name, "1"));
        let mut all = Meaning { size: 1.0, zero: 0.0, exponents: [0; COUNT] };
        for (factors, sign) in [(above, 1), (below, -1)] {
            for factor in factors.split('.') {
                let letters = factor.trim_end_matches(|letter: char| letter.is_ascii_digit());
                let (text, power) = match letters {
                    "" => (factor, 1),
                    letters => (letters, factor[letters.len()..].parse().unwrap_or(1)),
                };
                let known = symbol(text).unwrap_or_else(|| panic!("{text} in {name}"));
                all.size *= known.size.powi(i32::from(sign * power));
                all.zero += known.zero;
                for (sum, exponent) in all.exponents.iter_mut().zip(known.exponents) {
                    *sum += sign * power * exponent;
                }
            }
        }
        all
    }

    #[test]
    fn dimensions_and_display_units_are_those_of_the_names() {
        for unit in UNITS_OF_MEASURE {
            let expected = meaning(unit.name);
            assert_eq!(
                unit.dimension.exponents().map(|(_, exponent)| exponent),
                expected.exponents,
                "{}",
                unit.name
            );
            assert_eq!((unit.factor, unit.offset), (expected.size, expected.zero), "{}", unit.name);
            let Some(display) = &unit.display else { continue };
            let shown = meaning(display.name);
            assert_eq!(shown.exponents, expected.exponents, "{}", display.name);
            // What is displayed means the same.
            for value in [0.0, 1.0, -2.5] {
                let displayed = display.factor * value + display.offset;
                let back = shown.size * displayed + shown.zero;
                assert!((back - value).abs() < 1e-12, "{}: {value} {back}", display.name);
            }
        }
    }

    #[test]
    fn names_differ_and_units_of_variables_are_listed() {
        for (place, unit) in UNITS_OF_MEASURE.iter().enumerate() {
            assert!(
                UNITS_OF_MEASURE[..place].iter().all(|other| other.name != unit.name),
                "{} twice",
                unit.name
            );
        }
        for variable in MODELS.iter().flat_map(|model| model.description.variables) {
            if let Kind::Real(quantity) = variable.kind {
                assert!(
                    UNITS_OF_MEASURE.iter().any(|unit| core::ptr::eq(*unit, quantity.unit)),
                    "{}",
                    variable.name
                );
            }
        }
    }
}
