//! Elements that are the same in both standards.

use serde::Serialize;

use super::roles::literal;
use crate::fmi::LOG_CATEGORIES;
use crate::unit::Description;
use crate::unit::quantity::{Enumeration, Quantity, RATIO, UnitOfMeasure};
use crate::unit::variable::Kind;

/// Program that wrote the file.
pub const GENERATION_TOOL: &str = concat!("maglev-fmu ", env!("CARGO_PKG_VERSION"));
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A real number in XML, with all its digits.
pub fn real(value: f64) -> String {
    literal(Kind::Real(&RATIO), value)
}

/// Quantities of a unit's variables, in the order of their first use.
pub fn quantities(description: &Description) -> Vec<&'static Quantity> {
    let mut found: Vec<&'static Quantity> = Vec::new();
    for variable in description.variables {
        if let Kind::Real(quantity) = variable.kind
            && !found.iter().any(|known| std::ptr::eq(*known, quantity))
        {
            found.push(quantity);
        }
    }
    found
}

/// Enumerations of a unit's variables, in the order of their first use.
pub fn enumerations(description: &Description) -> Vec<&'static Enumeration> {
    let mut found: Vec<&'static Enumeration> = Vec::new();
    for variable in description.variables {
        if let Kind::Enumeration(enumeration) = variable.kind
            && !found.iter().any(|known| std::ptr::eq(*known, enumeration))
        {
            found.push(enumeration);
        }
    }
    found
}

#[derive(Serialize)]
pub struct UnitDefinitions {
    #[serde(rename = "Unit")]
    units: Vec<Unit>,
}

#[derive(Serialize)]
struct Unit {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "BaseUnit")]
    base: BaseUnit,
    #[serde(rename = "DisplayUnit", skip_serializing_if = "Option::is_none")]
    display: Option<DisplayUnit>,
}

#[derive(Serialize)]
struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    kilogram: i8,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    metre: i8,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    second: i8,
    #[serde(rename = "@A", skip_serializing_if = "is_zero")]
    ampere: i8,
}

fn is_zero(exponent: &i8) -> bool {
    *exponent == 0
}

#[derive(Serialize)]
struct DisplayUnit {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@factor")]
    factor: String,
}

impl UnitDefinitions {
    pub fn new(description: &Description) -> Self {
        let mut units: Vec<Unit> = Vec::new();
        for quantity in quantities(description) {
            if !units.iter().any(|known| known.name == quantity.unit.name) {
                units.push(Unit::new(quantity.unit));
            }
        }
        Self { units }
    }
}

impl Unit {
    fn new(unit: &UnitOfMeasure) -> Self {
        let [kilogram, metre, second, ampere] = unit.exponents;
        Self {
            name: unit.name,
            base: BaseUnit { kilogram, metre, second, ampere },
            display: unit.display.map(|(name, factor)| DisplayUnit { name, factor: real(factor) }),
        }
    }
}

/// Named item of an enumeration type.
#[derive(Serialize)]
pub struct Item {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@value")]
    value: usize,
    #[serde(rename = "@description")]
    description: &'static str,
}

impl Item {
    /// All items, numbered from 1.
    pub fn all(enumeration: &Enumeration) -> Vec<Self> {
        let numbered = (1..).zip(enumeration.items);
        numbered.map(|(value, &(name, description))| Self { name, value, description }).collect()
    }
}

#[derive(Serialize)]
pub struct LogCategories {
    #[serde(rename = "Category")]
    categories: Vec<Category>,
}

#[derive(Serialize)]
struct Category {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@description")]
    description: &'static str,
}

impl LogCategories {
    pub fn new() -> Self {
        let category = |(name, description): &(&core::ffi::CStr, &'static str)| Category {
            name: name.to_string_lossy().into_owned(),
            description,
        };
        Self { categories: LOG_CATEGORIES.iter().map(category).collect() }
    }
}

#[derive(Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    start_time: String,
    #[serde(rename = "@stopTime")]
    stop_time: String,
    #[serde(rename = "@stepSize")]
    step_size: String,
}

impl DefaultExperiment {
    pub fn new(description: &Description) -> Self {
        Self {
            start_time: real(0.0),
            stop_time: real(description.stop_time),
            step_size: real(description.step_size),
        }
    }
}
