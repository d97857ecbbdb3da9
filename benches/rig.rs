//! Time of one step of the rig's models through the C ABI, as an importer pays for it: set two inputs, `doStep`, get four
//! outputs, on the signals of a PID loop with a millivolt of noise and a moving reference. Beside it the observers
//! alone, which is what a tuning loop pays per sample.

mod measure;

use std::hint::black_box;

use maglev_fmu::model::system::RIG;
use maglev_fmu::model::{ClosedLoop, ExchangeOrder, MaglevRigController, MaglevRigPlant};
use maglev_fmu::observer::extended_state::{
    ExtendedState, ExtendedStateModel, Injection, LinearInjection, NonlinearInjection, gains_from_bandwidth,
};
use maglev_fmu::observer::extended_state_exact::ExactPredictor;
use maglev_fmu_test::component::Component;
use maglev_fmu_test::values::{get, set};
use measure::{Candidate, medians, verdict};

const T: f64 = 1e-3;
const STEPS: usize = 10_000;
const ROUNDS: usize = 51;

/// Inputs of the controller, sensor voltage and reference [V], and of the plant, voltage [V] and force [N].
#[derive(Default)]
struct Recording {
    controller: Vec<[f64; 2]>,
    plant: Vec<[f64; 2]>,
}

fn record() -> Recording {
    let mut models = ClosedLoop::of(&RIG, ExchangeOrder::ControllerFirst);
    set(&mut *models.plant, "sensor.noise", 1e-3);
    models.start(0.0).expect("start values");
    models.step_size = T;
    let mut recording = Recording::default();
    for k in 0..STEPS {
        let reading = get(&*models.plant, "sensor_voltage_measured");
        let target = -1.50868 + 0.15 * (core::f64::consts::PI * T * k as f64).sin();
        set(&mut *models.controller, "reference", target);
        models.step().expect("a step");
        recording.controller.push([reading, target]);
        recording.plant.push([get(&*models.controller, "voltage"), 0.0]);
    }
    recording
}

fn controller(parameters: &[(&str, f64)]) -> Component<2> {
    let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.extended"];
    Component::new(MaglevRigController::new(), ["sensor_voltage", "reference"], outputs, parameters)
}

fn plant(parameters: &[(&str, f64)]) -> Component<2> {
    let outputs = ["sensor_voltage_measured", "voltage_measured", "position", "velocity"];
    Component::new(MaglevRigPlant::new(), ["voltage", "force"], outputs, parameters)
}

/// One Runge-Kutta step per sample with the measurement a straight line, as a tuning loop makes it.
fn observe(injection: impl Injection, inputs: &[[f64; 2]]) {
    let model = ExtendedStateModel { injection: black_box(injection), input_gain: black_box(1.0) };
    let mut z = ExtendedState::default();
    for pair in inputs.windows(2) {
        let (start, end) = (pair[0][0], pair[1][0]);
        z = model.runge_kutta_step(z, [start, 0.5 * (start + end), end], 0.76, T);
    }
    black_box(z);
}

fn observe_exactly(inputs: &[[f64; 2]]) {
    let predictor = black_box(ExactPredictor::new(gains_from_bandwidth(100.0), 1.0, T));
    let z = inputs.iter().fold(ExtendedState::default(), |z, input| predictor.step(z, input[0], 0.76));
    black_box(z);
}

fn main() {
    let Recording { controller: readings, plant: voltages } = record();
    let nothing = vec![[0.0; 2]; STEPS];
    let nonlinear = |exponents| NonlinearInjection::new(gains_from_bandwidth(100.0), exponents, [0.01; 3]);
    let (kind, discretisation) = (("observer.kind", 2.0), "observer.discretisation");
    let through_extended_state =
        [("controller.kind", 2.0), ("observer.input_gain", -3705.0), ("observer.bandwidth", 300.0)];
    let models = [
        ("linear, exact, PID", controller(&[]), &readings),
        ("linear, exact, disturbance rejection", controller(&through_extended_state), &readings),
        ("linear, Runge-Kutta", controller(&[(discretisation, 2.0)]), &readings),
        ("nonlinear, Runge-Kutta", controller(&[kind]), &readings),
        (
            "nonlinear, Runge-Kutta, exponents 0.9, 0.6, 0.3",
            controller(&[
                kind,
                ("observer.exponent[1]", 0.9),
                ("observer.exponent[2]", 0.6),
                ("observer.exponent[3]", 0.3),
                ("observer.linear_zone[1]", 1e-4),
                ("observer.linear_zone[2]", 1e-4),
                ("observer.linear_zone[3]", 1e-4),
            ]),
            &readings,
        ),
        ("nonlinear, exact (frozen gains)", controller(&[kind, (discretisation, 1.0)]), &readings),
        ("kalman", controller(&[("observer.kind", 3.0)]), &readings),
        (
            "windowed Newton, 12 samples",
            controller(&[("observer.kind", 4.0), ("observer.window", 12.0)]),
            &readings,
        ),
        ("plant", plant(&[]), &voltages),
        ("plant at rest on its lower stop", plant(&[("initial.position", 25e-3)]), &nothing),
    ];
    let mut candidates: Vec<Candidate> = models
        .into_iter()
        .map(|(name, mut component, inputs)| Candidate {
            name,
            operations: STEPS,
            run: Box::new(move || component.play(inputs, T)),
        })
        .collect();
    let inputs = &readings;
    let alone = |name, run| Candidate { name, operations: STEPS, run };
    candidates.extend([
        alone("observer alone: linear, exact", Box::new(|| observe_exactly(inputs))),
        alone(
            "observer alone: linear, Runge-Kutta",
            Box::new(|| observe(LinearInjection::from_bandwidth(100.0), inputs)),
        ),
        alone(
            "observer alone: nonlinear, Runge-Kutta, printed exponents",
            Box::new(|| observe(nonlinear([1.0, 0.5, 0.25]), inputs)),
        ),
        alone(
            "observer alone: nonlinear, Runge-Kutta, exponents 0.9, 0.6, 0.3",
            Box::new(|| observe(nonlinear([0.9, 0.6, 0.3]), inputs)),
        ),
    ]);
    let medians = medians(&mut candidates, ROUNDS);
    println!("Step through the C ABI (set two inputs, doStep, get four outputs), medians");
    for (candidate, median) in candidates.iter().zip(&medians) {
        verdict(candidate.name, *median, "ns", None, None);
    }
    println!("Targets");
    verdict("linear, exact, PID", medians[0], "ns", Some(80.0), None);
    verdict("linear, exact, disturbance rejection", medians[1], "ns", Some(80.0), None);
    verdict("nonlinear, Runge-Kutta", medians[3], "ns", Some(300.0), None);
    verdict("observer alone: linear, Runge-Kutta", medians[11], "ns", Some(50.0), None);
    verdict("kalman", medians[6], "ns", Some(150.0), None);
    verdict("windowed Newton, 12 samples", medians[7], "ns", Some(3000.0), None);
    verdict("plant at rest, against the plant in flight", medians[9] / medians[8], "x", Some(0.5), None);
}
