//! Steps that do not quite begin where the last one ended: what is rounding, what passes, what is refused, and that the clock
//! stays at the importer's time.

use super::harness::clocked::{Choices, sampled_models};
use super::harness::{BOTH, Component, OK, PLANT, Standard};

/// Steps whose size misses the way between the communication points by some units in the last place of the time: the gaps
/// are rounding one by one, and not when they add up.
const IMPRECISE_STEPS: [(f64, f64); 3] = [
    (20_000.0, 0.001f32 as f64),
    (20_000.0, 1e-3 * (1.0 - 4.7e-8)),
    // Where it is some microseconds.
    (1.7e9, 1.002e-3),
];

const PERIOD: f64 = 1e-3;

/// Guards: at 20 000 s every tick ran a step early from the 2105th on, at 1.7e9 s the clock was 39 ms ahead after 20 s.
#[test]
fn the_clock_stays_at_the_communication_points_of_imprecise_steps() {
    for (standard, model) in
        BOTH.into_iter().flat_map(|standard| sampled_models().map(move |m| (standard, m)))
    {
        for (start, step_size) in IMPRECISE_STEPS {
            let component = Component::with_logging(standard, model, false);
            assert_eq!(component.set("sample_time", PERIOD), OK);
            component.initialise(start);
            for k in 0..6000 {
                let time = start + f64::from(k) * PERIOD;
                assert_eq!(component.step(time, step_size), OK, "{model} {start} {step_size} {k}");
                // What is ignored, and what a clock takes for a tick's time.
                let bound = (1e-4 * PERIOD).max(8.0 * f64::EPSILON * start);
                let ahead = component.get("tick_time") - time;
                assert!(ahead.abs() <= bound, "{model} {start} {step_size} {k}: {ahead}");
            }
        }
    }
}

/// Guards: the tick of the 2128th communication point was refused, for the clock had fallen behind.
#[test]
fn ticks_of_imprecise_steps_may_be_activated() {
    let (start, step_size) = IMPRECISE_STEPS[1];
    for (model, early_return) in sampled_models().flat_map(|model| [(model, false), (model, true)]) {
        let choices = Choices { event_mode: true, early_return, intermediate_update: None };
        let component = Component::co_simulation(model, choices);
        assert_eq!(component.set("sample_time", PERIOD), OK);
        component.initialise(start);
        for k in 0..6000 {
            let time = start + f64::from(k) * PERIOD;
            assert_eq!(
                component.set_clock(component.clocks()[0], 1),
                OK,
                "{:?}",
                component.recorder.messages().last()
            );
            component.settle_event();
            let miss = component.get("tick_time") - time;
            assert!(miss.abs() <= 1e-4 * PERIOD, "{model} {k}: {miss}");
            assert_eq!(component.enter_step_mode(), OK);
            assert_eq!(component.step_to_event(time, step_size).status, OK);
            assert_eq!(component.enter_event_mode(), OK);
        }
    }
}

/// Guards: ticks that ran a step early from the 30 000th on, for each gap was less than the last digit of the time; and a
/// refusal at 0, where the tolerance was that of the time.
#[test]
fn counted_steps_of_some_digits_keep_their_ticks() {
    let steps_of_a_tick = 6;
    let h = 1e-4 / f64::from(steps_of_a_tick);
    let [ten_digits, eight_digits] =
        [format!("{h:.9e}"), format!("{h:.7e}")].map(|text| text.parse::<f64>().unwrap());
    for (start, step_size) in [(-0.02, ten_digits), (5000.0, eight_digits)] {
        for standard in BOTH {
            let component = Component::with_logging(standard, "LevitatedBallController", false);
            assert_eq!(component.set("sample_time", 1e-4), OK);
            component.initialise(start);
            let tick_time = [component.reference("tick_time")];
            let mut value = [0.0];
            for k in 0..100_000 {
                assert_eq!(component.step(start + f64::from(k) * h, step_size), OK, "{start} {k}");
                assert_eq!(component.get_reals(&tick_time, &mut value), OK);
                let expected = start + f64::from(k / steps_of_a_tick) * 1e-4;
                assert!((value[0] - expected).abs() < 1e-8, "{start} {k}: {} {expected}", value[0]);
            }
        }
    }
}

/// Guards: a first step of 1e6 s that began 8.5 sample times late, for its billionth is more.
#[test]
fn the_gap_before_a_step_that_ends_at_a_tick_is_measured_by_the_step_before() {
    for model in sampled_models() {
        let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = Component::co_simulation(model, choices);
        component.initialise(1e6);
        component.settle_event();
        assert_eq!(component.enter_step_mode(), OK);
        let period = component.get("sample_time");
        component.recorder.clear();
        let late = component.step_to_event(1e6 + 0.5 * period, 1e6);
        component.assert_refused(late.status, &["does not follow the last one"]);
        let step = component.step_to_event(1e6, 1e6);
        assert_eq!((step.status, step.is_early), (OK, true));
        let late = component.step_to_event(step.reached + 1e-3 * period, 1e6);
        component.assert_refused(late.status, &["does not follow the last one"]);
    }
}

/// Guards: a step without any gap that was refused, for the step before had ended at a tick a little behind it.
#[test]
fn steps_that_follow_exactly_are_taken_at_any_time() {
    for (period, step_size) in [(0.01, 1.1e-5), (1e-3, 7e-6)] {
        let choices = Choices { event_mode: true, early_return: true, intermediate_update: None };
        let component = Component::co_simulation("MaglevRigController", choices);
        assert_eq!(component.set("sample_time", period), OK);
        component.initialise(1.7e9);
        component.settle_event();
        assert_eq!(component.enter_step_mode(), OK);
        let mut time = 1.7e9;
        for k in 0..10_000 {
            let step = component.step_to_event(time, step_size);
            assert_eq!(step.status, OK, "{period} {k}: {:?}", component.recorder.messages().last());
            time = step.reached;
            if step.is_event {
                assert_eq!(component.enter_event_mode(), OK);
                component.settle_event();
                assert_eq!(component.enter_step_mode(), OK);
                component.recorder.clear();
            }
        }
    }
}

/// Guards: gaps that were made up for in one step, which was then longer than the longest, and ticks that ran early where a
/// few units in the last place of the time are more than a clock takes for a tick's.
#[test]
fn gaps_that_are_made_up_for_hurt_no_limit() {
    for (start, denominator, digits, sample_time) in
        [(1e4, 900.0, 9, 1e-3), (1e8, 6000.0, 6, 1e-3), (0.0, 3000.0, 9, 1e-3), (1e5, 6e6, 7, 1e-6)]
    {
        let h: f64 = format!("{:.digits$e}", 1.0 / denominator).parse().unwrap();
        let component = Component::with_logging(Standard::Fmi2, "MaglevRigController", false);
        assert_eq!(component.set("sample_time", sample_time), OK);
        assert_eq!(component.set("longest_step", h.max(1e-6)), OK);
        component.initialise(start);
        for k in 0..200_000 {
            let time = start + f64::from(k) / denominator;
            assert_eq!(
                component.step(time, h),
                OK,
                "{start} {k}: {:?}",
                component.recorder.messages().last()
            );
            let ahead = component.get("tick_time") - time;
            let bound = 1e-4 * sample_time + 8.0 * f64::EPSILON * start;
            // Every tick lies at the begin of a step, but for steps that are longer than a sample time.
            let is_in_time = ahead <= bound || h > sample_time;
            assert!(is_in_time && ahead > -sample_time - bound, "{start} {k}: {ahead}");
        }
    }
}

/// Guards: a billionth of a long step that was accepted before a short one, of which it was nearly all.
#[test]
fn a_gap_is_rounding_to_the_step_before_and_to_the_step_after_it() {
    for standard in BOTH {
        let plant = Component::new(standard, PLANT);
        plant.initialise(0.0);
        assert_eq!(plant.step(0.0, 1e6), OK);
        plant.recorder.clear();
        let late = plant.step(1e6 + 9e-4, 1e-3);
        plant.assert_refused(late, &["does not follow the last one"]);
        assert_eq!(plant.step(1e6, 1e-3), OK);
    }
}
