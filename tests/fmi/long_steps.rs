//! Steps that would compute for more than about a second are refused before they begin, with what would be accepted.

use std::time::{Duration, Instant};

use maglev_fmu::model::models;

use super::harness::clocked::{Choices, go_on, sampled_models};
use super::harness::{BOTH, Component, OK};

/// The longest step that a refusal names.
#[track_caller]
fn named_limit(component: &Component, step: f64) -> f64 {
    let said = ["a step of ", " s: expected at most ", "about a second of computing"];
    component.assert_refused_keeping(component.step(0.0, step), &said)
}

impl Component {
    /// Asserts a refusal that names a number of seconds after "at most", and that nothing has changed.
    #[track_caller]
    fn assert_refused_keeping(&self, status: i32, said: &[&str]) -> f64 {
        let text = self.recorder.messages().last().map(|message| message.text.clone()).unwrap_or_default();
        self.assert_refused(status, said);
        assert_eq!(self.get("time"), 0.0);
        let number = text
            .split("expected at most ")
            .nth(1)
            .and_then(|rest| rest.split(' ').find(|word| word.starts_with(char::is_numeric)));
        number.and_then(|number| number.parse().ok()).expect("a number of seconds")
    }
}

/// Models with parameters, by name, that make their steps expensive.
const EXPENSIVE: &[(&str, &[(&str, f64)])] = &[
    (
        "LevitatedBallPlant",
        &[
            ("resistance", 1e3),
            ("inductance_constant", 1e-7),
            ("gravity", 100.0),
            ("lower_stop", 0.0),
            ("initial.position", -10.0),
            ("initial.velocity", 1000.0),
        ],
    ),
    ("LevitatedBallPlant", &[]),
    ("LevitatedBallPlant", &[("sensor.sample_time", 1e-6), ("sensor.noise", 1e-3)]),
    ("MagneticBearingPlant", &[("sensor.sample_time", 1e-6), ("sensor.noise", 1e-3)]),
    ("MaglevRigPlant", &[]),
    ("MaglevRigPlant", &[("sensor.sample_time", 1e-6), ("sensor.noise", 1e-3)]),
    ("LevitatedBallController", &[]),
    ("LevitatedBallController", &[("sample_time", 1e-6)]),
    ("LevitatedBallController", &[("observer.kind", 3.0), ("sample_time", 1.0)]),
    ("MaglevRigController", &[]),
    ("MaglevRigController", &[("observer.kind", 2.0), ("observer.discretisation", 1.0)]),
    ("MaglevRigController", &[("observer.kind", 2.0), ("observer.substeps", 1000.0)]),
    ("MaglevRigController", &[("observer.kind", 3.0)]),
    ("MaglevRigController", &[("observer.kind", 4.0)]),
    (
        "MaglevRigController",
        &[("observer.kind", 4.0), ("observer.window", 64.0), ("observer.max_iterations", 1000.0)],
    ),
    ("MagneticBearingController", &[]),
    ("MagneticBearingController", &[("observer.max_iterations", 1000.0), ("observer.step_size", 1e-3)]),
    ("MagneticBearingController", &[("observer.kind", 2.0), ("observer.max_iterations", 1000.0)]),
    ("MagneticBearingController", &[("observer.kind", 4.0)]),
    (
        "MagneticBearingController",
        &[
            ("observer.window", 64.0),
            ("observer.max_iterations", 1000.0),
            ("observer.line_search", 1.0),
            ("observer.step_size", 1e-3),
        ],
    ),
];

#[test]
fn a_step_that_would_take_long_is_refused_at_once_with_what_is_accepted() {
    for standard in BOTH {
        for (model, parameters) in EXPENSIVE {
            let component = Component::new(standard, model);
            for (name, value) in *parameters {
                assert_eq!(component.set(name, *value), OK, "{model} {name}");
            }
            component.initialise(0.0);
            component.recorder.clear();
            let begin = Instant::now();
            let limit = named_limit(&component, 1e12);
            // The limit itself is not refused, what is beyond is.
            assert_eq!(named_limit(&component, limit * 1.5), limit, "{model}");
            assert!(begin.elapsed() < Duration::from_millis(100), "{model}: {:?}", begin.elapsed());
            // A share of it, since the machine may do something else.
            let begin = Instant::now();
            assert_eq!(component.step(0.0, limit * 0.02), OK, "{model}");
            let whole = begin.elapsed().as_secs_f64() / 0.02;
            component.recorder.clear();
            println!("{model} {parameters:?}: {whole:.2} s for {limit} s");
            assert!(whole < 10.0, "{model} {parameters:?}: {whole} s for {limit} s");
        }
    }
}

/// Guards: a declared range in which the model cannot be run, for the coil is faster than any integrator.
#[test]
fn everywhere_in_its_ranges_a_plant_takes_a_step_of_a_microsecond() {
    let model = "LevitatedBallPlant";
    let names = ["resistance", "inductance_constant", "gap", "lower_stop"];
    for (standard, corner) in
        BOTH.into_iter().flat_map(|standard| (0..16u32).map(move |corner| (standard, corner)))
    {
        let component = Component::new(standard, model);
        for (place, name) in names.into_iter().enumerate() {
            let (minimum, maximum) = component.description.find(name).unwrap().1.range;
            assert_eq!(component.set(name, if corner >> place & 1 == 0 { minimum } else { maximum }), OK);
        }
        component.initialise(0.0);
        component.recorder.clear();
        assert_eq!(component.step(0.0, 1e-6), OK, "{corner:b}");
    }
}

#[test]
fn every_model_has_a_bound_and_the_suggested_step_is_far_below() {
    for model in models() {
        let description = model.description;
        let component = Component::new(BOTH[0], description.name);
        component.initialise(0.0);
        component.recorder.clear();
        // The bearing is solved in closed form, whatever the step.
        if description.name == "MagneticBearingPlant" {
            assert_eq!(component.step(0.0, 1e12), OK);
        } else {
            let limit = named_limit(&component, 1e12);
            assert!(limit > 1e4 * description.step_size, "{}: {limit} s", description.name);
        }
    }
}

#[test]
fn a_step_that_ends_at_the_next_tick_may_be_as_long_as_it_likes() {
    for model in sampled_models() {
        let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = Component::co_simulation(model, choices);
        component.initialise(0.0);
        assert_eq!(component.enter_step_mode(), OK);
        let step = component.step_to_event(0.0, 1e12);
        assert_eq!((step.status, step.reached), (OK, component.get("sample_time")));
        let choices = Choices { event_mode: true, early_return: false, intermediate_update: None };
        let component = Component::co_simulation(model, choices);
        component.initialise(0.0);
        assert_eq!(component.enter_step_mode(), OK);
        assert_ne!(component.step_to_event(0.0, 1e12).status, OK);
        assert_eq!(component.get("time"), 0.0);
    }
}

#[test]
fn steps_beyond_longest_step_are_refused_with_callbacks_and_without() {
    for model in sampled_models() {
        for intermediate_update in [None, Some(go_on as _)] {
            let component =
                Component::co_simulation(model, Choices { intermediate_update, ..Choices::default() });
            assert_eq!(component.set("longest_step", 1e-3), OK);
            component.initialise(0.0);
            component.recorder.clear();
            let said = ["a step of 0.002 s: expected at most longest_step = 0.001 s"];
            component.assert_refused(component.step(0.0, 2e-3), &said);
            assert_eq!(component.get("time"), 0.0);
            assert_eq!(component.step(0.0, 1e-3), OK, "{model}");
        }
    }
}

/// Guards: a step up to a tick that was longer than `longest_step`, where the importer had asked for even more.
#[test]
fn longest_step_holds_for_the_part_of_a_step_up_to_a_tick() {
    for model in sampled_models() {
        let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = Component::co_simulation(model, choices);
        let sample_time = component.get("sample_time");
        assert_eq!(component.set("longest_step", sample_time / 2.0), OK);
        component.initialise(0.0);
        assert_eq!(component.enter_step_mode(), OK);
        component.recorder.clear();
        let limit = sample_time / 2.0;
        let said = format!("a step of {sample_time:?} s: expected at most longest_step = {limit:?} s");
        component.assert_refused_keeping(component.step_to_event(0.0, 1e12).status, &[&said]);
        let step = component.step_to_event(0.0, limit);
        assert_eq!((step.status, step.is_event, step.reached), (OK, false, limit), "{model}");
        let step = component.step_to_event(limit, 1e12);
        assert_eq!((step.status, step.is_event, step.reached), (OK, true, sample_time), "{model}");
    }
}

/// Guards: a limit of computing that was named where the loop's own is smaller, so that the step named was refused.
#[test]
fn the_smaller_of_two_limits_is_named_and_accepted() {
    for (standard, model) in
        BOTH.into_iter().flat_map(|standard| sampled_models().map(move |model| (standard, model)))
    {
        for (longest_step, named) in
            [(1e-3, "at most longest_step = 0.001 s"), (1e9, "about a second of computing")]
        {
            let component = Component::new(standard, model);
            assert_eq!(component.set("longest_step", longest_step), OK);
            component.initialise(0.0);
            component.recorder.clear();
            component.assert_refused(component.step(0.0, 1e30), &[named]);
        }
        let component = Component::new(standard, model);
        assert_eq!(component.set("longest_step", 1e-3), OK);
        component.initialise(0.0);
        assert_eq!(component.step(0.0, 1e-3), OK);
    }
}

/// Starts at which the differences of times are off by more than a billionth of the step.
const LATE_STARTS: [f64; 4] = [1677.0, 33_554.0, 50_000.0, 1e6];

/// Guards: `longest_step`, which refused what it names to importers that compute their steps as differences of times.
#[test]
fn longest_step_allows_for_the_rounding_of_times() {
    for (standard, model) in
        BOTH.into_iter().flat_map(|standard| sampled_models().map(move |model| (standard, model)))
    {
        for (start, longest_step) in LATE_STARTS.into_iter().flat_map(|start| [(start, 1e-3), (-start, 1e-4)])
        {
            let component = Component::new(standard, model);
            assert_eq!(component.set("longest_step", longest_step), OK);
            component.initialise(start);
            let mut time = start;
            for k in 1..=100 {
                let end = start + f64::from(k) * longest_step;
                let status = component.step(time, end - time);
                assert!(status == OK, "{model} {start}: {:?}", component.recorder.messages());
                time = end;
            }
        }
    }
}

/// Guards: a model that ended a step at its own tick and refused what it had made of it.
#[test]
fn steps_that_end_at_ticks_are_one_sample_time_long_at_any_time() {
    for model in sampled_models() {
        for (start, sample_time) in
            LATE_STARTS.map(|start| (start, 1e-3)).into_iter().chain([(8.3, 1e-6), (1677.0, 1e-4)])
        {
            let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
            let component = Component::co_simulation(model, choices);
            assert_eq!(component.set("sample_time", sample_time), OK);
            assert_eq!(component.set("longest_step", sample_time), OK);
            component.initialise(start);
            let mut time = start;
            for _ in 0..20 {
                component.settle_event();
                assert_eq!(component.enter_step_mode(), OK);
                let step = component.step_to_event(time, 1.0);
                assert!(
                    step.status == OK && step.is_event,
                    "{model} {start}: {:?}",
                    component.recorder.messages()
                );
                time = step.reached;
                assert_eq!(component.enter_event_mode(), OK);
            }
            assert!(time > start + 18.5 * sample_time);
        }
    }
}
