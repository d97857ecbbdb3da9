//! The rig's loop natively and through packaged FMUs of both standards: the same bits.

use maglev_fmu::host::{ControlLoop, ExchangeOrder};
use maglev_fmu::model::NullLogSink;
use maglev_fmu::model::system::RIG;
use maglev_fmu::package::FmiVersion::{self, Three, Two};
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::packages;
use maglev_fmu_test::rig::{
    APPLIED, CURRENT, KALMAN, METRES, NONLINEAR, THROUGH_EXTENDED_STATE, WINDOWED_NEWTON,
};
use maglev_fmu_test::values::get;

/// T \[s\]
const T: f64 = 1e-3;
const STEPS: usize = 4000;

/// Outputs that are compared.
const RECORD: [(&str, &str); 12] = [
    ("plant", "position"),
    ("plant", "velocity"),
    ("plant", "sensor_voltage_measured"),
    ("plant", "acceleration"),
    ("plant", "magnetic_force"),
    ("controller", "voltage"),
    ("controller", "estimate.position"),
    ("controller", "estimate.velocity"),
    ("controller", "estimate.extended"),
    ("controller", "estimate.si.velocity"),
    ("controller", "observer.residual"),
    ("controller", "observer.restarts"),
];

/// One column per record, as bits.
type Columns = Vec<Vec<u64>>;

fn natively(plant: &[(&str, f64)], controller: &[(&str, f64)]) -> Columns {
    let mut rig = closed_loop(&RIG, plant, controller);
    let mut columns = vec![Vec::new(); RECORD.len()];
    for _ in 0..STEPS {
        rig.step_controller().unwrap();
        rig.actuate();
        rig.plant.continuous().expect("a plant").evaluate();
        for ((model, name), column) in RECORD.iter().zip(&mut columns) {
            let value = if *model == "plant" { get(&*rig.plant, name) } else { get(&*rig.controller, name) };
            column.push(value.to_bits());
        }
        rig.plant.advance(T, &mut NullLogSink).unwrap();
    }
    columns
}

fn through_fmus(
    (plant, plant_values): (FmiVersion, &[(&str, f64)]),
    (controller, controller_values): (FmiVersion, &[(&str, f64)]),
) -> Columns {
    let mut rig = ControlLoop::connect(
        packages::instantiate(controller, "MaglevRigController", controller_values),
        packages::instantiate(plant, "MaglevRigPlant", plant_values),
        ExchangeOrder::ControllerFirst,
        RIG.sensing,
        RIG.actuation,
    )
    .unwrap();
    rig.record(&RECORD).unwrap();
    rig.initialise(0.0, Some(STEPS as f64 * T), T).unwrap();
    let trace = rig.run(STEPS).unwrap();
    trace.columns.iter().map(|column| column.iter().map(|value| value.to_bits()).collect()).collect()
}

fn assert_same_bits(plant: &[(&str, f64)], controller: &[(&str, f64)]) {
    let native = natively(plant, controller);
    for versions in [(Two, Two), (Three, Three), (Two, Three), (Three, Two)] {
        let trajectories = through_fmus((versions.0, plant), (versions.1, controller));
        for ((name, column), expected) in RECORD.iter().zip(&trajectories).zip(&native) {
            let first = column.iter().zip(expected).position(|(got, expected)| got != expected);
            assert_eq!(first, None, "{name:?}, plant and controller {versions:?}");
            assert_eq!(column.len(), STEPS);
        }
    }
    // There is something to compare: no column but the count stands still.
    for ((_, name), column) in RECORD.iter().zip(&native) {
        let distinct: std::collections::HashSet<_> = column.iter().collect();
        assert!(distinct.len() > 100 || *name == "observer.restarts", "{name}: {}", distinct.len());
    }
}

/// A ball off its set point, noise and a coarse sensor.
const DISTURBED: [(&str, f64); 4] =
    [("initial.position", 0.012), ("sensor.noise", 1e-3), ("sensor.resolution", 1e-4), ("sensor.seed", 7.0)];

#[test]
fn pid_with_the_linear_observer_gives_the_same_bits() {
    assert_same_bits(&DISTURBED, &[]);
}

#[test]
fn pid_with_the_nonlinear_observer_gives_the_same_bits() {
    // Exponents that need exp and log.
    assert_same_bits(
        &DISTURBED,
        &[
            ("observer.kind", NONLINEAR),
            ("observer.measurement", METRES),
            ("observer.form", CURRENT),
            ("observer.exponent[2]", 0.7),
            ("observer.linear_zone[2]", 1e-5),
        ],
    );
}

#[test]
fn loop_through_the_extended_state_gives_the_same_bits() {
    let controller = [
        &THROUGH_EXTENDED_STATE[..],
        &[("observer.voltage_source", APPLIED), ("controller.reference_filter", 20.0)],
    ]
    .concat();
    assert_same_bits(&DISTURBED, &controller);
}

#[test]
fn loop_through_a_model_based_observer_gives_the_same_bits() {
    for kind in [KALMAN, WINDOWED_NEWTON] {
        let controller = [&THROUGH_EXTENDED_STATE[..], &[("observer.kind", kind)]].concat();
        assert_same_bits(&DISTURBED, &controller);
    }
}

/// The ball is a fifth heavier than the controller believes and is caught off its set point.
#[test]
fn model_based_observers_hold_the_ball_through_fmus() {
    let plant = [("initial.position", 0.0095), ("sensor.noise", 1e-3), ("mass", 0.024)];
    for (version, kind) in [Two, Three].into_iter().flat_map(|v| [(v, KALMAN), (v, WINDOWED_NEWTON)]) {
        let controller = [&THROUGH_EXTENDED_STATE[..], &[("observer.kind", kind)]].concat();
        let columns = through_fmus((version, &plant), (version, &controller));
        let column = |name: &str| {
            let place = RECORD.iter().position(|(_, recorded)| *recorded == name).unwrap();
            columns[place].iter().map(|bits| f64::from_bits(*bits)).collect::<Vec<_>>()
        };
        let largest = |values: Vec<f64>| values.into_iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let off: Vec<f64> = column("position")[1000..].iter().map(|position| position - 9e-3).collect();
        let (velocity, estimate) = (column("velocity"), column("estimate.si.velocity"));
        let errors: Vec<f64> =
            velocity[1000..].iter().zip(&estimate[1000..]).map(|(v, estimate)| v - estimate).collect();
        let (off, error) = (largest(off), largest(errors));
        println!("{version:?} {kind}: {off} m off, velocity within {error} m/s");
        assert!(off < 1e-4 && error < 1e-2, "{version:?} {kind}: {off} m off, velocity within {error} m/s");
        assert_eq!(largest(column("observer.restarts")), 0.0);
    }
}
