//! Instances share nothing.

use std::thread;

use super::harness::{CONTROLLER, Component, OK, PLANT, Standard};

const LOOPS: u32 = 50;
const ROUNDS: usize = 20;
const STEPS_PER_ROUND: usize = 10;

/// A plant and a controller, of different standards and with parameters of their own.
struct Loop {
    plant: Component,
    controller: Component,
    steps: usize,
    record: Vec<u64>,
}

impl Loop {
    fn new(number: u32) -> Self {
        let standards = [Standard::Fmi2, Standard::Fmi3];
        let plant = Component::new(standards[number as usize % 2], PLANT);
        let controller = Component::new(standards[number as usize / 2 % 2], CONTROLLER);
        let share = f64::from(number) / f64::from(LOOPS);
        for (component, name, value) in [
            (&plant, "initial.position", 0.01 * share),
            (&plant, "sensor.noise", 1e-9 * share),
            (&plant, "sensor.seed", f64::from(number)),
            (&plant, "bias_flux", 1e-3 * share),
            (&controller, "bias_flux", 1e-3 * share),
            (&controller, "controller.initial_voltage", -150.0 * share),
            (&controller, "controller.law", f64::from(1 + number % 3)),
            (&controller, "observer.max_iterations", f64::from(1 + number % 20)),
        ] {
            assert_eq!(component.set(name, value), OK, "{name}");
        }
        plant.initialise(0.0);
        controller.initialise(0.0);
        Self { plant, controller, steps: 0, record: Vec::new() }
    }

    fn step(&mut self) {
        let t = self.steps as f64 * 1e-3;
        assert_eq!(self.controller.set("position", self.plant.get("position_measured")), OK);
        assert_eq!(self.controller.step(t, 1e-3), OK);
        let voltage = self.controller.get("voltage");
        assert_eq!(self.plant.set("voltage", voltage), OK);
        assert_eq!(self.plant.step(t, 1e-3), OK);
        self.steps += 1;
        let outputs = ["position", "velocity", "flux", "position_measured"].map(|name| self.plant.get(name));
        let estimates = ["estimate.velocity", "estimate.flux"].map(|name| self.controller.get(name));
        self.record.extend(outputs.iter().chain(&estimates).chain([&voltage]).map(|value| value.to_bits()));
    }
}

/// The log of a loop's two instances.
fn log(one: &Loop) -> Vec<super::harness::Message> {
    [one.plant.recorder.messages(), one.controller.recorder.messages()].concat()
}

#[test]
fn a_hundred_instances_in_four_threads_run_as_if_alone() {
    let alone: Vec<Loop> = (0..LOOPS)
        .map(|number| {
            let mut one = Loop::new(number);
            (0..ROUNDS * STEPS_PER_ROUND).for_each(|_| one.step());
            one
        })
        .collect();

    let mut together: Vec<Loop> = (0..LOOPS).map(Loop::new).collect();
    for round in 0..ROUNDS {
        // Every instance meets other threads and other neighbours in each round.
        together.rotate_left(round % 7);
        thread::scope(|scope| {
            for group in together.chunks_mut(LOOPS.div_ceil(4) as usize) {
                scope.spawn(|| {
                    for _ in 0..STEPS_PER_ROUND {
                        group.iter_mut().for_each(Loop::step);
                    }
                });
            }
        });
    }
    let rotated = (0..ROUNDS).map(|round| round % 7).sum::<usize>() % LOOPS as usize;
    together.rotate_right(rotated);

    let mut distinct = std::collections::HashSet::new();
    for (number, (alone, together)) in alone.iter().zip(&together).enumerate() {
        assert!(alone.record == together.record, "loop {number}");
        assert_eq!(log(alone), log(together), "loop {number}");
        distinct.insert(&alone.record);
    }
    assert_eq!(distinct.len(), LOOPS as usize, "the parameters make a difference");
}
