//! What the longest step that each model accepts really costs: the models' own account says about a second.

use std::time::Instant;

use maglev_fmu::model::{MODELS, ModelError, NullLogSink};

/// Models with parameters that make their steps expensive, each in its own way.
const CANDIDATES: &[(&str, &[(&str, f64)])] = &[
    ("LevitatedBallPlant", &[]),
    ("LevitatedBallPlant", &[("resistance", 1e4), ("inductance_constant", 1e-9), ("lower_stop", 0.0)]),
    ("LevitatedBallPlant", &[("sensor.sample_time", 1e-6), ("sensor.noise", 1e-3)]),
    ("MaglevRigPlant", &[]),
    ("MagneticBearingPlant", &[("sensor.sample_time", 1e-6), ("sensor.noise", 1e-3)]),
    ("LevitatedBallController", &[]),
    ("LevitatedBallController", &[("sample_time", 1.0)]),
    ("LevitatedBallController", &[("observer.kind", 3.0), ("sample_time", 1e-2)]),
    ("MaglevRigController", &[]),
    ("MaglevRigController", &[("observer.kind", 2.0), ("observer.discretisation", 1.0)]),
    (
        "MaglevRigController",
        &[("observer.kind", 2.0), ("observer.discretisation", 1.0), ("observer.form", 2.0)],
    ),
    (
        "MaglevRigController",
        &[("observer.kind", 2.0), ("observer.exponent[1]", 0.7), ("observer.substeps", 100.0)],
    ),
    ("MagneticBearingController", &[]),
    ("MagneticBearingController", &[("observer.max_iterations", 1000.0), ("observer.step_size", 1e-3)]),
    ("MagneticBearingController", &[("observer.kind", 2.0), ("observer.max_iterations", 1000.0)]),
    (
        "MagneticBearingController",
        &[("observer.kind", 3.0), ("observer.max_iterations", 1000.0), ("observer.step_size", 1e-3)],
    ),
    ("MagneticBearingController", &[("observer.kind", 4.0)]),
    (
        "MagneticBearingController",
        &[("observer.window", 64.0), ("observer.max_iterations", 100.0), ("observer.step_size", 1e-3)],
    ),
    (
        "MagneticBearingController",
        &[
            ("observer.window", 64.0),
            ("observer.max_iterations", 100.0),
            ("observer.line_search", 1.0),
            ("observer.step_size", 1e-3),
        ],
    ),
    (
        "MagneticBearingController",
        &[("observer.max_iterations", 100.0), ("observer.line_search", 1.0), ("observer.step_size", 1e-3)],
    ),
];

fn main() {
    println!("The longest step that is accepted");
    for (name, parameters) in CANDIDATES {
        let kind = MODELS.iter().find(|model| model.description.name == *name).expect("a model");
        let mut model = (kind.create)();
        let row = |variable: &str| kind.description.find(variable).expect("a variable").0;
        for (variable, value) in *parameters {
            model.values_mut()[row(variable)] = *value;
        }
        // What the observers see never fits their models, so that they iterate as long as they may.
        model.initialise(0.0).expect("start values");
        if let Some((sensed, _)) = ["position", "current", "sensor_voltage"]
            .into_iter()
            .filter_map(|input| kind.description.find(input))
            .find(|(_, variable)| !variable.is_calculated())
        {
            for k in 0..8 {
                model.values_mut()[sensed] += 1e-3 * f64::from(k % 3);
                let sample_time = model.values()[row("sample_time")];
                model.advance(sample_time, &mut NullLogSink).expect("a step");
            }
        }
        let Err(ModelError::StepTooLong { limit, .. }) = model.advance(1e15, &mut NullLogSink) else {
            unreachable!("no model here takes such a step")
        };
        let begin = Instant::now();
        model.advance(limit, &mut NullLogSink).expect("the longest step");
        let (seconds, target) = (begin.elapsed().as_secs_f64(), 1.5);
        let word = if seconds <= target { "met" } else { "MISSED" };
        println!("{seconds:>6.2} s, target <= {target} s {word}: {limit:.3e} s of {name} {parameters:?}");
    }
}
