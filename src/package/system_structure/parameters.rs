//! Parameter sets (`*.ssv`; SSP 1.0.1 and 2.0, section 6): all numbers and truth values that may be changed, at their start
//! values.
//!
//! Enumerations are left out: of the importers at hand one ends the process and two fail on a set that has any.

use serde::Serialize;

use super::description::Units;
use super::{COMMON, PARAMETER_VALUES, SystemForm};
use crate::package::model_description::{GENERATION_TOOL, real};
use crate::package::{GenerationTime, licenses};
use crate::unit::system::System;
use crate::unit::variable::{Causality, Kind, Variable};
use crate::unit::{Description, StartValues};

#[derive(Serialize)]
pub struct ParameterSet {
    #[serde(rename = "@xmlns:ssv")]
    values_namespace: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    common_namespace: &'static str,
    #[serde(rename = "@version")]
    version: &'static str,
    /// The same for both units: importers apply sets of one name together.
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@description")]
    description: String,
    #[serde(rename = "@copyright")]
    copyright: &'static str,
    #[serde(rename = "@license")]
    license: &'static str,
    #[serde(rename = "@generationTool")]
    generation_tool: &'static str,
    #[serde(rename = "@generationDateAndTime")]
    generation_time: String,
    #[serde(rename = "ssv:Parameters")]
    parameters: Parameters,
    #[serde(rename = "ssv:Units")]
    units: Units,
}

#[derive(Serialize)]
struct Parameters {
    #[serde(rename = "ssv:Parameter")]
    parameters: Vec<Parameter>,
}

#[derive(Serialize)]
struct Parameter {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "$value")]
    value: Value,
}

#[derive(Serialize)]
enum Value {
    #[serde(rename = "ssv:Real")]
    Real {
        #[serde(rename = "@value")]
        value: String,
        #[serde(rename = "@unit")]
        unit: &'static str,
    },
    #[serde(rename = "ssv:Float64")]
    Float64 {
        #[serde(rename = "@value")]
        value: String,
        #[serde(rename = "@unit")]
        unit: &'static str,
    },
    #[serde(rename = "ssv:Integer")]
    Integer {
        #[serde(rename = "@value")]
        value: i32,
    },
    #[serde(rename = "ssv:Int32")]
    Int32 {
        #[serde(rename = "@value")]
        value: i32,
    },
    #[serde(rename = "ssv:Boolean")]
    Boolean {
        #[serde(rename = "@value")]
        value: bool,
    },
}

impl ParameterSet {
    pub fn new(
        system: &System,
        description: &'static Description,
        start_values: &StartValues,
        form: SystemForm,
        time: GenerationTime,
    ) -> Self {
        let parameters = || description.variables.iter().filter(|row| row.causality == Causality::Parameter);
        let values =
            description.variables.iter().enumerate().filter(|(_, row)| row.causality == Causality::Parameter);
        let values = values
            .filter_map(|(reference, row)| Parameter::new(row, start_values.of(reference, row), form))
            .collect();
        Self {
            values_namespace: PARAMETER_VALUES,
            common_namespace: COMMON,
            version: form.version(),
            name: system.name,
            description: format!("Parameters of {} at their start values", description.name),
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.to_string(),
            parameters: Parameters { parameters: values },
            units: Units::of(parameters()),
        }
    }
}

impl Parameter {
    fn new(variable: &'static Variable, start: f64, form: SystemForm) -> Option<Self> {
        let value = match (variable.kind, form) {
            (Kind::Real(quantity), SystemForm::Closed | SystemForm::Driven) => {
                Value::Real { value: real(start), unit: quantity.unit.name }
            }
            (Kind::Real(quantity), SystemForm::Two) => {
                Value::Float64 { value: real(start), unit: quantity.unit.name }
            }
            (Kind::Integer, SystemForm::Closed | SystemForm::Driven) => {
                Value::Integer { value: start as i32 }
            }
            (Kind::Integer, SystemForm::Two) => Value::Int32 { value: start as i32 },
            (Kind::Boolean, _) => Value::Boolean { value: start != 0.0 },
            _ => return None,
        };
        Some(Self { name: variable.name, description: variable.description, value })
    }
}
