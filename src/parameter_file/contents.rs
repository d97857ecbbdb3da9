//! What a parameter file holds, and start values from it.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::ParameterFileError;
use super::unique_keys;
use crate::file::{self, WrittenFile};
use crate::model::start_values::StartValueError;
use crate::model::variable::{Kind, Variable};
use crate::model::{Description, StartValues, models};

/// Contents of a parameter file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterFile {
    /// Name of the model; older files call it `unit`.
    #[serde(alias = "unit")]
    pub model: String,
    #[serde(deserialize_with = "unique_keys::map")]
    pub values: Map<String, Value>,
    #[serde(default, deserialize_with = "unique_keys::map")]
    pub units: Map<String, Value>,
    #[serde(default, deserialize_with = "unique_keys::value")]
    pub provenance: Value,
}

impl ParameterFile {
    /// From variables of a model and their values, of enumerations the name or number of an item.
    pub fn new<'a>(
        description: &'static Description,
        assignments: impl IntoIterator<Item = (&'a str, Value)>,
        provenance: Value,
    ) -> Result<Self, ParameterFileError> {
        let (mut values, mut units) = (Map::new(), Map::new());
        for (name, value) in assignments {
            let (variable, value) = checked(description, name, &value)?;
            values.insert(name.to_owned(), number(variable, value));
            units.insert(name.to_owned(), unit_text(variable, value).into());
        }
        let file = Self { model: description.name.to_owned(), values, units, provenance };
        file.start_values()?;
        Ok(file)
    }

    pub fn write(&self, path: &Path) -> Result<WrittenFile, ParameterFileError> {
        file::write(path.to_owned(), format!("{self:#}\n").as_bytes())
            .map_err(|source| ParameterFileError::Write { path: path.to_owned(), source })
    }

    /// The model's table and the values, checked by themselves and whether they fit together.
    pub fn start_values(&self) -> Result<(&'static Description, StartValues), ParameterFileError> {
        let model = models()
            .find(|model| model.description.name == self.model)
            .ok_or_else(|| ParameterFileError::UnknownModel { name: self.model.clone() })?;
        let description = model.description;
        let mut start_values = StartValues::default();
        for (name, value) in &self.values {
            let (variable, number) = checked(description, name, value)?;
            start_values.set(description, name, number)?;
            if let Some(given) = self.units.get(name) {
                let expected = unit_text(variable, number);
                if *given != expected.as_str() {
                    return Err(ParameterFileError::WrongUnit {
                        name: name.clone(),
                        given: given.clone(),
                        expected,
                    });
                }
            }
        }
        if let Some(name) = self.units.keys().find(|name| !self.values.contains_key(*name)) {
            return Err(ParameterFileError::UnitWithoutValue { name: name.clone() });
        }
        let mut model = (model.create)();
        start_values.apply(&mut *model);
        model.check_parameters()?;
        Ok((description, start_values))
    }
}

impl std::fmt::Display for ParameterFile {
    /// JSON; the alternate form has line breaks.
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = if formatter.alternate() {
            serde_json::to_string_pretty(self)
        } else {
            serde_json::to_string(self)
        };
        formatter.write_str(&text.map_err(|_| std::fmt::Error)?)
    }
}

/// The variable called `name` and the value as a number that it may start with.
fn checked(
    description: &'static Description,
    name: &str,
    value: &Value,
) -> Result<(&'static Variable, f64), ParameterFileError> {
    let unknown = || StartValueError::UnknownVariable { model: description.name, name: name.to_owned() };
    let (_, variable) = description.find(name).ok_or_else(unknown)?;
    let number = read_number(variable, value)?;
    StartValues::default().set(description, name, number)?;
    Ok((variable, number))
}

fn number(variable: &Variable, value: f64) -> Value {
    match variable.kind {
        Kind::Real(_) => value.into(),
        Kind::Boolean => (value != 0.0).into(),
        // Checked to be whole and in range.
        Kind::Integer | Kind::Enumeration(_) => (value as i64).into(),
    }
}

/// What the unit of a value is called in the file.
fn unit_text(variable: &Variable, value: f64) -> String {
    match variable.kind {
        Kind::Real(quantity) => quantity.unit.name.to_owned(),
        Kind::Integer => "integer".to_owned(),
        Kind::Boolean => "boolean".to_owned(),
        Kind::Enumeration(enumeration) => {
            let item = enumeration.items.get((value as usize).wrapping_sub(1));
            format!("item {}", item.map_or("?", |(name, _)| name))
        }
    }
}

fn read_number(variable: &Variable, value: &Value) -> Result<f64, ParameterFileError> {
    let (number, expected) = match variable.kind {
        Kind::Boolean => (value.as_bool().map(|flag| f64::from(u8::from(flag))), "true or false".to_owned()),
        Kind::Enumeration(enumeration) => {
            let names: Vec<&str> = enumeration.items.iter().map(|(name, _)| *name).collect();
            let by_name = value
                .as_str()
                .and_then(|text| names.iter().position(|name| *name == text))
                .map(|place| (place + 1) as f64);
            (by_name.or(value.as_f64()), format!("one of {}", names.join(", ")))
        }
        Kind::Integer => (value.as_f64(), "an integer".to_owned()),
        Kind::Real(quantity) => (value.as_f64(), format!("a number of {}", quantity.unit.name)),
    };
    number.ok_or_else(|| ParameterFileError::WrongKind {
        name: variable.name.to_owned(),
        value: value.clone(),
        expected,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::MAGNETIC_BEARING_CONTROLLER as CONTROLLER;
    use serde_json::json;
    use std::fs;

    fn file(values: Value, units: Value) -> ParameterFile {
        let text = json!({ "model": "MagneticBearingController", "values": values, "units": units });
        serde_json::from_value(text).unwrap()
    }

    #[test]
    fn what_is_written_reads_back() {
        let assignments = [
            ("observer.kind", json!("kalman"), 4.0),
            ("observer.line_search", json!(true), 1.0),
            ("observer.window", json!(10), 10.0),
            ("controller.k1", json!(0.1 + 0.2), 0.1 + 0.2),
        ];
        let given = assignments.iter().map(|(name, value, _)| (*name, value.clone()));
        let written = ParameterFile::new(CONTROLLER.description, given, json!({ "seed": 1 })).unwrap();
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("bearing.json");
        assert_eq!(written.write(&path).unwrap().size, fs::read(&path).unwrap().len());
        let read = ParameterFile::read(&path).unwrap();
        assert_eq!(read, written);
        assert_eq!(read.units["observer.kind"], "item kalman");
        let (description, values) = read.start_values().unwrap();
        assert_eq!(read.values["observer.kind"], 4);
        for (name, _, expected) in assignments {
            let (reference, variable) = description.find(name).unwrap();
            assert_eq!(values.of(reference, variable).to_bits(), f64::to_bits(expected), "{name}");
        }
    }

    #[test]
    fn items_may_be_named() {
        let (_, by_name) = file(json!({ "observer.kind": "kalman" }), json!({})).start_values().unwrap();
        let (_, by_number) = file(json!({ "observer.kind": 4 }), json!({})).start_values().unwrap();
        assert_eq!(by_name, by_number);
    }

    #[test]
    fn mistakes_are_explained() {
        let message =
            |values: Value, units: Value| file(values, units).start_values().unwrap_err().to_string();
        assert!(message(json!({ "gain": 1 }), json!({})).contains("has no variable gain"));
        assert!(message(json!({ "sample_time": "1 ms" }), json!({})).contains("a number of s"));
        assert!(message(json!({ "sample_time": 7.0 }), json!({})).contains("sample_time = 7 s: expected"));
        assert!(message(json!({ "observer.kind": "luenberger" }), json!({})).contains("one of newton"));
        let wrong_unit = message(json!({ "sample_time": 0.5 }), json!({ "sample_time": "ms" }));
        assert_eq!(wrong_unit, "sample_time is given in \"ms\": expected s");
        assert_eq!(message(json!({}), json!({ "sample_time": "s" })), "sample_time has a unit and no value");
        let unknown = ParameterFile { model: "Pendulum".to_owned(), ..file(json!({}), json!({})) };
        assert!(unknown.start_values().unwrap_err().to_string().contains("MagneticBearingController"));
    }

    /// Guards: names from a file that colour the terminal or hide what a message says.
    #[test]
    fn names_are_printed_escaped() {
        let name = "\u{1b}[31m\u{202e}gain\n";
        let escaped = r"\u{1b}[31m\u{202e}gain\n";
        let unknown = ParameterFile { model: name.to_owned(), ..file(json!({}), json!({})) };
        for message in [
            file(json!({ name: 1 }), json!({})).start_values().unwrap_err().to_string(),
            unknown.start_values().unwrap_err().to_string(),
        ] {
            assert!(message.contains(escaped), "{message}");
        }
        // Values that are texts: the wrong item and the wrong unit. JSON escapes the line break, not the direction.
        for values in [json!({ "observer.kind": name }), json!({ "sample_time": name })] {
            let message = file(values, json!({})).start_values().unwrap_err().to_string();
            assert!(message.contains(r"\u{202e}gain\n"), "{message}");
        }
    }
}
