//! Saved states: runs that go on from them never differ by a bit, and bytes that are no state change nothing.

use core::ptr::null_mut;
use std::ops::Range;

use maglev_fmu::fmi::LONGEST_SAVED_STATE;
use maglev_fmu::model::models;
use maglev_fmu::model::variable::{Causality, Kind, Variability, Variable};
use rand_core::Rng;
use rand_pcg::Pcg32;

use super::harness::{BOTH, Component, OK, PHASES, Phase, Standard};

/// Random choices, the same in every run.
pub(super) struct Choice(pub(super) Pcg32);

impl Choice {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg32::new(seed, 7))
    }

    pub(super) fn below(&mut self, end: u32) -> u32 {
        self.0.next_u32() % end
    }

    pub(super) fn within(&mut self, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    /// A value that `variable` takes: any item, number or truth value; reals near their start value.
    pub(super) fn value(&mut self, variable: &Variable) -> f64 {
        match variable.kind {
            Kind::Boolean => f64::from(self.below(2)),
            Kind::Enumeration(enumeration) => f64::from(1 + self.below(enumeration.items.len() as u32)),
            Kind::Integer => {
                // Long windows and large seeds, but few iterations.
                let largest = variable.range.1.min(100.0);
                self.within(variable.range.0..largest + 1.0).floor().min(largest)
            }
            Kind::Real(_) => {
                let value = match variable.start {
                    0.0 => self.within(-1e-3..1e-3),
                    start => start * self.within(0.5..1.5),
                };
                value.max(variable.range.0).min(variable.range.1)
            }
        }
    }
}

pub(super) fn names() -> impl Iterator<Item = &'static str> {
    models().map(|model| model.description.name)
}

pub(super) fn is_input(variable: &Variable) -> bool {
    variable.causality == Causality::Input
}

pub(super) fn is_tunable(variable: &Variable) -> bool {
    variable.causality == Causality::Parameter && variable.variability == Variability::Tunable
}

/// What one random run does, so that it can be done again.
#[derive(Clone)]
pub(super) enum Move {
    Set(u32, f64),
    Step(f64),
}

/// A random configuration, and moves after initialisation.
pub(super) fn plan(model: &str, choice: &mut Choice) -> (Vec<(u32, f64)>, Vec<Move>) {
    let variables = super::harness::description(model).variables;
    let rows = |wanted: fn(&Variable) -> bool| -> Vec<u32> {
        (0..variables.len()).filter(|row| wanted(&variables[*row])).map(|row| row as u32).collect()
    };
    let parameters = rows(|variable| variable.causality == Causality::Parameter);
    let mut configuration = Vec::new();
    for row in parameters {
        let variable = &variables[row as usize];
        let is_choice = matches!(variable.kind, Kind::Enumeration(_) | Kind::Boolean);
        if choice.below(if is_choice { 2 } else { 4 }) == 0 {
            configuration.push((row, choice.value(variable)));
        }
    }
    let (inputs, tunables) = (rows(is_input), rows(is_tunable));
    let length = 1 + choice.below(40);
    let moves = (0..length).map(|_| match choice.below(10) {
        0..3 => {
            let row = inputs[choice.below(inputs.len() as u32) as usize];
            Move::Set(row, choice.value(&variables[row as usize]))
        }
        3 if !tunables.is_empty() => {
            let row = tunables[choice.below(tunables.len() as u32) as usize];
            Move::Set(row, choice.value(&variables[row as usize]))
        }
        _ => Move::Step([1e-3, 2.5e-4, 3.7e-3, 1.0 / 60.0][choice.below(4) as usize]),
    });
    let moves = moves.collect();
    (configuration, moves)
}

/// One move of an instance that stands at `time`. A refusal is a result, too.
fn go(component: &Component, time: &mut f64, to_do: &Move) -> i32 {
    match *to_do {
        Move::Set(row, value) => component.set_reference(row, value),
        Move::Step(size) => {
            let status = component.step(*time, size);
            if status == OK {
                *time += size;
            }
            status
        }
    }
}

pub(super) fn configured(standard: Standard, model: &str, configuration: &[(u32, f64)]) -> Component {
    let component = Component::with_logging(standard, model, false);
    for (row, value) in configuration {
        assert_eq!(component.set_reference(*row, *value), OK, "{:?}", component.recorder.messages());
    }
    component
}

/// Sequences of moves interrupted by saving and restoring: in memory, through bytes, in other instances, of the other
/// standard, before and after initialisation, with detours between the two.
#[test]
fn ten_thousand_interrupted_runs_never_differ_from_the_uninterrupted_ones() {
    let sequences = 10_000 / models().count() as u64 + 1;
    let (mut restored, mut steps, mut longest) = (0, 0, 0);
    for model in names() {
        for sequence in 0..sequences {
            let mut choice = Choice::new(sequence);
            let (configuration, moves) = plan(model, &mut choice);
            let standard = BOTH[choice.below(2) as usize];
            let straight = configured(standard, model, &configuration);
            let mut interrupted = configured(standard, model, &configuration);
            if choice.below(8) == 0 {
                let bytes = interrupted.saved_bytes();
                interrupted = Component::with_logging(BOTH[choice.below(2) as usize], model, false);
                assert_eq!(interrupted.restore_bytes(&bytes), OK);
                restored += 1;
            }
            if straight.enter_initialization(0.0, None) != OK || straight.exit_initialization() != OK {
                // These parameters make no model.
                continue;
            }
            interrupted.initialise(0.0);
            let (mut time, mut other_time) = (0.0, 0.0);
            for to_do in &moves {
                let context = || format!("{standard:?} {model}, sequence {sequence}");
                match choice.below(6) {
                    // In memory, after a detour.
                    0 => {
                        let mut state = null_mut();
                        assert_eq!(interrupted.get_state(&mut state), OK);
                        let mut detour_time = other_time;
                        for _ in 0..1 + choice.below(8) {
                            let detour = moves[choice.below(moves.len() as u32) as usize].clone();
                            go(&interrupted, &mut detour_time, &detour);
                        }
                        assert_eq!(interrupted.set_state(state), OK, "{}", context());
                        assert_eq!(interrupted.free_state(&mut state), OK);
                        restored += 1;
                    }
                    // Elsewhere, in some phase.
                    1 => {
                        let bytes = interrupted.saved_bytes();
                        longest = longest.max(bytes.len());
                        let phase = PHASES[choice.below(4) as usize];
                        interrupted = Component::in_phase(BOTH[choice.below(2) as usize], model, phase);
                        assert_eq!(interrupted.restore_bytes(&bytes), OK, "{}", context());
                        assert_eq!(interrupted.saved_bytes(), bytes, "{}", context());
                        restored += 1;
                    }
                    _ => {}
                }
                let status = go(&straight, &mut time, to_do);
                assert_eq!(go(&interrupted, &mut other_time, to_do), status, "{}", context());
                assert_eq!(interrupted.snapshot(), straight.snapshot(), "{}", context());
                steps += 1;
            }
        }
    }
    println!("{restored} times restored in {steps} moves, the longest state had {longest} bytes");
    assert!(restored > 20_000 && longest > 1000 && longest <= LONGEST_SAVED_STATE);
}

#[test]
fn every_configuration_fits_into_four_kibibytes() {
    for model in names() {
        let (mut shortest, mut longest) = (usize::MAX, 0);
        let mut choice = Choice::new(99);
        for _ in 0..300 {
            let (configuration, _) = plan(model, &mut choice);
            let component = configured(Standard::Fmi3, model, &configuration);
            if component.enter_initialization(0.0, None) != OK || component.exit_initialization() != OK {
                continue;
            }
            // Longer than any window.
            for k in 0..70 {
                component.step(f64::from(k) * 1e-3, 1e-3);
            }
            let length = component.saved_bytes().len();
            shortest = shortest.min(length);
            longest = longest.max(length);
        }
        println!("{model}: {shortest} to {longest} bytes");
        assert!(longest <= LONGEST_SAVED_STATE);
    }
}

#[test]
fn a_state_brings_its_phase_with_it() {
    for model in names() {
        for (from, to) in BOTH.into_iter().flat_map(|from| BOTH.map(|to| (from, to))) {
            for saved in PHASES {
                let bytes = Component::in_phase(from, model, saved).saved_bytes();
                for present in PHASES {
                    let component = Component::in_phase(to, model, present);
                    assert_eq!(component.restore_bytes(&bytes), OK);
                    assert!(component.is_still_in(saved), "{model}: {saved:?} restored in {present:?}");
                }
            }
        }
    }
}

#[test]
fn handles_are_reused_and_null_is_free() {
    for (standard, model) in super::harness::all() {
        let component = Component::in_phase(standard, model, Phase::Step);
        let (mut first, mut second) = (null_mut(), null_mut());
        assert_eq!(component.get_state(&mut first), OK);
        let before = component.snapshot();
        assert_eq!(component.step(Component::STEPPED_TO, 1e-3), OK);
        let after = component.snapshot();
        assert_eq!(component.get_state(&mut second), OK);
        assert_ne!(first, second);

        // Overwritten in place; the other state stands.
        let memory = second;
        for (state, expected) in [(first, &before), (second, &after), (first, &before)] {
            assert_eq!(component.set_state(state), OK);
            assert_eq!(&component.snapshot(), expected);
        }
        assert_eq!(component.get_state(&mut second), OK);
        assert_eq!(second, memory);
        assert_eq!(component.set_state(second), OK);
        assert_eq!(component.snapshot(), before);
        let bytes = component.saved_bytes();
        assert_eq!(component.deserialise_state(&bytes, &mut second), OK);
        assert_eq!(second, memory);

        for state in [&mut first, &mut second] {
            assert_eq!(component.free_state(state), OK);
            assert!(state.is_null());
            assert_eq!(component.free_state(state), OK, "null is ignored");
        }
        component.recorder.clear();
        component.assert_refused(component.set_state(null_mut()), &["FMUState is a null pointer"]);
        let mut size = 7;
        component.assert_refused(component.state_size(null_mut(), &mut size), &["null pointer"]);
        component.assert_refused(component.serialise_state(null_mut(), &mut [0; 9]), &["null pointer"]);
        assert_eq!(size, 7);
    }
}
