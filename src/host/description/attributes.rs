//! Attributes are read as text first, so that an error can name the element and quote the text.

use std::str::FromStr;

use crate::host::error::{HostError, Result};

use super::model_description::{DefaultExperiment, EnumerationItem};
use crate::host::variable::{Causality, Variability};
use serde::Deserialize;

/// A number in an attribute that must be there.
pub(super) fn number<T: FromStr>(
    element: &str,
    attribute: &'static str,
    text: &str,
    expected: &'static str,
) -> Result<T> {
    text.trim().parse().map_err(|_| wrong(element, attribute, text, expected))
}

/// A real number in an attribute that may be absent.
pub(super) fn optional_real(
    element: &str,
    attribute: &'static str,
    text: Option<&str>,
) -> Result<Option<f64>> {
    text.map(|text| number(element, attribute, text, "a number")).transpose()
}

/// An `xs:boolean`; absent means false, as for every flag of both standards.
pub(super) fn flag(element: &str, attribute: &'static str, text: Option<&str>) -> Result<bool> {
    match text.map(str::trim) {
        None | Some("false" | "0") => Ok(false),
        Some("true" | "1") => Ok(true),
        Some(other) => Err(wrong(element, attribute, other, "true or false")),
    }
}

pub(super) fn causality(element: &str, text: Option<&str>) -> Result<Causality> {
    Ok(match text.unwrap_or("local") {
        "parameter" => Causality::Parameter,
        "calculatedParameter" => Causality::CalculatedParameter,
        "structuralParameter" => Causality::StructuralParameter,
        "input" => Causality::Input,
        "output" => Causality::Output,
        "local" => Causality::Local,
        "independent" => Causality::Independent,
        other => return Err(wrong(element, "causality", other, "a causality")),
    })
}

pub(super) fn variability(element: &str, text: Option<&str>, default: Variability) -> Result<Variability> {
    Ok(match text {
        None => default,
        Some("constant") => Variability::Constant,
        Some("fixed") => Variability::Fixed,
        Some("tunable") => Variability::Tunable,
        Some("discrete") => Variability::Discrete,
        Some("continuous") => Variability::Continuous,
        Some(other) => return Err(wrong(element, "variability", other, "a variability")),
    })
}

fn wrong(element: &str, attribute: &'static str, text: &str, expected: &'static str) -> HostError {
    HostError::Attribute { element: element.to_owned(), attribute, text: text.to_owned(), expected }
}

const ELEMENT: &str = "DefaultExperiment";

/// `DefaultExperiment`, the same in both versions.
#[derive(Deserialize, Default)]
pub(super) struct Experiment {
    #[serde(rename = "@startTime")]
    start_time: Option<String>,
    #[serde(rename = "@stopTime")]
    stop_time: Option<String>,
    #[serde(rename = "@tolerance")]
    tolerance: Option<String>,
    #[serde(rename = "@stepSize")]
    step_size: Option<String>,
}

impl Experiment {
    pub(super) fn read(&self) -> Result<DefaultExperiment> {
        // The schemas' xs:double has NaN and INF, but nothing can be simulated with them.
        let real = |attribute, text: &Option<String>, expected, fits: &dyn Fn(f64) -> bool| {
            let value = optional_real(ELEMENT, attribute, text.as_deref())?;
            let is_refused = |number: f64| !(number.is_finite() && fits(number));
            match (value, text) {
                (Some(number), Some(text)) if is_refused(number) => {
                    Err(wrong(ELEMENT, attribute, text, expected))
                }
                _ => Ok(value),
            }
        };
        let start_time = real("startTime", &self.start_time, "a finite number", &|_| true)?;
        let start = start_time.unwrap_or(0.0);
        let not_before = "a finite number that is not below startTime";
        Ok(DefaultExperiment {
            start_time,
            stop_time: real("stopTime", &self.stop_time, not_before, &|time| time >= start)?,
            tolerance: real("tolerance", &self.tolerance, "a finite number, 0 or greater", &|value| {
                value >= 0.0
            })?,
            step_size: real("stepSize", &self.step_size, "a finite number greater than 0", &|step| {
                step > 0.0
            })?,
        })
    }
}

/// `Item` of an enumeration type, the same in both versions.
#[derive(Deserialize)]
pub(super) struct Item {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@value")]
    value: String,
}

/// The items of the enumeration type called `type_name`.
pub(super) fn items(type_name: &str, items: Vec<Item>) -> Result<Vec<EnumerationItem>> {
    items
        .into_iter()
        .map(|item| {
            let element = format!("the item `{}` of the type `{type_name}`", item.name);
            let value = number(&element, "value", &item.value, "a whole number")?;
            Ok(EnumerationItem { name: item.name, value })
        })
        .collect()
}
