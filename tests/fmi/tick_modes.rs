//! However an importer has a model tick, within steps, at events, on activation, in either standard: the same ticks, at the
//! same times, with the same inputs, to the last bit.

use maglev_fmu::model::Edition;
use maglev_fmu::model::variable::{Causality, Kind};

use super::harness::clocked::{Choices, go_on, sampled_models};
use super::harness::{Component, OK, Standard};

/// \[s\]
const DURATION: f64 = 1.0;
/// Fractions, multiples and neither; one as importers compute it.
const STEP_SIZES: [f64; 5] = [1e-3, 2.5e-4, 3.7e-3, 1.0 / 60.0, 0.0009999999999999998];

#[derive(Clone, Copy, Debug)]
enum Mode {
    Fmi2,
    Fmi3,
    /// Steps end at ticks, and the importer runs these.
    Events,
    /// The same, and the importer knows of clocks.
    EventsAndClocks,
    /// The importer handles events, but its steps must not end early.
    EventsWithoutEarlyReturn,
    /// The importer is called back at each tick within a step, and does nothing.
    Callbacks,
    /// The same, of the edition without clocks.
    PlainCallbacks,
    Scheduled,
}

const MODES: [Mode; 8] = [
    Mode::Fmi2,
    Mode::Fmi3,
    Mode::Events,
    Mode::EventsAndClocks,
    Mode::EventsWithoutEarlyReturn,
    Mode::Callbacks,
    Mode::PlainCallbacks,
    Mode::Scheduled,
];

fn instance(mode: Mode, model: &str) -> Component {
    let none = Choices::default();
    match mode {
        Mode::Fmi2 => Component::with_logging(Standard::Fmi2, model, false),
        Mode::Fmi3 => Component::with_logging(Standard::Fmi3, model, false),
        Mode::Events | Mode::EventsAndClocks => {
            Component::co_simulation(model, Choices { event_mode: true, early_return: true, ..none })
        }
        Mode::EventsWithoutEarlyReturn => {
            Component::co_simulation(model, Choices { event_mode: true, ..none })
        }
        Mode::Callbacks => {
            Component::co_simulation(model, Choices { intermediate_update: Some(go_on), ..none })
        }
        Mode::PlainCallbacks => Component::co_simulation_of(
            Edition::Plain,
            model,
            Choices { intermediate_update: Some(go_on), ..none },
        ),
        Mode::Scheduled => Component::scheduled(model, None),
    }
}

/// The inputs as they are from communication point `j` on: they move, and jump.
fn set_inputs(component: &Component, j: u32) {
    for (index, variable) in component.description.variables.iter().enumerate() {
        if variable.causality == Causality::Input && matches!(variable.kind, Kind::Real(_)) {
            let phase = 0.37 * f64::from(j) + index as f64;
            let value = 0.01 * phase.sin() + if j % 100 < 50 { 0.0 } else { 1e-3 };
            assert_eq!(component.set_reference(index as u32, value), OK);
        }
    }
}

/// All values but the time, as bits.
fn values(component: &Component) -> Vec<u64> {
    component.snapshot()[1..].to_vec()
}

/// Values at the end of each step, before anything happens that belongs to the next one.
fn run(mode: Mode, model: &str, step_size: f64) -> Vec<Vec<u64>> {
    let component = instance(mode, model);
    component.initialise(0.0);
    let steps = (DURATION / step_size) as u32;
    let period = component.get("sample_time");
    let has_events = matches!(mode, Mode::Events | Mode::EventsAndClocks | Mode::EventsWithoutEarlyReturn);
    let mut ticks = 0;
    let mut rows = Vec::new();
    let mut is_event = has_events;
    for j in 0..steps {
        let end = f64::from(j + 1) * step_size;
        let mut time = f64::from(j) * step_size;
        if is_event {
            // At the end of a step the instance is in step mode, at the start of all in event mode.
            if j > 0 {
                assert_eq!(component.enter_event_mode(), OK);
            }
            set_inputs(&component, j);
            if matches!(mode, Mode::EventsAndClocks) {
                assert_eq!(component.set_clock(component.clocks()[0], 1), OK);
            }
            component.settle_event();
            assert_eq!(component.enter_step_mode(), OK);
        } else {
            set_inputs(&component, j);
        }
        match mode {
            Mode::Scheduled => {
                // Ticks in the half-open interval; a tick that the end misses by rounding belongs to the next step.
                while f64::from(ticks) * period < end - 1e-4 * period {
                    assert_eq!(component.activate(f64::from(ticks) * period), OK);
                    ticks += 1;
                }
            }
            Mode::Events | Mode::EventsAndClocks => loop {
                let step = component.step_to_event(time, end - time);
                assert_eq!(step.status, OK, "{:?}", component.recorder.messages());
                is_event = step.is_event;
                if !step.is_early {
                    assert_eq!(step.reached, time + (end - time));
                    break;
                }
                // Ends early for ticks only, which are events.
                assert!(step.is_event && step.reached > time && step.reached < end);
                time = step.reached;
                assert_eq!(component.enter_event_mode(), OK);
                component.settle_event();
                assert_eq!(component.enter_step_mode(), OK);
            },
            Mode::Fmi2 => assert_eq!(component.step(time, step_size), OK),
            _ => {
                let step = component.step_to_event(time, step_size);
                assert_eq!((step.status, step.is_early, step.reached), (OK, false, time + step_size));
                assert!(has_events || !step.is_event);
                is_event = step.is_event;
            }
        }
        rows.push(values(&component));
    }
    rows
}

#[test]
fn all_modes_give_the_same_ticks_and_bits() {
    for model in sampled_models() {
        for step_size in STEP_SIZES {
            let expected = run(Mode::Fmi2, model, step_size);
            let distinct = expected.iter().collect::<std::collections::HashSet<_>>().len();
            assert!(distinct > expected.len() / 5, "the run stands still: {distinct} of {}", expected.len());
            for mode in MODES {
                let rows = run(mode, model, step_size);
                assert_eq!(rows.len(), expected.len());
                let first = (0..rows.len()).find(|j| rows[*j] != expected[*j]);
                assert_eq!(
                    first, None,
                    "{model}, {mode:?}, h = {step_size}: first difference after this step"
                );
            }
        }
    }
}
