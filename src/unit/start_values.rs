//! Start values of a package that differ from the library's, and how the library gets to know them.
//!
//! An importer need not set a variable that is to start with the value in the model description, so the library has to
//! start with that value by itself. A package with other start values therefore carries them in its instantiation token
//! (FMI 2: GUID), which every importer hands to the library as it stands: the token of the unit, then `;` and
//! `value reference=value` for each, in decimals that read back to the same bits:
//!
//! ```text
//! {01234567-89ab-cdef-0123-456789abcdef};17=180.0;23=-3705.0
//! ```
//!
//! The unit's token covers the table, so the references cannot mean other variables. No file is read at run time, one
//! library serves all packages, and a reset goes back to these values.

use core::fmt::{self, Write};

use thiserror::Error;

use super::value::ValueError;
use super::variable::{Kind, Variable};
use super::{Description, UNITS, Unit, UnitType};

/// Start values by value reference, in ascending order; variables that are not in it start as the table says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartValues {
    values: Vec<(usize, f64)>,
}

/// Why a variable cannot start with a value.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StartValueError {
    #[error("{unit} has no variable {name}")]
    UnknownVariable { unit: &'static str, name: String },
    #[error("{name} is calculated by {unit}: expected a parameter or an input")]
    Calculated { unit: &'static str, name: &'static str },
    #[error("{name} = {value}: expected {expected}")]
    NotWhole { name: &'static str, value: f64, expected: &'static str },
    #[error(transparent)]
    Value(#[from] ValueError),
}

/// Why a token was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TokenError {
    #[error("the token \"{0}\" is none of this library: {KnownTokens}")]
    Unknown(String),
    #[error("the token ends with \"{0}\": expected ;value reference=value")]
    Malformed(String),
    #[error(transparent)]
    StartValue(#[from] StartValueError),
}

impl StartValues {
    /// Those of the table.
    pub const TABLE: &Self = &Self { values: Vec::new() };

    /// Lets the variable called `name` start with `value`, of an enumeration the number of an item.
    pub fn set(
        &mut self,
        description: &'static Description,
        name: &str,
        value: f64,
    ) -> Result<(), StartValueError> {
        let (reference, _) = description.find(name).ok_or_else(|| StartValueError::UnknownVariable {
            unit: description.name,
            name: name.to_owned(),
        })?;
        self.set_by_reference(description, reference, value)
    }

    fn set_by_reference(
        &mut self,
        description: &'static Description,
        reference: usize,
        value: f64,
    ) -> Result<(), StartValueError> {
        let unit = description.name;
        let variable = description.variables.get(reference).ok_or_else(|| {
            StartValueError::UnknownVariable { unit, name: format!("with the value reference {reference}") }
        })?;
        if variable.is_calculated() {
            return Err(StartValueError::Calculated { unit, name: variable.name });
        }
        let whole = match variable.kind {
            Kind::Integer if value.fract() != 0.0 => Some("an integer"),
            Kind::Boolean if value != 0.0 && value != 1.0 => Some("true or false"),
            _ => None,
        };
        if let Some(expected) = whole {
            return Err(StartValueError::NotWhole { name: variable.name, value, expected });
        }
        variable.check(value)?;
        self.insert(reference, value);
        Ok(())
    }

    /// These values, except where `others` have some.
    pub fn overridden_by(mut self, others: &Self) -> Self {
        for (reference, value) in &others.values {
            self.insert(*reference, *value);
        }
        self
    }

    /// Whether all of `others` are among these values.
    pub fn include(&self, others: &Self) -> bool {
        others.values.iter().all(|value| self.values.contains(value))
    }

    fn insert(&mut self, reference: usize, value: f64) {
        match self.values.binary_search_by_key(&reference, |(known, _)| *known) {
            Ok(place) => self.values[place].1 = value,
            Err(place) => self.values.insert(place, (reference, value)),
        }
    }

    /// With what the variable with this value reference starts.
    pub fn of(&self, reference: usize, variable: &Variable) -> f64 {
        let own = self.values.binary_search_by_key(&reference, |(known, _)| *known);
        own.map_or(variable.start, |place| self.values[place].1)
    }

    /// Instantiation token of a package of this unit with these start values.
    pub fn token(&self, description: &Description) -> String {
        let mut token = description.token().as_str().to_owned();
        for (reference, value) in &self.values {
            // Writing to a string cannot fail.
            let _ = write!(token, ";{reference}={value:?}");
        }
        token
    }

    /// Gives these values to a unit that was just made.
    pub fn apply(&self, unit: &mut dyn Unit) {
        for (reference, value) in &self.values {
            unit.values_mut()[*reference] = *value;
        }
    }
}

/// The unit that a token stands for and the start values in it.
pub fn read_token(token: &str) -> Result<(&'static UnitType, StartValues), TokenError> {
    let mut parts = token.split(';');
    let base = parts.next().unwrap_or_default();
    let unit = UNITS
        .iter()
        .find(|unit| unit.description.token().as_str() == base)
        .ok_or_else(|| TokenError::Unknown(token.to_owned()))?;
    let mut values = StartValues::default();
    for part in parts {
        let malformed = || TokenError::Malformed(part.to_owned());
        let (reference, value) = part.split_once('=').ok_or_else(malformed)?;
        let reference = reference.parse().map_err(|_| malformed())?;
        let value = value.parse().map_err(|_| malformed())?;
        values.set_by_reference(unit.description, reference, value)?;
    }
    Ok((unit, values))
}

/// All units with their tokens, for an error message.
struct KnownTokens;

impl fmt::Display for KnownTokens {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("expected")?;
        UNITS.iter().try_for_each(|unit| {
            write!(formatter, " {} for {}", unit.description.token().as_str(), unit.description.name)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::MAGNETIC_BEARING_CONTROLLER as CONTROLLER;
    use super::*;

    fn values(assignments: &[(&str, f64)]) -> Result<StartValues, StartValueError> {
        let mut values = StartValues::default();
        for (name, value) in assignments {
            values.set(CONTROLLER.description, name, *value)?;
        }
        Ok(values)
    }

    #[test]
    fn token_carries_every_bit() {
        let written =
            values(&[("controller.k2", 0.1 + 0.2), ("controller.k1", -1e-300), ("observer.kind", 4.0)])
                .unwrap();
        let (unit, read) = read_token(&written.token(CONTROLLER.description)).unwrap();
        assert!(core::ptr::eq(unit.description, CONTROLLER.description));
        assert_eq!(read, written);
        let mut made = (unit.create)();
        read.apply(&mut *made);
        for (name, expected) in
            [("controller.k2", 0.1 + 0.2), ("controller.k1", -1e-300), ("sample_time", 1e-3)]
        {
            let (reference, variable) = CONTROLLER.description.find(name).unwrap();
            assert_eq!(made.values()[reference].to_bits(), f64::to_bits(expected));
            assert_eq!(read.of(reference, variable), expected);
        }
    }

    #[test]
    fn values_go_before_others() {
        let [system, user] = [
            values(&[("controller.k1", 1.0), ("controller.k2", 2.0)]).unwrap(),
            values(&[("controller.k2", 3.0), ("sample_time", 0.5)]).unwrap(),
        ];
        let both = system.clone().overridden_by(&user);
        let expected =
            values(&[("controller.k1", 1.0), ("controller.k2", 3.0), ("sample_time", 0.5)]).unwrap();
        assert_eq!(both, expected);
        assert!(both.include(&user) && !both.include(&system) && both.include(StartValues::TABLE));
    }

    #[test]
    fn without_start_values_the_token_is_the_units() {
        let plain = CONTROLLER.description.token();
        assert_eq!(StartValues::TABLE.token(CONTROLLER.description), plain.as_str());
        assert_eq!(read_token(plain.as_str()).unwrap().1, *StartValues::TABLE);
    }

    #[test]
    fn wrong_values_and_tokens_are_explained() {
        let message = |name: &str, value: f64| values(&[(name, value)]).unwrap_err().to_string();
        assert_eq!(message("k1", 1.0), "MagneticBearingController has no variable k1");
        assert!(message("voltage", 1.0).contains("calculated"));
        assert!(message("sample_time", 5.0).contains("expected 1e-6 to 1 s"));
        assert!(message("observer.max_iterations", 1.5).contains("an integer"));
        assert!(message("observer.line_search", 2.0).contains("true or false"));
        assert!(message("observer.kind", 9.0).contains("an item of BearingObserver"));

        let plain = CONTROLLER.description.token();
        let refused = |tail: &str| read_token(&format!("{}{tail}", plain.as_str())).unwrap_err().to_string();
        for tail in [";", ";k1=1.0", ";17", ";17=", ";-1=0.0", ";17=one"] {
            assert!(refused(tail).contains("expected ;value reference=value"), "{tail}");
        }
        assert!(refused(";4711=0.0").contains("no variable with the value reference 4711"));
        assert!(refused(";0=1.0").contains("time is calculated"));
        assert!(read_token("{}").unwrap_err().to_string().contains("for MagneticBearingPlant"));
    }
}
