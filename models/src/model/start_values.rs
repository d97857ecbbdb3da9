//! Start values of a package that differ from the library's, and how the library gets to know them.
//!
//! An importer need not set a variable that is to start with the value in the model description, so the library has to
//! start with that value by itself. A package with other start values therefore carries them in its instantiation token
//! (FMI 2: GUID), which every importer hands to the library as it stands: the token of the model's edition, then `;` and
//! `value reference=value` for each, in decimals that read back to the same bits:
//!
//! ```text
//! {01234567-89ab-cdef-0123-456789abcdef};17=180.0;23=-3705.0
//! ```
//!
//! The edition's token covers the table, so the references cannot mean other variables. No file is read at run time, one
//! library serves all packages, and a reset goes back to these values.

use core::fmt::{self, Write};

use thiserror::Error;

use super::memory::{OutOfMemory, try_reserve};
use super::value::ValueError;
use super::variable::{Kind, Variable};
use super::{Description, Edition, Model, ModelType, editions};

/// Start values by value reference, in ascending order; variables that are not in it start as the table says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartValues {
    values: Vec<(usize, f64)>,
}

/// Why a variable cannot start with a value.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StartValueError {
    #[error("{model} has no variable {}", name.escape_debug())]
    UnknownVariable { model: &'static str, name: String },
    #[error("{model} has no variable with the value reference {reference}")]
    UnknownReference { model: &'static str, reference: usize },
    #[error("{name} is calculated by {model}: expected a parameter or an input")]
    Calculated { model: &'static str, name: &'static str },
    #[error("{name} = {value}: expected {expected}")]
    NotWhole { name: &'static str, value: f64, expected: &'static str },
    #[error(transparent)]
    Value(#[from] ValueError),
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

/// Why a token was refused; says so without the heap, which may be what is missing.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TokenError<'a> {
    #[error("the token \"{}\" is not one of this library: {KnownTokens}", .0.escape_debug())]
    Unknown(&'a str),
    #[error("the token ends with \"{}\": expected ;value reference=value", .0.escape_debug())]
    Malformed(&'a str),
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
            model: description.name,
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
        let model = description.name;
        let Some(variable) = description.variables.get(reference) else {
            return Err(StartValueError::UnknownReference { model, reference });
        };
        if variable.is_calculated() {
            return Err(StartValueError::Calculated { model, name: variable.name });
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
        Ok(self.insert(reference, value)?)
    }

    /// These values, except where `others` have some.
    pub fn overridden_by(mut self, others: &Self) -> Result<Self, OutOfMemory> {
        for (reference, value) in &others.values {
            self.insert(*reference, *value)?;
        }
        Ok(self)
    }

    /// Whether all of `others` are among these values.
    pub fn include(&self, others: &Self) -> bool {
        others.values.iter().all(|value| self.values.contains(value))
    }

    fn insert(&mut self, reference: usize, value: f64) -> Result<(), OutOfMemory> {
        match self.values.binary_search_by_key(&reference, |(known, _)| *known) {
            Ok(place) => self.values[place].1 = value,
            Err(place) => {
                try_reserve("start values", &mut self.values, 1)?;
                self.values.insert(place, (reference, value));
            }
        }
        Ok(())
    }

    /// With what the variable with this value reference starts.
    pub fn of(&self, reference: usize, variable: &Variable) -> f64 {
        let own = self.values.binary_search_by_key(&reference, |(known, _)| *known);
        own.map_or(variable.start, |place| self.values[place].1)
    }

    /// Instantiation token of a package of this edition of the model with these start values.
    pub fn token(&self, description: &Description, edition: Edition) -> String {
        let mut token = edition.token(description).as_str().to_owned();
        for (reference, value) in &self.values {
            // Writing to a string cannot fail.
            let _ = write!(token, ";{reference}={value:?}");
        }
        token
    }

    /// Gives these values to a model that was just made.
    pub fn apply(&self, model: &mut dyn Model) {
        for (reference, value) in &self.values {
            model.values_mut()[*reference] = *value;
        }
    }
}

/// The edition of a model that a token stands for and the start values in it.
pub fn read_token(token: &str) -> Result<(&'static ModelType, Edition, StartValues), TokenError<'_>> {
    let mut parts = token.split(';');
    let base = parts.next().unwrap_or_default();
    let (model, edition) = editions()
        .find(|(model, edition)| edition.token(model.description).as_str() == base)
        .ok_or(TokenError::Unknown(token))?;
    let mut values = StartValues::default();
    for part in parts {
        let Some((Ok(reference), Ok(value))) =
            part.split_once('=').map(|(reference, value)| (reference.parse(), value.parse()))
        else {
            return Err(TokenError::Malformed(part));
        };
        values.set_by_reference(model.description, reference, value)?;
    }
    Ok((model, edition, values))
}

/// All editions of all models with their tokens, for an error message.
struct KnownTokens;

impl fmt::Display for KnownTokens {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("expected")?;
        editions().try_for_each(|(model, edition)| {
            let (token, name) = (edition.token(model.description), model.description.name);
            let clocks = if edition == Edition::Clocked { " with clocks" } else { "" };
            write!(formatter, " {} for {name}{clocks}", token.as_str())
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
        let token = written.token(CONTROLLER.description, Edition::Plain);
        let (model, _, read) = read_token(&token).unwrap();
        assert!(core::ptr::eq(model.description, CONTROLLER.description));
        assert_eq!(read, written);
        let mut made = (model.create)();
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
    fn every_edition_has_its_token_and_takes_start_values() {
        let own = values(&[("controller.k2", 0.25)]).unwrap();
        for (model, edition) in editions() {
            let description = model.description;
            let token = edition.token(description);
            assert_eq!(StartValues::TABLE.token(description, edition), token.as_str());
            let mut all = vec![StartValues::TABLE.clone()];
            if core::ptr::eq(description, CONTROLLER.description) {
                all.push(own.clone());
            }
            for values in all {
                let (found, found_edition, read) = read_token(&values.token(description, edition)).unwrap();
                assert!(core::ptr::eq(found.description, description));
                assert_eq!((found_edition, read), (edition, values), "{}", description.name);
            }
        }
    }

    #[test]
    fn values_go_before_others() {
        let [system, user] = [
            values(&[("controller.k1", 1.0), ("controller.k2", 2.0)]).unwrap(),
            values(&[("controller.k2", 3.0), ("sample_time", 0.5)]).unwrap(),
        ];
        let both = system.clone().overridden_by(&user).unwrap();
        let expected =
            values(&[("controller.k1", 1.0), ("controller.k2", 3.0), ("sample_time", 0.5)]).unwrap();
        assert_eq!(both, expected);
        assert!(both.include(&user) && !both.include(&system) && both.include(StartValues::TABLE));
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
