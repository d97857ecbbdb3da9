//! Cost of one step of the levitated ball's units through the C ABI: set the input, step, get the outputs.
//!
//! The currents are those of a loop on the sinusoids, whose reference the controller gets, too.

mod measure;

use core::ffi::c_void;
use std::hint::black_box;

use maglev_fmu::fmi::fmi2::{
    fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2FreeInstance, fmi2GetReal,
    fmi2Reset, fmi2SetReal,
};
use maglev_fmu::fmi::{Callback, Instance, Interface, Logger};
use maglev_fmu::signal::BallReference;
use maglev_fmu::unit::{LevitatedBallController, LevitatedBallPlant, Silence, Unit};
use measure::{Candidate, medians, verdict};

const T: f64 = 1e-4;
const STEPS: usize = 10_000;
const ROUNDS: usize = 31;

fn reference(unit: &dyn Unit, name: &str) -> usize {
    unit.description().find(name).expect("a variable of the table").0
}

/// What a loop shows of itself: current and reference, and the voltage with no force.
#[derive(Default)]
struct Recording {
    sensed: Vec<[f64; 2]>,
    actuated: Vec<[f64; 2]>,
}

fn record() -> Recording {
    let (mut plant, mut controller) = (LevitatedBallPlant::new(), LevitatedBallController::new());
    let mut recording = Recording::default();
    plant.initialise(0.0).expect("start values");
    controller.initialise(0.0).expect("start values");
    let [current, wanted, voltage] =
        ["current", "reference", "voltage"].map(|name| reference(&controller, name));
    let [plant_current, plant_voltage] = ["current", "voltage"].map(|name| reference(&plant, name));
    for step in 0..STEPS {
        let sensed = [plant.values()[plant_current], BallReference::Sinusoids.at(T * step as f64)];
        controller.values_mut()[current] = sensed[0];
        controller.values_mut()[wanted] = sensed[1];
        controller.advance(T, &mut Silence).expect("a step");
        let actuated = controller.values()[voltage];
        plant.values_mut()[plant_voltage] = actuated;
        plant.advance(T, &mut Silence).expect("a step");
        recording.sensed.push(sensed);
        recording.actuated.push([actuated, 0.0]);
    }
    recording
}

/// A unit behind the C boundary, stepped as an importer would.
struct Component {
    handle: *mut c_void,
    inputs: [u32; 2],
    outputs: [u32; 4],
}

impl Component {
    /// The controller with some values.
    fn controller(values: &[(&str, f64)]) -> Self {
        let outputs = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
        Self::new(LevitatedBallController::new(), ["current", "reference"], outputs, values)
    }

    fn plant(values: &[(&str, f64)]) -> Self {
        let outputs = ["current_measured", "voltage_measured", "position", "flux"];
        Self::new(LevitatedBallPlant::new(), ["voltage", "force"], outputs, values)
    }

    fn new(
        mut unit: impl Unit + 'static,
        inputs: [&str; 2],
        outputs: [&str; 4],
        values: &[(&str, f64)],
    ) -> Self {
        for (name, value) in values {
            let reference = reference(&unit, name);
            unit.values_mut()[reference] = *value;
        }
        let inputs = inputs.map(|name| reference(&unit, name) as u32);
        let outputs = outputs.map(|name| reference(&unit, name) as u32);
        // Reset goes back to the unit as given here.
        let logger = Logger::new(Callback::None, c"bench".into(), false);
        let instance = Instance::new(Box::new(unit), Interface::CoSimulation, logger);
        Self { handle: Box::into_raw(Box::new(instance)).cast(), inputs, outputs }
    }

    /// Plays the recorded inputs from a fresh start.
    fn play(&mut self, inputs: &[[f64; 2]]) {
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
                failures += set(self.handle, self.inputs.as_ptr(), 2, input.as_ptr());
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
    let recording = record();
    let (sensed, actuated) = (&recording.sensed, &recording.actuated);
    let kind = |kind: f64| [("observer.kind", kind)];
    let candidates = [
        ("controller, drem", Component::controller(&[]), sensed, Some(500.0)),
        ("controller, polynomial_newton", Component::controller(&kind(2.0)), sensed, Some(400.0)),
        ("controller, polynomial_newton_adaptive", Component::controller(&kind(3.0)), sensed, Some(400.0)),
        ("plant, 0.1 ms", Component::plant(&[]), actuated, Some(300.0)),
        ("plant, 0.1 ms, noisy sensor", Component::plant(&[("sensor.noise", 1e-3)]), actuated, None),
    ];
    let targets = candidates.iter().map(|candidate| candidate.3).collect::<Vec<_>>();
    let mut candidates = candidates.map(|(name, mut component, inputs, _)| Candidate {
        name,
        operations: STEPS,
        run: Box::new(move || component.play(inputs)),
    });
    let medians = medians(&mut candidates, ROUNDS);
    println!("Step through the C ABI (set two inputs, doStep, get four outputs), medians");
    for ((candidate, median), target) in candidates.iter().zip(&medians).zip(targets) {
        verdict(candidate.name, *median, "ns", target, None);
    }
}
