//! Cost of one step through the C ABI: set the input, step, get the outputs; for every observer of the controller, and
//! for the plant.
//!
//! Baselines in the same run: a unit that does nothing behind the same boundary, and the paper's algorithm taken
//! literally (general 3x3 solve, always d iterations) inside the same unit.
//!
//! The positions are those of a noise-free loop, and for the observers that are made for noise, and once for the
//! Newton observer, the same with 1e-7 m of noise, which the Newton observers have to iterate for.

#[path = "../tests/literal/mod.rs"]
mod literal;
mod measure;

use core::ffi::c_void;
use std::hint::black_box;

use maglev_fmu::controller::bearing_feedback::{self, Gains, Law};
use maglev_fmu::fmi::fmi2::{
    fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2FreeInstance, fmi2GetReal,
    fmi2Reset, fmi2SetReal,
};
use maglev_fmu::fmi::{Callback, Instance, Interface, Logger};
use maglev_fmu::plant::magnetic_bearing::State;
use maglev_fmu::signal::GaussianNoise;
use maglev_fmu::unit::sample_clock::SampleClock;
use maglev_fmu::unit::{
    Description, Journal, MagneticBearingController, MagneticBearingPlant, Silence, Unit, UnitError,
};
use measure::{Candidate, medians, verdict};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

const T: f64 = 1e-3;
const STEPS: usize = 10_000;
const ROUNDS: usize = 51;

fn reference(unit: &dyn Unit, name: &str) -> u32 {
    unit.description().find(name).expect("a variable of the table").0 as u32
}

/// Standard deviation of the noisy positions [m].
const NOISE: f64 = 1e-7;

/// What a loop with law (8a), x1(0) = 0.01 m, u(0) = -150 V, shows of itself.
#[derive(Default)]
struct Recording {
    /// [m]
    positions: Vec<f64>,
    noisy_positions: Vec<f64>,
    /// [V]
    voltages: Vec<f64>,
}

fn record() -> Recording {
    let (mut plant, mut controller) = (MagneticBearingPlant::new(), MagneticBearingController::new());
    let mut noise = GaussianNoise::new(1, 0);
    let mut recording = Recording::default();
    plant.initialise(0.0).expect("start values");
    controller.initialise(0.0).expect("start values");
    let plant_position = reference(&plant, "position") as usize;
    let plant_voltage = reference(&plant, "voltage") as usize;
    let controller_position = reference(&controller, "position") as usize;
    let controller_voltage = reference(&controller, "voltage") as usize;
    for _ in 0..STEPS {
        let position = plant.values()[plant_position];
        controller.values_mut()[controller_position] = position;
        controller.advance(T, &mut Silence).expect("a step");
        let voltage = controller.values()[controller_voltage];
        plant.values_mut()[plant_voltage] = voltage;
        plant.advance(T, &mut Silence).expect("a step");
        recording.positions.push(position);
        recording.noisy_positions.push(position + NOISE * noise.sample());
        recording.voltages.push(voltage);
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
            literal::invert(self.outputs, self.voltages, self.guess, self.iterations, 1.0, 0.0, T)
        {
            self.guess = literal::printed_map(w, self.voltages[0], 0.0, T);
        }
        let estimate = literal::printed_map(self.guess, self.voltages[1], 0.0, T);
        let state = State { position: estimate[0], velocity: estimate[1], flux: estimate[2] };
        let gains = Gains { position: 0.92, velocity: 9.94 };
        values[voltage] = bearing_feedback::voltage(Law::A, gains, state).clamp(-150.0, 150.0);
        outputs.into_iter().zip(estimate.iter()).for_each(|(output, value)| values[output] = *value);
    }
}

impl Unit for Baseline {
    fn description(&self) -> &'static Description {
        self.controller.description()
    }
    fn values(&self) -> &[f64] {
        self.controller.values()
    }
    fn values_mut(&mut self) -> &mut [f64] {
        self.controller.values_mut()
    }
    fn adopt_parameters(&mut self) {}
    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        self.clock = SampleClock::new(T, start_time);
        Ok(())
    }
    fn advance(&mut self, duration: f64, _: &mut dyn Journal) -> Result<(), UnitError> {
        for _ in self.clock.advance(duration) {
            if self.iterations > 0 {
                self.tick();
            }
        }
        Ok(())
    }
    fn boxed_clone(&self) -> Box<dyn Unit> {
        Box::new(self.clone())
    }
}

/// A unit behind the C boundary, stepped as an importer would.
struct Component {
    handle: *mut c_void,
    input: u32,
    outputs: [u32; 4],
}

impl Component {
    /// A controller, or what passes for one, with some values of integers and enumerations.
    fn controller(unit: impl Unit + 'static, integers: &[(&str, i32)]) -> Self {
        let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
        Self::new(unit, "position", outputs, integers)
    }

    fn plant() -> Self {
        let outputs = ["position_measured", "voltage_measured", "velocity", "flux"];
        Self::new(MagneticBearingPlant::new(), "voltage", outputs, &[])
    }

    fn new(mut unit: impl Unit + 'static, input: &str, outputs: [&str; 4], integers: &[(&str, i32)]) -> Self {
        for (name, value) in integers {
            let reference = reference(&unit, name) as usize;
            unit.values_mut()[reference] = f64::from(*value);
        }
        let (input, outputs) = (reference(&unit, input), outputs.map(|name| reference(&unit, name)));
        // Reset goes back to the unit as given here.
        let instance = Instance::new(
            Box::new(unit),
            Interface::CoSimulation,
            Logger::new(Callback::None, c"bench".into(), false),
        );
        let handle = Box::into_raw(Box::new(instance)).cast();
        Self { handle, input, outputs }
    }

    /// Plays the recorded input from a fresh start.
    fn play(&mut self, inputs: &[f64]) {
        // SAFETY: a live handle, one thread.
        unsafe {
            fmi2Reset(self.handle);
            fmi2EnterInitializationMode(self.handle);
            fmi2ExitInitializationMode(self.handle);
        }
        // Through opaque pointers, as if loaded: nothing is inlined into the loop.
        let set: unsafe extern "C" fn(_, *const _, _, *const _) -> _ = black_box(fmi2SetReal);
        let step: unsafe extern "C" fn(_, _, _, _) -> _ = black_box(fmi2DoStep);
        let get: unsafe extern "C" fn(_, *const _, _, *mut _) -> _ = black_box(fmi2GetReal);
        let mut outputs = [0.0; 4];
        let mut failures = 0;
        let mut time = 0.0;
        for input in inputs {
            // SAFETY: a live handle, one thread, arrays of the given length.
            unsafe {
                failures += set(self.handle, &self.input, 1, input);
                failures += step(self.handle, time, T, 1);
                failures += get(self.handle, self.outputs.as_ptr(), 4, outputs.as_mut_ptr());
            }
            time += T;
            black_box(&outputs);
        }
        assert_eq!(failures, 0);
    }
}

impl Drop for Component {
    fn drop(&mut self) {
        // SAFETY: made in `new`, freed once.
        unsafe { fmi2FreeInstance(self.handle) }
    }
}

fn main() {
    let Recording { positions, noisy_positions, voltages } = record();
    let controller =
        |integers: &[(&str, i32)]| Component::controller(MagneticBearingController::new(), integers);
    let literal = |iterations| Component::controller(Baseline::new(iterations), &[]);
    let (exact, kind) = (("observer.map", 1), "observer.kind");
    let candidates = [
        ("empty unit", literal(0), &positions),
        ("newton, d = 10", controller(&[]), &positions),
        ("newton, d = 100", controller(&[("observer.max_iterations", 100)]), &positions),
        ("literal algorithm, d = 10", literal(10), &positions),
        ("literal algorithm, d = 100", literal(100), &positions),
        ("newton, exact map", controller(&[exact]), &positions),
        ("newton, exact map, noise", controller(&[exact]), &noisy_positions),
        ("reduced_newton", controller(&[(kind, 2)]), &positions),
        ("reduced_newton_compensated", controller(&[(kind, 3)]), &positions),
        ("kalman", controller(&[(kind, 4)]), &noisy_positions),
        ("newton, exact map, N = 30, noise", controller(&[exact, ("observer.window", 30)]), &noisy_positions),
        ("plant", Component::plant(), &voltages),
    ];
    let mut candidates = candidates.map(|(name, mut component, inputs)| Candidate {
        name,
        operations: STEPS,
        run: Box::new(move || component.play(inputs)),
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
    verdict("newton, d = 10, against the empty unit", newton_10 / empty, "x", Some(3.0), None);
    verdict("literal against shipped, d = 10", literal_10 / newton_10, "x", None, Some(5.0));
    verdict("literal against shipped, d = 100", literal_100 / newton_100, "x", None, Some(30.0));
    verdict("newton, exact map", exact, "ns", Some(150.0), None);
    verdict("kalman", kalman, "ns", Some(200.0), None);
    verdict("window of 30 samples", window, "ns", Some(5000.0), None);
    verdict("plant, against the empty unit", plant / empty, "x", Some(3.0), None);
}
