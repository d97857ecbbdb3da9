//! Closed loops of the maglev rig: poles against their closed forms, PID against the loop through the extended state,
//! and what goes wrong cleanly.

use maglev_fmu::model::{ClosedLoop, NullLogSink, system};
use maglev_fmu::observer::extended_state::{ExtendedState, gains_from_bandwidth};
use maglev_fmu::observer::extended_state_exact::ExactPredictor;
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::rig::{
    APPLIED, CURRENT, DISTURBANCE_REJECTION, EULER, METRES, NONLINEAR, THROUGH_EXTENDED_STATE,
};
use maglev_fmu_test::values::{get, set};
use nalgebra::{Complex, Matrix3, Matrix4, Matrix5, Vector2};

use super::experiment::{RIG, SENSOR, T, root_mean_square};

const SET_POINT: f64 = 9e-3;
/// Table 2.
const PID: [f64; 3] = [4.2, 2.2, 0.02];

/// p^2 \[1/s2\] and the magnitude of the input gain in sensor volts \[1/s2\] at the set point.
fn linear_model() -> (f64, f64) {
    let linear = RIG.linearised(SET_POINT);
    (linear.stiffness, -SENSOR.gain * linear.input_gain)
}

/// Roots of s^3 + a2 s^2 + a1 s + a0.
fn roots(a2: f64, a1: f64, a0: f64) -> [Complex<f64>; 3] {
    Matrix3::new(-a2, -a1, -a0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0).complex_eigenvalues().into()
}

/// The root with the largest real part.
fn rightmost(roots: impl IntoIterator<Item = Complex<f64>>) -> Complex<f64> {
    roots.into_iter().max_by(|one, other| one.re.total_cmp(&other.re)).unwrap()
}

fn assert_near(value: f64, expected: f64, absolute: f64, what: &str) {
    assert!((value - expected).abs() <= absolute, "{what}: {value} instead of {expected}");
}

#[test]
fn pid_loop_has_the_poles_of_the_reconstruction() {
    let (p2, b) = linear_model();
    assert_near(p2, 2177.78, 2177.78e-5, "p^2");
    assert_near(b, 3705.41, 3705.41e-5, "input gain");
    let [kp, ki, kd] = PID;
    let poles = |b: f64| roots(b * kd, b * kp - p2, b * ki);
    let in_volts = poles(b);
    let slow = rightmost(in_volts);
    assert_near(slow.re, -0.61109, 1e-4 * 0.61109, "slow pole");
    let pair = in_volts.iter().find(|pole| pole.im > 1.0).unwrap();
    assert_near(pair.re, -36.7486, 1e-4 * 36.7, "pair");
    assert_near(pair.im, 109.497, 1e-4 * 109.5, "pair");
    // With the position in metres the gains are too small; with the usual error r - y the sign is wrong.
    assert_near(rightmost(poles(b / SENSOR.gain)).re, 45.218, 1e-4 * 45.2, "metres");
    assert!(rightmost(poles(-b)).re > 0.0, "wrong sign");
    // A coil driven by voltage lags with L / R = 0.277 H / 22 ohm: (s^2 - p^2)(lag s + 1) s + b (Kd s^2 + Kp s + Ki).
    let lag = 0.277 / 22.0;
    let [a3, a2, a1, a0] = [1.0 / lag, b * kd / lag - p2, (b * kp - p2) / lag, b * ki / lag];
    #[rustfmt::skip]
    let companion = Matrix4::new(
        -a3, -a2, -a1, -a0,
        1.0, 0.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0,
        0.0, 0.0, 1.0, 0.0,
    );
    let eigenvalues: [Complex<f64>; 4] = companion.complex_eigenvalues().into();
    assert_near(rightmost(eigenvalues).re, 21.1, 0.05, "voltage-driven coil");
}

/// The linearised rig over one sample with held voltage, in sensor volts: x+ = F x + g u.
fn sampled_plant() -> ([[f64; 2]; 2], Vector2<f64>) {
    let (p2, b) = linear_model();
    let p = p2.sqrt();
    let (cosh, sinh) = ((p * T).cosh(), (p * T).sinh());
    ([[cosh, sinh / p], [p * sinh, cosh]], Vector2::new(-b * (cosh - 1.0) / p2, -b * sinh / p))
}

fn largest_magnitude(eigenvalues: &[Complex<f64>]) -> f64 {
    eigenvalues.iter().fold(0.0, |largest, value| value.norm_sqr().sqrt().max(largest))
}

/// Spectral radius of the sampled PID loop, with `sign` = 1 for e = y - r.
fn pid_radius(sign: f64) -> f64 {
    let ([kp, ki, kd], (f, g)) = (PID.map(|gain| sign * gain), sampled_plant());
    // State (y, y', sum of e before, e before); u = (Kp + Ki T + Kd / T) y + Ki sum - Kd / T e before.
    let u = [kp + ki * T + kd / T, 0.0, ki, -kd / T];
    let row = |i: usize| {
        let own = [f[i][0], f[i][1], 0.0, 0.0];
        core::array::from_fn::<f64, 4, _>(|column| own[column] + g[i] * u[column])
    };
    let rows = [row(0), row(1), [T, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
    largest_magnitude(Matrix4::from(rows).transpose().complex_eigenvalues().as_slice())
}

#[test]
fn sampled_pid_loop_is_as_fast_as_its_integral() {
    assert_near(pid_radius(1.0), 0.99939, 1e-5, "e = y - r");
    assert_near(pid_radius(-1.0), 1.178, 1e-3, "e = r - y");
    // The models' loop decays by that per sample, once the fast poles are over.
    let mut rig = closed_loop(&system::RIG, &[], &[]);
    set(&mut *rig.plant, "force", 1e-4);
    let mut voltage = || {
        (0..1000).for_each(|_| rig.step().unwrap());
        get(&*rig.plant, "sensor_voltage") - SENSOR.voltage(SET_POINT)
    };
    let decay = (voltage() / voltage()).powf(-1e-3);
    assert_near(decay, pid_radius(1.0), 1e-5, "models");
}

/// Spectral radius of the loop through the exact predictor, for the true rig.
fn extended_state_radius(observer: f64, law: f64, b0: f64) -> f64 {
    let (f, g) = sampled_plant();
    let z = ExactPredictor::new(gains_from_bandwidth(observer), b0, T);
    // State (y, y', z); u = -(wc^2 z1 + 2 wc z2 + z3) / b0.
    let u = [0.0, 0.0, -law * law / b0, -2.0 * law / b0, -1.0 / b0];
    let with_input = |own: [f64; 5], gain: f64| core::array::from_fn::<f64, 5, _>(|i| own[i] + gain * u[i]);
    let observed = |i: usize| {
        let [first, second, third] = z.transition[i];
        with_input([z.measurement[i], 0.0, first, second, third], z.input[i])
    };
    let plant = |i: usize| with_input([f[i][0], f[i][1], 0.0, 0.0, 0.0], g[i]);
    let rows = [plant(0), plant(1), observed(0), observed(1), observed(2)];
    largest_magnitude(Matrix5::from(rows).transpose().complex_eigenvalues().as_slice())
}

#[test]
fn loop_through_the_extended_state_has_the_radius_of_the_reconstruction() {
    assert_near(extended_state_radius(300.0, 60.0, -3705.0), 0.9661, 1e-3, "wo = 300, wc = 60");
    assert_near(extended_state_radius(100.0, 40.0, -3705.0), 1.0036, 1e-4, "wo = 100, wc = 40");
    for factor in [0.4, 2.0] {
        assert!(extended_state_radius(300.0, 60.0, -3705.0 * factor) < 1.0, "b0 / b = {factor}");
    }
    assert_near(extended_state_radius(100.0, 40.0, 1.0), 4.06, 5e-3, "wo = 100, wc = 40, b0 = 1");
    assert!(extended_state_radius(100.0, 60.0, 1.0) > 4.0, "wo = 100, wc = 60, b0 = 1");
}

/// Error of the sensor voltage \[V\] at each sample for 2 s after a force step of 1 m/s2 times the mass.
fn force_step(controller: &[(&str, f64)]) -> Vec<f64> {
    let mut rig = closed_loop(&system::RIG, &[], controller);
    set(&mut *rig.plant, "force", 0.02);
    (0..2000)
        .map(|_| {
            let error = get(&*rig.plant, "sensor_voltage") - SENSOR.voltage(SET_POINT);
            rig.step().unwrap();
            error
        })
        .collect()
}

#[test]
fn disturbance_rejection_beats_pid_threefold() {
    let (pid, rejection) = (force_step(&[]), force_step(&THROUGH_EXTENDED_STATE));
    let rms = [&pid, &rejection].map(|errors| root_mean_square(errors.iter().copied()));
    let peak = [&pid, &rejection].map(|errors| errors.iter().fold(0.0f64, |peak, e| peak.max(e.abs())));
    println!("rms {rms:?} V, peak {peak:?} V");
    assert!(rms[0] > 3.0 * rms[1], "{rms:?}");
    // 6.46 and 1.81 mV rms, 14.3 and 14.4 mV peak in the prototype.
    for (value, expected) in rms.iter().chain(&peak).zip([6.46e-3, 1.81e-3, 14.3e-3, 14.4e-3]) {
        assert_near(*value, expected, 0.01 * expected, "prototype");
    }
}

/// Runs a loop for some seconds and checks at each step that all values are finite and the voltage is allowed;
/// returns whether the ball has touched a stop.
fn run_finitely(rig: &mut ClosedLoop, seconds: f64, what: &str) -> bool {
    let mut touched = false;
    for _ in 0..(seconds / T) as usize {
        rig.step().unwrap();
        let finite = rig.plant.values().iter().chain(rig.controller.values()).all(|value| value.is_finite());
        assert!(finite, "{what}: {:?} {:?}", rig.plant.values(), rig.controller.values());
        assert!((0.0..=5.0).contains(&get(&*rig.controller, "voltage")), "{what}");
        touched |= get(&*rig.plant, "contact") != 0.0;
    }
    touched
}

#[test]
fn input_gain_of_the_paper_loses_the_ball_cleanly() {
    for bandwidth in [100.0, 300.0] {
        let controller = [
            ("controller.kind", DISTURBANCE_REJECTION),
            ("controller.input_gain", 1.0),
            ("observer.bandwidth", bandwidth),
        ];
        let mut rig = closed_loop(&system::RIG, &[], &controller);
        assert!(run_finitely(&mut rig, 2.0, "b0 = 1"), "the ball is still in the air");
    }
}

/// Controller parameters of all observers: kind, discretisation, form and measurement.
fn all_observers() -> impl Iterator<Item = [(&'static str, f64); 4]> {
    let combinations = (0..24).map(|index| [index / 12, index / 4 % 3, index / 2 % 2, index % 2]);
    let names = ["observer.kind", "observer.discretisation", "observer.form", "observer.measurement"];
    combinations.map(move |choice| core::array::from_fn(|i| (names[i], f64::from(choice[i] + 1))))
}

#[test]
fn every_observer_watches_the_pid_loop() {
    let reference = |k: u32| SENSOR.voltage(SET_POINT) + 0.1 * (6.0 * f64::from(k) * T).sin();
    for choice in all_observers() {
        let limit_cycles = choice[0].1 == NONLINEAR && choice[1].1 == EULER;
        let mut rig =
            closed_loop(&system::RIG, &[], &[&choice[..], &[("observer.voltage_source", APPLIED)]].concat());
        let mut worst = [0.0f64; 2];
        for k in 0..3000 {
            set(&mut *rig.controller, "reference", reference(k));
            let truth = ["position", "velocity"].map(|name| get(&*rig.plant, name));
            rig.step().unwrap();
            let estimate =
                ["estimate.si.position", "estimate.si.velocity"].map(|name| get(&*rig.controller, name));
            for index in 0..2 {
                worst[index] = worst[index].max((truth[index] - estimate[index]).abs());
            }
        }
        assert_eq!(get(&*rig.plant, "contact"), 0.0);
        assert_eq!(get(&*rig.controller, "observer.restarts"), 0.0, "{choice:?}");
        // b = 1 tells the observer next to nothing: millimetres per second, but for the limit cycle of metres.
        let bound = if limit_cycles { [0.1, 30.0] } else { [5e-4, 2e-2] };
        assert!(worst[0] < bound[0] && worst[1] < bound[1], "{choice:?}: {worst:?}");
    }
}

#[test]
fn every_observer_closes_the_loop_without_a_value_that_is_not_finite() {
    for choice in all_observers() {
        let in_metres = choice[3].1 == METRES;
        let input_gain = if in_metres { -3705.0 / SENSOR.gain } else { -3705.0 };
        let controller =
            [&THROUGH_EXTENDED_STATE[..2], &[("observer.input_gain", input_gain)], &choice].concat();
        let mut rig = closed_loop(&system::RIG, &[("sensor.noise", 1e-4)], &controller);
        let touched = run_finitely(&mut rig, 2.0, &format!("{choice:?}"));
        if choice[0].1 != NONLINEAR {
            assert!(!touched, "{choice:?}");
        }
    }
}

#[test]
fn diverging_observer_starts_anew_and_is_counted() {
    for form in [1.0, CURRENT] {
        let controller =
            [("observer.discretisation", EULER), ("observer.bandwidth", 5000.0), ("observer.form", form)];
        let mut rig = closed_loop(&system::RIG, &[("sensor.noise", 1e-4)], &controller);
        assert!(!run_finitely(&mut rig, 1.0, "diverging observer"), "the PID does not use the observer");
        assert!(get(&*rig.controller, "observer.restarts") > 1.0);
    }
}

#[test]
fn pid_catches_the_ball_from_4_to_14_millimetres() {
    // From 16 mm the ball hits the coil first. The output has fallen to 0 by then, so that it comes off and is caught.
    for (start, hits) in [(4e-3, false), (6e-3, false), (12e-3, false), (14e-3, false), (16e-3, true)] {
        let mut rig = closed_loop(&system::RIG, &[("initial.position", start)], &[]);
        let mut closest = f64::MAX;
        for _ in 0..4000 {
            rig.step().unwrap();
            closest = closest.min(get(&*rig.plant, "position"));
        }
        assert_eq!(closest < 1.01e-3, hits, "from {start} m: {closest} m from the coil");
        let distance = (get(&*rig.plant, "position") - SET_POINT).abs();
        assert!(distance < 1e-4, "from {start} m: {distance} m away");
    }
}

#[test]
fn edge_of_the_reference_kicks_unless_the_derivative_is_of_the_measurement() {
    let closest = |controller: &[(&str, f64)]| {
        let mut rig = closed_loop(&system::RIG, &[], controller);
        let mut closest = f64::MAX;
        for k in 0..2000 {
            let edge = if k < 500 { 0.1 } else { -0.1 };
            set(&mut *rig.controller, "reference", SENSOR.voltage(SET_POINT) + edge);
            rig.step().unwrap();
            closest = closest.min(get(&*rig.plant, "position"));
        }
        assert!((get(&*rig.plant, "position") - SET_POINT + 0.1 / SENSOR.gain).abs() < 5e-4);
        closest
    };
    let (kicked, quiet) = (closest(&[]), closest(&[("controller.derivative", 2.0)]));
    let filtered = closest(&[("controller.reference_filter", 20.0)]);
    println!("closest to the coil: {kicked}, {quiet}, {filtered} m");
    assert!(kicked < 6e-3 && quiet > kicked + 1e-3 && filtered > 7.5e-3);
}

#[test]
fn law_may_change_while_the_ball_floats() {
    let mut rig = closed_loop(&system::RIG, &[], &THROUGH_EXTENDED_STATE);
    for law in [DISTURBANCE_REJECTION, 1.0, DISTURBANCE_REJECTION, 1.0] {
        set(&mut *rig.controller, "controller.kind", law);
        rig.controller.apply_tunable_parameters();
        assert!(!run_finitely(&mut rig, 0.5, "change of law"));
    }
    assert!((get(&*rig.plant, "position") - SET_POINT).abs() < 1e-5);
}

#[test]
fn filtered_reference_is_followed_through_the_extended_state() {
    let run = |filter: f64| {
        let controller = [&THROUGH_EXTENDED_STATE[..], &[("controller.reference_filter", filter)]].concat();
        let mut rig = closed_loop(&system::RIG, &[], &controller);
        rig.step().unwrap();
        set(&mut *rig.controller, "reference", SENSOR.voltage(SET_POINT) + 0.2);
        let mut overshoot = 0.0f64;
        for _ in 0..1000 {
            rig.step().unwrap();
            overshoot = overshoot.max(get(&*rig.plant, "sensor_voltage") - SENSOR.voltage(SET_POINT) - 0.2);
        }
        let error = get(&*rig.plant, "sensor_voltage") - SENSOR.voltage(SET_POINT) - 0.2;
        assert!(error.abs() < 1e-4, "{error}");
        overshoot
    };
    let (stepped, filtered) = (run(0.0), run(20.0));
    assert!(filtered < 0.01 && filtered < stepped, "{filtered} {stepped}");
}

#[test]
fn applied_voltage_makes_the_observer_right_when_both_models_step_at_once() {
    // Jacobi's order: both models see the other's outputs of the step before, so that the voltage acts a step late.
    // What the observer should say, from the voltage that truly acted.
    let predictor = ExactPredictor::new(gains_from_bandwidth(300.0), -3705.0, T);
    let difference = |source: f64| {
        let controller = [&THROUGH_EXTENDED_STATE[1..], &[("observer.voltage_source", source)]].concat();
        let mut rig = closed_loop(&system::RIG, &[("sensor.noise", 3e-4)], &controller);
        let mut before = None;
        let mut largest = 0.0f64;
        for _ in 0..2000 {
            let voltage = get(&*rig.controller, "voltage");
            let measured = get(&*rig.plant, "sensor_voltage_measured");
            rig.step_controller().unwrap();
            let z = ["estimate.position", "estimate.velocity", "estimate.extended"]
                .map(|name| get(&*rig.controller, name));
            if let Some((z_before, measured_before, acted)) = before {
                let expected = predictor.step(z_before, measured_before, acted);
                largest = largest.max((expected.velocity - z[1]).abs());
            }
            set(&mut *rig.plant, "voltage", voltage);
            rig.plant.advance(T, &mut NullLogSink).unwrap();
            let state = ExtendedState { position: z[0], velocity: z[1], extended: z[2] };
            before = Some((state, measured, voltage));
        }
        largest
    };
    assert_eq!(difference(APPLIED), 0.0);
    assert!(difference(1.0) > 1e-2, "the command acts a step later than the observer believes");
}
