//! The bearing loop natively and through packaged FMUs of both standards: the same bits.

use maglev_fmu::host::{ControlLoop, ExchangeOrder};
use maglev_fmu::model::system::BEARING;
use maglev_fmu::package::FmiVersion::{self, Three, Two};
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::packages;
use maglev_fmu_test::values::get;

const STEP_SIZE: f64 = 1e-3;
const STEPS: usize = 10_000;
const PLANT: &str = "MagneticBearingPlant";
const CONTROLLER: &str = "MagneticBearingController";

/// Outputs that are compared.
const RECORD: [(&str, &str); 12] = [
    ("plant", "position"),
    ("plant", "velocity"),
    ("plant", "flux"),
    ("plant", "position_measured"),
    ("plant", "acceleration"),
    ("controller", "voltage"),
    ("controller", "estimate.position"),
    ("controller", "estimate.velocity"),
    ("controller", "estimate.flux"),
    ("controller", "observer.residual"),
    ("controller", "observer.iterations"),
    ("controller", "observer.converged"),
];

/// Parameters of plant and controller.
struct Scenario {
    plant: &'static [(&'static str, f64)],
    controller: &'static [(&'static str, f64)],
}

const LAW_A: Scenario = Scenario {
    plant: &[("initial.position", 0.01)],
    controller: &[("controller.law", 1.0), ("observer.max_iterations", 10.0)],
};

/// Everything that the first scenario leaves off.
const NOISY: Scenario = Scenario {
    plant: &[
        ("initial.position", 0.001),
        ("bias_flux", 1e-4),
        ("sensor.noise", 1e-9),
        ("sensor.resolution", 1e-10),
        ("sensor.seed", 7.0),
        ("process.flux_noise", 1e-6),
        ("map", 2.0),
    ],
    controller: &[
        ("bias_flux", 1e-4),
        ("controller.law", 2.0),
        ("controller.feedback", 2.0),
        ("observer.step_size", 0.5),
        ("observer.map", 1.0),
        ("observer.voltage_source", 2.0),
    ],
};

/// One column per record, as bits.
type Columns = Vec<Vec<u64>>;

fn natively(scenario: &Scenario) -> Columns {
    let mut bearing = closed_loop(&BEARING, scenario.plant, scenario.controller);
    let mut columns = vec![Vec::new(); RECORD.len()];
    for _ in 0..STEPS {
        bearing.step_controller().unwrap();
        for ((model, name), column) in RECORD.iter().zip(&mut columns) {
            let value =
                if *model == "plant" { get(&*bearing.plant, name) } else { get(&*bearing.controller, name) };
            column.push(value.to_bits());
        }
        bearing.step_plant().unwrap();
    }
    columns
}

fn through_fmus(scenario: &Scenario, plant: FmiVersion, controller: FmiVersion) -> Columns {
    let mut bearing = ControlLoop::connect(
        packages::instantiate(controller, CONTROLLER, scenario.controller),
        packages::instantiate(plant, PLANT, scenario.plant),
        ExchangeOrder::ControllerFirst,
        &[
            ("position_measured", "position"),
            ("velocity", "state.velocity"),
            ("flux", "state.flux"),
            ("voltage_measured", "voltage_applied"),
        ],
        &[("voltage", "voltage")],
    )
    .unwrap();
    bearing.record(&RECORD).unwrap();
    bearing.initialise(0.0, Some(STEPS as f64 * STEP_SIZE), STEP_SIZE).unwrap();
    let trace = bearing.run(STEPS).unwrap();
    trace.columns.iter().map(|column| column.iter().map(|value| value.to_bits()).collect()).collect()
}

fn assert_same_bits(scenario: &Scenario) {
    let native = natively(scenario);
    for (plant, controller) in [(Two, Two), (Three, Three), (Two, Three), (Three, Two)] {
        let trajectories = through_fmus(scenario, plant, controller);
        for ((name, column), expected) in RECORD.iter().zip(&trajectories).zip(&native) {
            let first = column.iter().zip(expected).position(|(got, expected)| got != expected);
            assert_eq!(first, None, "{name:?}, plant {plant:?}, controller {controller:?}");
            assert_eq!(column.len(), STEPS);
        }
    }
    // There is something to compare: no column but the flags stands still.
    for ((_, name), column) in RECORD.iter().zip(&native) {
        let distinct: std::collections::HashSet<_> = column.iter().collect();
        println!("{name}: {} values", distinct.len());
        assert!(distinct.len() > 1000 || name.starts_with("observer."), "{name}");
    }
}

#[test]
fn law_a_gives_the_same_bits_natively_and_in_both_standards() {
    assert_same_bits(&LAW_A);
}

#[test]
fn noise_bias_and_options_give_the_same_bits_natively_and_in_both_standards() {
    assert_same_bits(&NOISY);
}
