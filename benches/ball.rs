//! Cost of one step of the levitated ball's models through the C ABI: set the input, step, get the outputs.
//!
//! The currents are those of a loop on the sinusoids, whose reference the controller gets, too.

mod measure;

use maglev_fmu::model::system::BALL;
use maglev_fmu::model::{ClosedLoop, ExchangeOrder, LevitatedBallController, LevitatedBallPlant};
use maglev_fmu::study::ball::BallReference;
use maglev_fmu_test::component::Component;
use maglev_fmu_test::values::{get, set};
use measure::{Candidate, medians, verdict};

const T: f64 = 1e-4;
const STEPS: usize = 10_000;
const ROUNDS: usize = 31;

/// What a loop shows of itself: current and reference, and the voltage with no force.
#[derive(Default)]
struct Recording {
    sensed: Vec<[f64; 2]>,
    actuated: Vec<[f64; 2]>,
}

fn record() -> Recording {
    let mut models = ClosedLoop::of(&BALL, ExchangeOrder::ControllerFirst);
    models.start(0.0).expect("start values");
    models.step_size = T;
    let mut recording = Recording::default();
    for step in 0..STEPS {
        let sensed = [get(&*models.plant, "current"), BallReference::Sinusoids.at(T * step as f64)];
        set(&mut *models.controller, "reference", sensed[1]);
        models.step().expect("a step");
        recording.sensed.push(sensed);
        recording.actuated.push([get(&*models.controller, "voltage"), 0.0]);
    }
    recording
}

/// The controller with some values.
fn controller(values: &[(&str, f64)]) -> Component<2> {
    let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
    Component::new(LevitatedBallController::new(), ["current", "reference"], outputs, values)
}

fn plant(values: &[(&str, f64)]) -> Component<2> {
    let outputs = ["current_measured", "voltage_measured", "position", "flux"];
    Component::new(LevitatedBallPlant::new(), ["voltage", "force"], outputs, values)
}

fn main() {
    let recording = record();
    let (sensed, actuated) = (&recording.sensed, &recording.actuated);
    let kind = |kind: f64| [("observer.kind", kind)];
    let candidates = [
        ("controller, drem", controller(&[]), sensed, Some(500.0)),
        ("controller, polynomial_newton", controller(&kind(2.0)), sensed, Some(400.0)),
        ("controller, polynomial_newton_adaptive", controller(&kind(3.0)), sensed, Some(400.0)),
        ("plant, 0.1 ms", plant(&[]), actuated, Some(300.0)),
        ("plant, 0.1 ms, noisy sensor", plant(&[("sensor.noise", 1e-3)]), actuated, None),
    ];
    let targets = candidates.iter().map(|candidate| candidate.3).collect::<Vec<_>>();
    let mut candidates = candidates.map(|(name, mut component, inputs, _)| Candidate {
        name,
        operations: STEPS,
        run: Box::new(move || component.play(inputs, T)),
    });
    let medians = medians(&mut candidates, ROUNDS);
    println!("Step through the C ABI (set two inputs, doStep, get four outputs), medians");
    for ((candidate, median), target) in candidates.iter().zip(&medians).zip(targets) {
        verdict(candidate.name, *median, "ns", target, None);
    }
}
