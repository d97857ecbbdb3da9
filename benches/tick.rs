//! Cost of one step through the C ABI: set the input, step, get the outputs; for every observer of the controller, and
//! for the plant.
//!
//! Baselines in the same run: a model that does nothing behind the same boundary, and the paper's algorithm taken
//! literally (general 3x3 solve, always d iterations) inside the same model.
//!
//! The positions are those of a noise-free loop, and for the observers that are made for noise, and once for the
//! Newton observer, the same with 1e-7 m of noise, which the Newton observers have to iterate for.

mod measure;

use maglev_fmu::controller::bearing_feedback::{self, Gains, Law};
use maglev_fmu::model::sample_clock::SampleClock;
use maglev_fmu::model::system::BEARING;
use maglev_fmu::model::{
    ClosedLoop, Description, ExchangeOrder, LogSink, MagneticBearingController, MagneticBearingPlant, Model,
    ModelError,
};
use maglev_fmu::plant::magnetic_bearing::State;
use maglev_fmu::signal::GaussianNoise;
use maglev_fmu_test::component::{Component, reference};
use maglev_fmu_test::printed_newton;
use maglev_fmu_test::values::get;
use measure::{Candidate, medians, verdict};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

const T: f64 = 1e-3;
const STEPS: usize = 10_000;
const ROUNDS: usize = 51;

/// Standard deviation of the noisy positions [m].
const NOISE: f64 = 1e-7;

/// What a loop with law (8a), x1(0) = 0.01 m, u(0) = -150 V, shows of itself.
#[derive(Default)]
struct Recording {
    /// [m]
    positions: Vec<[f64; 1]>,
    noisy_positions: Vec<[f64; 1]>,
    /// [V]
    voltages: Vec<[f64; 1]>,
}

fn record() -> Recording {
    let mut models = ClosedLoop::of(&BEARING, ExchangeOrder::ControllerFirst);
    models.start(0.0).expect("start values");
    models.step_size = T;
    let mut noise = GaussianNoise::new(1, 0);
    let mut recording = Recording::default();
    for _ in 0..STEPS {
        let position = get(&*models.plant, "position");
        models.step().expect("a step");
        recording.positions.push([position]);
        recording.noisy_positions.push([position + NOISE * noise.sample()]);
        recording.voltages.push([get(&*models.controller, "voltage")]);
    }
    recording
}

/// The controller's table with another behaviour behind it.
#[derive(Clone, Serialize, Deserialize)]
struct Baseline {
    controller: MagneticBearingController,
    clock: SampleClock,
    /// d of the literal algorithm; 0 does nothing but tick.
    iterations: u32,
    outputs: [f64; 3],
    voltages: [f64; 2],
    guess: Vector3<f64>,
    references: [u32; 5],
}

impl Baseline {
    fn new(iterations: u32) -> Self {
        let controller = MagneticBearingController::new();
        let names = ["position", "voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
        Self {
            references: names.map(|name| reference(&controller, name)),
            controller,
            clock: SampleClock::new(T, 0.0),
            iterations,
            outputs: [0.0; 3],
            voltages: [0.0; 2],
            guess: Vector3::new(0.0, 0.0, 1e-9),
        }
    }

    fn tick(&mut self) {
        let [position, voltage, outputs @ ..] = self.references.map(|reference| reference as usize);
        let values = self.controller.values_mut();
        self.outputs = [self.outputs[1], self.outputs[2], values[position]];
        self.voltages = [self.voltages[1], values[voltage]];
        if let Some(w) =
            printed_newton::invert(self.outputs, self.voltages, self.guess, self.iterations, 1.0, 0.0, T)
        {
            self.guess = printed_newton::printed_map(w, self.voltages[0], 0.0, T);
        }
        let estimate = printed_newton::printed_map(self.guess, self.voltages[1], 0.0, T);
        let state = State { position: estimate[0], velocity: estimate[1], flux: estimate[2] };
        let gains = Gains { position: 0.92, velocity: 9.94 };
        values[voltage] = bearing_feedback::voltage(Law::A, gains, state).clamp(-150.0, 150.0);
        outputs.into_iter().zip(estimate.iter()).for_each(|(output, value)| values[output] = *value);
    }
}

impl Model for Baseline {
    fn description(&self) -> &'static Description {
        self.controller.description()
    }
    fn values(&self) -> &[f64] {
        self.controller.values()
    }
    fn values_mut(&mut self) -> &mut [f64] {
        self.controller.values_mut()
    }
    fn apply_tunable_parameters(&mut self) {}
    fn initialise(&mut self, start_time: f64) -> Result<(), ModelError> {
        self.clock = SampleClock::new(T, start_time);
        Ok(())
    }
    fn check_step(&self, _: f64) -> Result<(), ModelError> {
        Ok(())
    }

    fn advance(&mut self, duration: f64, _: &mut dyn LogSink) -> Result<(), ModelError> {
        for _ in self.clock.advance(duration) {
            if self.iterations > 0 {
                self.tick();
            }
        }
        Ok(())
    }
}

/// A controller, or what passes for one, with some values.
fn controller(model: impl Model + 'static, values: &[(&str, f64)]) -> Component<1> {
    let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
    Component::new(model, ["position"], outputs, values)
}

fn plant() -> Component<1> {
    let outputs = ["position_measured", "voltage_measured", "velocity", "flux"];
    Component::new(MagneticBearingPlant::new(), ["voltage"], outputs, &[])
}

fn main() {
    let Recording { positions, noisy_positions, voltages } = record();
    let shipped = |values: &[(&str, f64)]| controller(MagneticBearingController::new(), values);
    let literal = |iterations| controller(Baseline::new(iterations), &[]);
    let (exact, kind) = (("observer.map", 1.0), "observer.kind");
    let candidates = [
        ("empty model", literal(0), &positions),
        ("newton, d = 10", shipped(&[]), &positions),
        ("newton, d = 100", shipped(&[("observer.max_iterations", 100.0)]), &positions),
        ("literal algorithm, d = 10", literal(10), &positions),
        ("literal algorithm, d = 100", literal(100), &positions),
        ("newton, exact map", shipped(&[exact]), &positions),
        ("newton, exact map, noise", shipped(&[exact]), &noisy_positions),
        ("reduced_newton", shipped(&[(kind, 2.0)]), &positions),
        ("reduced_newton_compensated", shipped(&[(kind, 3.0)]), &positions),
        ("kalman", shipped(&[(kind, 4.0)]), &noisy_positions),
        ("newton, exact map, N = 30, noise", shipped(&[exact, ("observer.window", 30.0)]), &noisy_positions),
        ("plant", plant(), &voltages),
    ];
    let mut candidates = candidates.map(|(name, mut component, inputs)| Candidate {
        name,
        operations: STEPS,
        run: Box::new(move || component.play(inputs, T)),
    });
    let medians = medians(&mut candidates, ROUNDS);
    println!("Step through the C ABI (set one input, doStep, get four outputs), medians");
    for (candidate, median) in candidates.iter().zip(&medians) {
        verdict(candidate.name, *median, "ns", None, None);
    }
    let [empty, newton_10, newton_100, literal_10, literal_100, exact, .., kalman, window, plant] =
        medians[..]
    else {
        unreachable!()
    };
    println!("Targets");
    verdict("newton, d = 10", newton_10, "ns", Some(150.0), None);
    verdict("newton, d = 10, against the empty model", newton_10 / empty, "x", Some(3.0), None);
    verdict("literal against shipped, d = 10", literal_10 / newton_10, "x", None, Some(5.0));
    verdict("literal against shipped, d = 100", literal_100 / newton_100, "x", None, Some(30.0));
    verdict("newton, exact map", exact, "ns", Some(150.0), None);
    verdict("kalman", kalman, "ns", Some(200.0), None);
    verdict("window of 30 samples", window, "ns", Some(5000.0), None);
    verdict("plant, against the empty model", plant / empty, "x", Some(3.0), None);
}
