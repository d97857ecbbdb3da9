//! Extended state observers of the maglev rig against closed forms, independent references and the paper's Table 5.

use maglev_fmu::observer::extended_state::{
    ExtendedState, ExtendedStateModel, Injection, LinearInjection, gains_from_bandwidth,
};
use maglev_fmu::observer::extended_state_exact::{ExactCorrector, ExactPredictor};
use nalgebra::{Complex, Matrix3, Vector3};

use super::experiment::{RIG, SENSOR, Sample, T, data_run, hold, root_mean_square, sine_step, table_4};

/// LESO of Table 3.
const TABLE_3: ExtendedStateModel<LinearInjection> =
    ExtendedStateModel { injection: LinearInjection::from_bandwidth(100.0), input_gain: 1.0 };

fn assert_close(value: f64, expected: f64, relative: f64, what: &str) {
    assert!((value / expected - 1.0).abs() <= relative, "{what}: {value} instead of {expected}");
}

/// e1 = y - z1 against a constant y = `start` from z = 0 without input: integral of e1^2, peaks of z2 and z3.
fn start_up(injection: impl Injection, start: f64) -> (f64, f64, f64) {
    let model = ExtendedStateModel { injection, input_gain: 1.0 };
    let (mut z, h) = (ExtendedState::default(), 1e-6);
    let (mut integral, mut velocity, mut extended) = (0.0, 0.0f64, 0.0f64);
    for _ in 0..1_000_000 {
        let before = start - z.position;
        z = model.runge_kutta_step(z, [start; 3], 0.0, h);
        let after = start - z.position;
        integral += h / 2.0 * (before * before + after * after);
        velocity = velocity.max(z.velocity);
        extended = extended.max(z.extended);
    }
    (integral, velocity, extended)
}

#[test]
fn start_up_from_zero_follows_the_closed_forms() {
    let (w, e0) = (100.0, 9e-3);
    // e1 = e0 exp(-tau) (1 - 2 tau + tau^2 / 2), z2 = w e0 exp(-tau) (3 tau - tau^2),
    // z3 = w^2 e0 exp(-tau) (tau - tau^2 / 2)
    let mut z = ExtendedState::default();
    for k in 1..=200 {
        z = TABLE_3.runge_kutta(z, (e0, e0), 0.0, T, 50);
        let tau = w * T * f64::from(k);
        let decay = e0 * (-tau).exp();
        let close = |value: f64, expected: f64, scale: f64| {
            assert!((value - expected).abs() < 1e-9 * scale, "tau = {tau}: {value} {expected}")
        };
        close(e0 - z.position, decay * (1.0 - 2.0 * tau + tau * tau / 2.0), e0);
        close(z.velocity, w * decay * (3.0 * tau - tau * tau), w * e0);
        close(z.extended, w * w * decay * (tau - tau * tau / 2.0), w * w * e0);
    }

    let (integral, velocity, extended) = start_up(TABLE_3.injection, e0);
    assert_close(velocity, 0.799_509 * w * e0, 1e-4, "peak of z2");
    assert_close(extended, 0.230_579 * w * w * e0, 1e-4, "peak of z3");
    assert_close(integral, 0.1875 / w * e0 * e0, 1e-3, "integral of e1^2");
    let (integral, velocity, _) = start_up(table_4(), e0);
    assert_close(integral, 2.5695e-3 * e0 * e0, 1e-3, "nonlinear, integral of e1^2");
    assert_close(velocity, 3.931, 1e-3, "nonlinear, peak of z2");
}

#[test]
fn nonlinear_linear_zone_has_the_poles_of_its_gains() {
    // Only with exact frozen gains is a hold of 9 mm within the linear zone of 10 mm a linear system.
    let gains = table_4().frozen(9e-3);
    let characteristic = |s: Complex<f64>| s * s * s + s * s * gains[0] + s * gains[1] + gains[2];
    let newton = |mut s: Complex<f64>| {
        for _ in 0..100 {
            s -= characteristic(s) / (s * s * 3.0 + s * 2.0 * gains[0] + gains[1]);
        }
        s
    };
    let real = newton(Complex::new(-100.0, 0.0));
    let pair = newton(Complex::new(-90.0, 500.0));
    assert!((real - Complex::new(-113.41, 0.0)).norm_sqr().sqrt() < 5e-3, "{real}");
    assert!((pair - Complex::new(-93.30, 519.74)).norm_sqr().sqrt() < 7e-3, "{pair}");
}

#[test]
fn ramp_of_the_disturbance_leaves_the_closed_form_errors() {
    // f' = c: linear e = (c / w^3, 3 c / w^2, 3 c / w); nonlinear e1 = c / (L3 slope), and e2, e3 alike.
    let c = 10.0;
    let steady = |gains: [f64; 3]| {
        let e1 = c / gains[2];
        [e1, gains[0] * e1, gains[1] * e1]
    };
    let expected = steady(gains_from_bandwidth(100.0));
    for (value, closed) in expected.iter().zip([c / 1e6, 3.0 * c / 1e4, 3.0 * c / 100.0]) {
        assert_close(*value, closed, 1e-12, "closed form");
    }
    let nonlinear = ExtendedStateModel { injection: table_4(), input_gain: 1.0 };
    for (error, expected) in
        [(ramp_errors(TABLE_3, c), expected), (ramp_errors(nonlinear, c), steady(table_4().frozen(0.0)))]
    {
        for (error, expected) in error.iter().zip(expected) {
            assert_close(*error, expected, 1e-3, "ramp");
        }
    }
    for (error, closed) in ramp_errors(nonlinear, c).iter().zip([3.16e-8, 9.49e-6, 9.49e-3]) {
        assert_close(*error, closed * c, 2e-3, "figures of the reconstruction");
    }
}

/// Errors after 0.3 s of y''' = c from rest, in steps of 10 us with the exact y at each stage.
fn ramp_errors<I: Injection>(model: ExtendedStateModel<I>, c: f64) -> [f64; 3] {
    let (mut z, h) = (ExtendedState::default(), 1e-5);
    let y = |t: f64| c * t * t * t / 6.0;
    let count = 30_000;
    for k in 0..count {
        let t = h * f64::from(k);
        z = model.runge_kutta_step(z, [y(t), y(t + h / 2.0), y(t + h)], 0.0, h);
    }
    let t = h * f64::from(count);
    [y(t) - z.position, c * t * t / 2.0 - z.velocity, c * t - z.extended]
}

#[test]
fn exact_matrices_are_the_printed_ones() {
    let ExactPredictor { transition, input, measurement } =
        ExactPredictor::new(gains_from_bandwidth(100.0), 1.0, T);
    let expected = [
        [0.728394122, 8.59595547e-4, 4.52418709e-7],
        [-26.2402851, 0.986272786, 9.95321160e-4],
        [-859.595547, -0.452418709, 0.999845347],
    ];
    for (row, expected) in transition.iter().zip(expected) {
        for (value, expected) in row.iter().zip(expected) {
            assert_close(*value, expected, 1e-8, "Ad");
        }
    }
    for (value, expected) in input.iter().zip([4.52418709e-7, 9.95321160e-4, -1.54653070e-4]) {
        assert_close(*value, expected, 1e-8, "Bd, input");
    }
    for (value, expected) in measurement.iter().zip([0.271605878, 26.2402851, 859.595547]) {
        assert_close(*value, expected, 1e-8, "Bd, measurement");
    }
    let current = ExactCorrector::new(gains_from_bandwidth(100.0), 1.0, T).gains;
    for (value, expected) in current.iter().zip([0.259181779, 25.8750744, 861.784444]) {
        assert_close(*value, expected, 1e-8, "current form");
    }
}

/// Standard deviations of z per unit of white measurement noise, from z+ = F z + g y: sum of F^k g g' F'^k.
fn noise_gains(transition: Matrix3<f64>, measurement: Vector3<f64>) -> [f64; 3] {
    let (mut vector, mut variances) = (measurement, Vector3::zeros());
    for _ in 0..20_000 {
        variances += vector.component_mul(&vector);
        vector = transition * vector;
    }
    [variances[0].sqrt(), variances[1].sqrt(), variances[2].sqrt()]
}

#[test]
fn noise_gains_are_those_of_the_reconstruction() {
    let check = |what: &str, gains: [f64; 3], expected: [f64; 3], relative: f64| {
        for (gain, expected) in gains.iter().zip(expected) {
            assert_close(*gain, expected, relative, what);
        }
    };
    let exact = |gains| {
        let predictor = ExactPredictor::new(gains, 1.0, T);
        let transition = Matrix3::from(predictor.transition).transpose();
        noise_gains(transition, Vector3::from(predictor.measurement))
    };
    let [l1, l2, l3] = gains_from_bandwidth(100.0);
    // Computed with 60 decimal digits; the reconstruction prints six of them.
    let expected = [0.453_214_731_435_014, 41.676_452_923_813_16, 1_363.044_590_295_348_6];
    check("exact", exact([l1, l2, l3]), expected, 1e-12);
    check("nonlinear, linear zone", exact(table_4().frozen(0.0)), [0.9517, 483.2, 49931.0], 1e-4);
    let euler = Matrix3::identity() + Matrix3::new(-l1, 1.0, 0.0, -l2, 0.0, 1.0, -l3, 0.0, 0.0) * T;
    check("euler", noise_gains(euler, Vector3::new(l1, l2, l3) * T), [0.4864, 46.71, 1557.0], 3e-4);

    let corrector = ExactCorrector::new([l1, l2, l3], 1.0, T);
    let after = |position, velocity, extended, measurement| {
        let z = corrector.step(ExtendedState { position, velocity, extended }, measurement, 0.0);
        Vector3::new(z.position, z.velocity, z.extended)
    };
    let columns = [after(1.0, 0.0, 0.0, 0.0), after(0.0, 1.0, 0.0, 0.0), after(0.0, 0.0, 1.0, 0.0)];
    let current = noise_gains(Matrix3::from_columns(&columns), after(0.0, 0.0, 0.0, 1.0));
    check("current form", current, [0.4358, 41.11, 1366.0], 4e-4);
}

/// z after so many seconds of forward Euler against y = 0.
fn euler_run(duration: f64, seconds: f64, mut each: impl FnMut(ExtendedState)) -> ExtendedState {
    let model = ExtendedStateModel { injection: table_4(), input_gain: 1.0 };
    let mut z = ExtendedState { position: 1e-4, ..ExtendedState::default() };
    for _ in 0..(seconds / duration) as usize {
        z = model.euler_step(z, 0.0, 0.0, duration);
        each(z);
    }
    z
}

#[test]
fn nonlinear_by_euler_limit_cycles_at_a_millisecond() {
    assert!(euler_run(0.60e-3, 20.0, |_| ()).position.abs() < 1e-12);
    let (mut positions, mut samples) = (Vec::new(), Vec::new());
    let last = euler_run(1e-3, 20.0, |z| positions.push(z.position));
    samples.extend_from_slice(&positions[10_000..]);
    let rms = root_mean_square(samples.iter().copied());
    assert_close(rms, 0.0163, 0.02, "limit cycle");
    assert!(last.largest_magnitude() < 1e4, "bounded: {last:?}");
}

#[test]
fn critical_step_of_euler_is_that_of_the_poles() {
    // Forward Euler of the linear zone: |1 + T s| = 1 at T = -2 Re s / |s|^2.
    let frozen = LinearInjection { gains: table_4().frozen(0.0) };
    let decays = |duration: f64| {
        let model = ExtendedStateModel { injection: frozen, input_gain: 1.0 };
        let mut z = ExtendedState { position: 1.0, ..ExtendedState::default() };
        let mut size = [0.0; 2];
        for size in &mut size {
            let mut largest = 0.0f64;
            for _ in 0..200_000 {
                z = model.euler_step(z, 0.0, 0.0, duration);
                largest = largest.max(z.position.abs());
            }
            *size = largest;
        }
        size[1] < size[0]
    };
    assert!(decays(0.66917e-3 * (1.0 - 1e-4)) && !decays(0.66917e-3 * (1.0 + 1e-4)));
    // One Runge-Kutta step per millisecond is stable.
    let model = ExtendedStateModel { injection: table_4(), input_gain: 1.0 };
    let mut z = ExtendedState { position: 1e-4, ..ExtendedState::default() };
    for _ in 0..2000 {
        z = model.runge_kutta_step(z, [0.0; 3], 0.0, T);
    }
    assert!(z.position.abs() < 1e-12, "{z:?}");
}

/// rms of x - z1 in metres from z(0) = 0 by one Runge-Kutta step per ms, and of the data run.
fn table_5(injection: impl Injection, run: &[Sample]) -> f64 {
    let model = ExtendedStateModel { injection, input_gain: 1.0 };
    let mut z = ExtendedState::default();
    let mut errors = vec![run[0].state.position];
    for pair in run.windows(2) {
        let (start, end) = (pair[0].state.position, pair[1].state.position);
        z = model.runge_kutta_step(z, [start, 0.5 * (start + end), end], pair[0].voltage, T);
        errors.push(end - z.position);
    }
    root_mean_square(errors.into_iter())
}

#[test]
fn table_5_is_the_start_up_transient() {
    let run = data_run(hold, 8.5e-3, 2001, 0.0);
    let (linear, nonlinear) = (table_5(TABLE_3.injection, &run), table_5(table_4(), &run));
    assert_close(linear, 2.9797e-4, 0.01, "LESO");
    assert_close(nonlinear, 3.36361e-4, 0.01, "NESO");
    assert!((nonlinear / linear - 1.1330).abs() < 0.002, "ratio {}", nonlinear / linear);
}

/// Ratio NESO to LESO of the rms errors of z1, z2, z3 in volts around the set point, after the first second: LESO by the
/// exact predictor, NESO by Runge-Kutta in 20 sub-steps with the measurement held, both starting matched.
fn ratios(reference: fn(f64) -> f64, noise: f64) -> [f64; 3] {
    let set_point = 9e-3;
    let run = data_run(reference, set_point, 10_001, noise);
    let (y0, u0) = (SENSOR.voltage(set_point), RIG.operating_voltage(set_point));
    let exact = ExactPredictor::new(TABLE_3.injection.gains, 1.0, T);
    let model = ExtendedStateModel { injection: table_4(), input_gain: 1.0 };
    let start = ExtendedState { position: run[0].sensor_voltage - y0, ..ExtendedState::default() };
    let (mut linear, mut nonlinear) = (start, start);
    let mut errors = [const { Vec::new() }; 6];
    for (k, sample) in run.iter().enumerate() {
        let (y, u) = (sample.sensor_voltage - y0, sample.voltage - u0);
        if k >= 1000 {
            let truth = [
                SENSOR.voltage(sample.state.position) - y0,
                SENSOR.gain * sample.state.velocity,
                SENSOR.gain * sample.acceleration() - u,
            ];
            for (observer, z) in [linear, nonlinear].iter().enumerate() {
                for (index, estimate) in [z.position, z.velocity, z.extended].iter().enumerate() {
                    errors[3 * observer + index].push(truth[index] - estimate);
                }
            }
        }
        linear = exact.step(linear, y, u);
        nonlinear = model.runge_kutta(nonlinear, (y, y), u, T, 20);
    }
    let rms = errors.map(|errors| root_mean_square(errors.into_iter()));
    [rms[3] / rms[0], rms[4] / rms[1], rms[5] / rms[2]]
}

#[test]
fn ranking_flips_with_a_matched_start() {
    let [position, velocity, _] = ratios(sine_step, 0.0);
    assert_close(position, 0.218, 0.02, "N/L of e1");
    assert_close(velocity, 0.172, 0.02, "N/L of e2");
}

#[test]
fn noise_favours_the_linear_observer() {
    let [position, velocity, _] = ratios(hold, 1e-3);
    assert_close(position, 1.77, 0.05, "N/L of e1");
    assert_close(velocity, 4.17, 0.07, "N/L of e2");
}
