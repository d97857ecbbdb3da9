//! Cost of one controller tick through the C ABI: set the position, step, get four outputs.
//!
//! Baselines in the same run: a unit that does nothing behind the same boundary, and the paper's algorithm taken
//! literally (general 3x3 solve, always d iterations) inside the same unit.

#[path = "../tests/literal/mod.rs"]
mod literal;
mod measure;

use core::ffi::c_void;
use std::hint::black_box;

use maglev_fmu::controller::bearing_feedback::{self, Gains, Law};
use maglev_fmu::fmi::fmi2::{
    fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2FreeInstance, fmi2GetReal,
    fmi2Reset, fmi2SetInteger, fmi2SetReal,
};
use maglev_fmu::fmi::{Callback, Instance, Logger};
use maglev_fmu::plant::magnetic_bearing::State;
use maglev_fmu::unit::sample_clock::SampleClock;
use maglev_fmu::unit::{
    Description, Journal, MagneticBearingController, MagneticBearingPlant, Silence, Unit, UnitError,
};
use measure::{Candidate, medians, verdict};
use nalgebra::Vector3;

const T: f64 = 1e-3;
const STEPS: usize = 10_000;
const ROUNDS: usize = 51;

fn reference(unit: &dyn Unit, name: &str) -> u32 {
    unit.description().find(name).expect("a variable of the table").0 as u32
}

/// Positions of the observer loop, law (8a), x1(0) = 0.01, u(0) = -150 V.
fn positions() -> Vec<f64> {
    let (mut plant, mut controller) = (MagneticBearingPlant::new(), MagneticBearingController::new());
    plant.initialise(0.0).expect("start values");
    controller.initialise(0.0).expect("start values");
    let plant_position = reference(&plant, "position") as usize;
    let plant_voltage = reference(&plant, "voltage") as usize;
    let controller_position = reference(&controller, "position") as usize;
    let controller_voltage = reference(&controller, "voltage") as usize;
    (0..STEPS)
        .map(|_| {
            let position = plant.values()[plant_position];
            controller.values_mut()[controller_position] = position;
            controller.advance(T, &mut Silence).expect("a step");
            plant.values_mut()[plant_voltage] = controller.values()[controller_voltage];
            plant.advance(T, &mut Silence).expect("a step");
            position
        })
        .collect()
}

/// The controller's table with another behaviour behind it.
#[derive(Clone)]
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
    iterations: u32,
    max_iterations: i32,
    position: u32,
    outputs: [u32; 4],
}

impl Component {
    fn new(unit: Box<dyn Unit>, max_iterations: i32) -> Self {
        let position = reference(&*unit, "position");
        let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"]
            .map(|name| reference(&*unit, name));
        let iterations = reference(&*unit, "observer.max_iterations");
        let instance = Instance::new(unit, Logger::new(Callback::None, c"bench".into(), false));
        let handle = Box::into_raw(Box::new(instance)).cast();
        Self { handle, iterations, max_iterations, position, outputs }
    }

    /// Plays the recorded positions from a fresh start.
    fn play(&mut self, positions: &[f64]) {
        // SAFETY: a live handle, one thread, arrays of the given length.
        unsafe {
            fmi2Reset(self.handle);
            fmi2SetInteger(self.handle, &self.iterations, 1, &self.max_iterations);
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
        for position in positions {
            // SAFETY: a live handle, one thread, arrays of the given length.
            unsafe {
                failures += set(self.handle, &self.position, 1, position);
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
    let positions = positions();
    let mut empty = Component::new(Box::new(Baseline::new(0)), 10);
    let mut shipped_10 = Component::new(Box::new(MagneticBearingController::new()), 10);
    let mut shipped_100 = Component::new(Box::new(MagneticBearingController::new()), 100);
    let mut literal_10 = Component::new(Box::new(Baseline::new(10)), 10);
    let mut literal_100 = Component::new(Box::new(Baseline::new(100)), 10);
    let mut candidates: Vec<Candidate> = [
        ("empty unit", &mut empty),
        ("controller, d = 10", &mut shipped_10),
        ("controller, d = 100", &mut shipped_100),
        ("literal algorithm, d = 10", &mut literal_10),
        ("literal algorithm, d = 100", &mut literal_100),
    ]
    .into_iter()
    .map(|(name, component)| Candidate {
        name,
        operations: STEPS,
        run: Box::new(|| component.play(&positions)),
    })
    .collect();
    let medians = medians(&mut candidates, ROUNDS);
    println!("Controller tick through the C ABI (set position, doStep, get four outputs), medians");
    for (candidate, median) in candidates.iter().zip(&medians) {
        verdict(candidate.name, *median, "ns", None, None);
    }
    let [empty, shipped_10, shipped_100, literal_10, literal_100] = medians[..] else { unreachable!() };
    verdict("tick, d = 10", shipped_10, "ns", Some(150.0), None);
    verdict("tick against the empty unit, d = 10", shipped_10 / empty, "x", Some(3.0), None);
    verdict("literal against shipped, d = 10", literal_10 / shipped_10, "x", None, Some(5.0));
    verdict("literal against shipped, d = 100", literal_100 / shipped_100, "x", None, Some(30.0));
}
