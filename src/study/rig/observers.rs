//! The paper's two observers as parameters of the controller model.

use super::simulation::Measurement;
use crate::host::Value;
use crate::study::loop_packages::Parameter;

/// Names for tables and legends, in the order of [`KINDS`].
pub const NAMES: [&str; 2] = ["LESO", "NESO"];
/// b of Tables 3 and 4.
pub const PRINTED_INPUT_GAIN: f64 = 1.0;

/// Items of `observer.kind`: LESO of Table 3 and NESO of Table 4, which are the model's start values.
pub const KINDS: [Parameter<'static>; 2] =
    [("observer.kind", Value::Text("linear")), ("observer.kind", Value::Text("nonlinear"))];

/// How Table 5's simulation row comes about: one Runge-Kutta step per sample, the measurement between two samples on a
/// straight line.
pub fn interpolating(measurement: Measurement, start: &'static str) -> Vec<Parameter<'static>> {
    vec![
        ("observer.measurement", measurement_item(measurement)),
        ("observer.initial", Value::Text(start)),
        ("observer.discretisation", Value::Text("runge_kutta")),
        ("observer.form", Value::Text("current")),
    ]
}

/// As a sampled observer runs: the measurement held; LESO exact, NESO in 20 Runge-Kutta steps per sample.
pub fn holding(measurement: Measurement, start: &'static str) -> Vec<Parameter<'static>> {
    vec![
        ("observer.measurement", measurement_item(measurement)),
        ("observer.initial", Value::Text(start)),
        ("observer.substeps", Value::Integer(20)),
    ]
}

fn measurement_item(measurement: Measurement) -> Value<'static> {
    Value::Text(match measurement {
        Measurement::Metres => "metres",
        Measurement::Volts => "volts",
    })
}
