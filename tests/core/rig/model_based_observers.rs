//! The rig's observers that know a model, Kalman filter and windowed Newton, through the models: what they estimate, what
//! they bear, and the loop through their extended state.

use maglev_fmu::model::NullLogSink;
use maglev_fmu::model::system;
use maglev_fmu::plant::maglev_rig::MaglevRig;
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::rig::{APPLIED, KALMAN, METRES, THROUGH_EXTENDED_STATE, WINDOWED_NEWTON, ZERO};
use maglev_fmu_test::values::{get, set};

use super::experiment::{RIG, SENSOR, T, root_mean_square, sine_step};

const SET_POINT: f64 = 9e-3;
const KINDS: [f64; 2] = [KALMAN, WINDOWED_NEWTON];

/// Parameters of a loop through the extended state; what comes later goes before.
fn through(kind: f64, more: &[(&'static str, f64)]) -> Vec<(&'static str, f64)> {
    [&THROUGH_EXTENDED_STATE[..], &[("observer.kind", kind)], more].concat()
}

/// rms errors of velocity \[m/s\] and acceleration \[m/s2\] from 0.5 s on of an observer that watches a PID loop whose
/// reference moves, with a force of 1 m/s2 times the mass from 1 s on.
fn watched(plant: &[(&str, f64)], controller: &[(&str, f64)]) -> [f64; 2] {
    let mut rig = closed_loop(&system::RIG, plant, controller);
    let (mut velocity, mut acceleration) = (Vec::new(), Vec::new());
    for k in 0..3000 {
        let time = f64::from(k) * T;
        set(&mut *rig.controller, "reference", SENSOR.voltage(SET_POINT) + sine_step(time));
        let mass = get(&*rig.plant, "mass");
        set(&mut *rig.plant, "force", if time >= 1.0 { mass } else { 0.0 });
        let truth = ["velocity", "voltage", "position"].map(|name| get(&*rig.plant, name));
        rig.step_controller().unwrap();
        if k >= 500 {
            velocity.push(truth[0] - get(&*rig.controller, "estimate.si.velocity"));
            // x'' = extended + b u under the voltage that acted before the sample.
            let force = get(&*rig.plant, "force");
            let true_rig = MaglevRig { mass, ..RIG };
            let scale =
                if get(&*rig.controller, "observer.measurement") == METRES { 1.0 } else { SENSOR.gain };
            let b = get(&*rig.controller, "observer.input_gain") / scale;
            let estimate = get(&*rig.controller, "estimate.si.extended") + b * truth[1];
            acceleration.push(true_rig.acceleration(truth[2], truth[1], force) - estimate);
        }
        rig.step_plant().unwrap();
    }
    assert_eq!(get(&*rig.plant, "contact"), 0.0);
    assert_eq!(get(&*rig.controller, "observer.restarts"), 0.0);
    [velocity, acceleration].map(|errors| root_mean_square(errors.into_iter()))
}

#[test]
fn velocity_and_acceleration_are_estimated_whatever_the_unit_of_measure() {
    let linear = watched(
        &[("sensor.noise", 1e-3)],
        &[("observer.bandwidth", 220.0), ("observer.input_gain", -3705.0)],
    );
    for kind in KINDS {
        let [clean, noisy] = [0.0, 1e-3].map(|noise| {
            let [volts, metres] = [1.0, METRES].map(|measurement| {
                watched(
                    &[("sensor.noise", noise)],
                    &[
                        ("observer.kind", kind),
                        ("observer.measurement", measurement),
                        ("observer.input_gain", 7.0),
                    ],
                )
            });
            for (volts, metres) in volts.iter().zip(metres) {
                assert!((volts / metres - 1.0).abs() < 1e-6, "{volts} {metres}");
            }
            volts
        });
        println!("kind {kind}: clean {clean:?}, noisy {noisy:?}, linear {linear:?}");
        assert!(
            clean[0] < 4e-4 && noisy[0] < 1.2e-3 && noisy[0] < 0.8 * linear[0],
            "{clean:?} {noisy:?} {linear:?}"
        );
        assert!(clean[1] < 0.2 && noisy[1] < 0.5, "{clean:?} {noisy:?}");
    }
}

#[test]
fn a_disturbance_bears_a_wrong_mass_and_without_one_the_model_is_believed() {
    for kind in KINDS {
        let errors = [0.0, 1.0].map(|estimate| {
            let controller = [
                ("observer.kind", kind),
                ("observer.estimate_disturbance", estimate),
                // As long as the one without a disturbance bears.
                ("observer.window", if estimate == 0.0 { 8.0 } else { 24.0 }),
            ];
            watched(&[("mass", 0.024), ("sensor.noise", 1e-4)], &controller)[0]
        });
        println!("kind {kind}: {errors:?}");
        assert!(errors[1] < 1e-3 && errors[0] > 3.0 * errors[1], "kind {kind}: {errors:?}");
    }
    // The mass may as well be told.
    for kind in KINDS {
        let told = [("observer.kind", kind), ("observer.estimate_disturbance", 0.0), ("mass", 0.024)];
        let mut rig = closed_loop(&system::RIG, &[("mass", 0.024)], &told);
        (0..1000).for_each(|_| rig.step().unwrap());
        let error = get(&*rig.plant, "velocity") - get(&*rig.controller, "estimate.si.velocity");
        assert!(error.abs() < 1e-3, "kind {kind}: {error}");
    }
}

#[test]
fn ball_is_held_through_the_extended_state() {
    for kind in KINDS {
        for (mass, measurement) in [(0.02, 1.0), (0.016, 1.0), (0.024, METRES)] {
            let gain = if measurement == METRES { SENSOR.gain } else { 1.0 };
            let controller = through(
                kind,
                &[("observer.measurement", measurement), ("observer.input_gain", -3705.0 / gain)],
            );
            let plant = [("mass", mass), ("sensor.noise", 1e-3), ("initial.position", 9.5e-3)];
            let mut rig = closed_loop(&system::RIG, &plant, &controller);
            for k in 0..3000 {
                if k == 1500 {
                    set(&mut *rig.plant, "force", mass);
                }
                rig.step().unwrap();
                assert!(rig.controller.values().iter().all(|value| value.is_finite()));
                let settled = k % 1500 > 700;
                let off = (get(&*rig.plant, "position") - SET_POINT).abs();
                assert!(!settled || off < 1e-4, "kind {kind}, {mass} kg, step {k}: {off} m off");
            }
            assert_eq!(get(&*rig.plant, "contact"), 0.0);
            assert_eq!(get(&*rig.controller, "observer.restarts"), 0.0);
        }
    }
}

#[test]
fn force_step_is_rejected_better_than_by_the_pid() {
    let rms = |controller: &[(&str, f64)]| {
        let mut rig = closed_loop(&system::RIG, &[], controller);
        set(&mut *rig.plant, "force", 0.02);
        let errors = (0..2000).map(|_| {
            rig.step().unwrap();
            get(&*rig.plant, "sensor_voltage") - SENSOR.voltage(SET_POINT)
        });
        root_mean_square(errors.collect::<Vec<_>>().into_iter())
    };
    let pid = rms(&[]);
    for kind in KINDS {
        let rejection = rms(&through(kind, &[]));
        println!("kind {kind}: {rejection} V against {pid} V");
        assert!(pid > 2.0 * rejection, "kind {kind}: {rejection} V against {pid} V");
    }
}

#[test]
fn a_lost_ball_is_found_again() {
    for kind in KINDS {
        for measurement in [1.0, METRES] {
            let controller =
                [("observer.kind", kind), ("observer.measurement", measurement), ("observer.initial", ZERO)];
            let mut rig = closed_loop(&system::RIG, &[("sensor.noise", 1e-3)], &controller);
            for k in 0..4000 {
                // On the lower stop, then at the coil, then let go.
                let force = [0.0, 5.0, -5.0, 0.0][k / 1000];
                set(&mut *rig.plant, "force", force);
                rig.step().unwrap();
                assert!(
                    rig.controller.values().iter().all(|value| value.is_finite()),
                    "kind {kind}, step {k}"
                );
            }
            assert!((get(&*rig.plant, "position") - SET_POINT).abs() < 3e-4, "the PID has caught the ball");
            let error = get(&*rig.plant, "velocity") - get(&*rig.controller, "estimate.si.velocity");
            let off = get(&*rig.plant, "position") - get(&*rig.controller, "estimate.si.position");
            assert!(error.abs() < 1e-2 && off.abs() < 1e-4, "kind {kind}: {off} m, {error} m/s");
        }
    }
}

/// Guards: a Kalman filter without a disturbance that ran away after wrong readings and never came back.
#[test]
fn wrong_readings_are_forgotten() {
    for (kind, disturbance) in KINDS.into_iter().flat_map(|kind| [(kind, 0.0), (kind, 1.0)]) {
        for (first, reading) in [(100, 0.0), (100, -2.0), (0, 0.787)] {
            let mut rig = closed_loop(
                &system::RIG,
                &[],
                &[("observer.kind", kind), ("observer.estimate_disturbance", disturbance)],
            );
            for k in 0..2000 {
                let is_wrong = (first..first + 30).contains(&k);
                let (seen, held) = (SENSOR.voltage(SET_POINT), RIG.operating_voltage(SET_POINT));
                set(&mut *rig.controller, "sensor_voltage", if is_wrong { reading } else { seen });
                set(&mut *rig.controller, "voltage", held);
                rig.controller.advance(T, &mut NullLogSink).unwrap();
            }
            let off = get(&*rig.controller, "estimate.si.position") - SET_POINT;
            let velocity = get(&*rig.controller, "estimate.si.velocity");
            let case = format!("kind {kind}, disturbance {disturbance}, {reading} V from {first}");
            assert!(off.abs() < 1e-5 && velocity.abs() < 1e-3, "{case}: {off} m, {velocity} m/s");
        }
    }
}

/// Guards: the same after the ball has lain on its stop, which the model does not know.
#[test]
fn a_ball_that_lay_on_its_stop_is_held_again() {
    for (kind, disturbance) in KINDS.into_iter().flat_map(|kind| [(kind, 0.0), (kind, 1.0)]) {
        for law in [1.0, 2.0] {
            let controller = [
                ("controller.kind", law),
                ("observer.input_gain", -3705.0),
                ("observer.kind", kind),
                ("observer.estimate_disturbance", disturbance),
                ("observer.voltage_source", APPLIED),
                ("controller.voltage_max", 0.0),
            ];
            let mut rig = closed_loop(&system::RIG, &[], &controller);
            for k in 0..6000 {
                if k == 500 {
                    assert_eq!(get(&*rig.plant, "contact"), 1.0, "the ball has fallen");
                    set(&mut *rig.controller, "controller.voltage_max", 5.0);
                    rig.controller.apply_tunable_parameters();
                }
                rig.step().unwrap();
            }
            let position = get(&*rig.plant, "position");
            let error = get(&*rig.controller, "estimate.si.position") - position;
            let case = format!("kind {kind}, disturbance {disturbance}, law {law}");
            assert!((position - SET_POINT).abs() < 1e-4, "{case}: {position} m");
            assert!(error.abs() < 1e-5, "{case}: {error} m");
        }
    }
}

#[test]
fn impossible_readings_are_counted_as_restarts() {
    for kind in KINDS {
        let mut rig = closed_loop(&system::RIG, &[], &[("observer.kind", kind), ("observer.initial", ZERO)]);
        (0..100).for_each(|_| rig.step().unwrap());
        assert_eq!(get(&*rig.controller, "observer.restarts"), 0.0);
        for reading in [-1e6, 1e6, -1e6] {
            set(&mut *rig.controller, "sensor_voltage", reading);
            (0..50).for_each(|_| rig.controller.advance(T, &mut NullLogSink).unwrap());
            assert!(rig.controller.values().iter().all(|value| value.is_finite()));
        }
        assert!(get(&*rig.controller, "observer.restarts") >= 1.0, "kind {kind}");
        (0..200).for_each(|_| rig.step().unwrap());
        let off = get(&*rig.plant, "position") - get(&*rig.controller, "estimate.si.position");
        assert!(off.abs() < 1e-4, "kind {kind}: {off}");
    }
}

#[test]
fn tunable_parameters_reach_the_running_observer() {
    for (kind, name, value) in [
        (KALMAN, "observer.sensor_noise", 1e-1),
        (KALMAN, "observer.disturbance_noise", 1e3),
        (WINDOWED_NEWTON, "observer.max_iterations", 1.0),
        (KALMAN, "observer.input_gain", -5.0),
        (WINDOWED_NEWTON, "observer.input_gain", -5.0),
    ] {
        let run = |change: bool| {
            let mut rig = closed_loop(&system::RIG, &[("sensor.noise", 1e-2)], &[("observer.kind", kind)]);
            (0..200).for_each(|_| rig.step().unwrap());
            if change {
                set(&mut *rig.controller, name, value);
                rig.controller.apply_tunable_parameters();
            }
            let before = get(&*rig.controller, "estimate.velocity");
            (0..20).for_each(|_| rig.step().unwrap());
            [before, get(&*rig.controller, "estimate.velocity"), get(&*rig.controller, "estimate.extended")]
        };
        let (kept, changed) = (run(false), run(true));
        assert_eq!(kept[0], changed[0], "what was estimated stays");
        assert_ne!(kept[2], changed[2], "kind {kind}: {name}");
    }
}

#[test]
fn applied_voltage_is_what_the_model_is_told() {
    // Both models step at once, so that the voltage acts a step late.
    for kind in KINDS {
        let errors = [1.0, APPLIED].map(|source| {
            let controller = [
                ("observer.kind", kind),
                ("observer.voltage_source", source),
                ("observer.estimate_disturbance", 0.0),
            ];
            let mut rig = closed_loop(&system::RIG, &[], &controller);
            let mut errors = Vec::new();
            for k in 0..2000 {
                set(
                    &mut *rig.controller,
                    "reference",
                    SENSOR.voltage(SET_POINT) + sine_step(f64::from(k) * T),
                );
                let (voltage, velocity) = (get(&*rig.controller, "voltage"), get(&*rig.plant, "velocity"));
                rig.step_controller().unwrap();
                if k > 100 {
                    errors.push(velocity - get(&*rig.controller, "estimate.si.velocity"));
                }
                set(&mut *rig.plant, "voltage", voltage);
                rig.plant.advance(T, &mut NullLogSink).unwrap();
            }
            root_mean_square(errors.into_iter())
        });
        assert!(errors[1] < 0.2 * errors[0], "kind {kind}: {errors:?}");
    }
}
