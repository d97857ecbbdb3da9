//! The maglev rig against a trajectory of an independent prototype: PID loop, sine and step of the reference, three
//! observers.

use maglev_fmu::model::system::RIG;
use maglev_fmu::observer::extended_state::{
    ExtendedState, ExtendedStateModel, LinearInjection, gains_from_bandwidth,
};
use maglev_fmu::observer::extended_state_exact::ExactPredictor;
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::rig::{CURRENT, MATCHED, METRES, NONLINEAR, RUNGE_KUTTA, ZERO};
use maglev_fmu_test::values::{get, set};

use super::experiment::{SENSOR, T, data_run, sine_step, table_4};

/// Rows every 5 ms over 4 s: time, reference, x, x', sensor and coil voltage, then z1, z2, z3 of LESO and NESO in metres from
/// zero and of LESO in volts, matched.
fn reference() -> Vec<[f64; 15]> {
    include_str!("../../reference/rig_sine_step.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
            numbers.try_into().expect("15 columns")
        })
        .collect()
}

/// Largest difference of each column relative to the column's largest magnitude.
fn assert_columns_match(own: &[Vec<f64>], columns: &[usize], relative: f64) {
    let reference = reference();
    assert_eq!(own.len(), reference.len());
    for (index, column) in columns.iter().enumerate() {
        let scale = reference.iter().fold(0.0f64, |scale, row| scale.max(row[*column].abs()));
        let largest = own
            .iter()
            .zip(&reference)
            .fold(0.0f64, |largest, (own, row)| largest.max((own[index] - row[*column]).abs()));
        assert!(largest <= relative * scale, "column {column}: {largest:e} of {scale:e}");
    }
}

#[test]
fn native_loop_and_observers_match_the_reference() {
    let run = data_run(sine_step, 9e-3, 4000, 0.0);
    let metres = |injection: LinearInjection| ExtendedStateModel { injection, input_gain: 1.0 };
    let linear = metres(LinearInjection::from_bandwidth(100.0));
    let nonlinear = ExtendedStateModel { injection: table_4(), input_gain: 1.0 };
    let exact = ExactPredictor::new(gains_from_bandwidth(100.0), 1.0, T);
    let mut z = [ExtendedState::default(); 3];
    z[2].position = run[0].sensor_voltage;
    let mut rows = Vec::new();
    for (k, sample) in run.iter().enumerate() {
        if k > 0 {
            let before = run[k - 1];
            let u = before.voltage;
            let (start, end) = (before.state.position, sample.state.position);
            z[0] = linear.runge_kutta(z[0], (start, end), u, T, 1);
            z[1] = nonlinear.runge_kutta(z[1], (start, end), u, T, 1);
            z[2] = exact.step(z[2], before.sensor_voltage, u);
        }
        if k % 5 == 0 {
            let state = [
                k as f64 * T,
                sample.reference,
                sample.state.position,
                sample.state.velocity,
                sample.sensor_voltage,
                sample.voltage,
            ];
            let estimates = z.iter().flat_map(|z| [z.position, z.velocity, z.extended]);
            rows.push(state.into_iter().chain(estimates).collect::<Vec<f64>>());
        }
    }
    assert_columns_match(&rows, &(0..15).collect::<Vec<_>>(), 1e-9);
    assert_eq!(SENSOR.voltage(9e-3), -1.50868);
}

/// Rows as in the reference, with the estimates of one observer, from a run through the models.
fn model_rows(controller: &[(&str, f64)]) -> Vec<Vec<f64>> {
    let mut rig = closed_loop(&RIG, &[], controller);
    let mut rows = Vec::new();
    for k in 0..4000 {
        let time = f64::from(k) * T;
        let reference = SENSOR.voltage(9e-3) + sine_step(time);
        set(&mut *rig.controller, "reference", reference);
        let plant = ["position", "velocity", "sensor_voltage"].map(|name| get(&*rig.plant, name));
        rig.step_controller().unwrap();
        if k % 5 == 0 {
            let controller = ["voltage", "estimate.position", "estimate.velocity", "estimate.extended"]
                .map(|name| get(&*rig.controller, name));
            rows.push([&[time, reference][..], &plant, &controller].concat());
        }
        rig.step_plant().unwrap();
    }
    rows
}

#[test]
fn models_match_the_reference() {
    let paper = [
        ("observer.measurement", METRES),
        ("observer.initial", ZERO),
        ("observer.discretisation", RUNGE_KUTTA),
        ("observer.form", CURRENT),
    ];
    let nonlinear = [&paper[..], &[("observer.kind", NONLINEAR)]].concat();
    for (controller, estimate) in
        [(&paper[..], [6, 7, 8]), (&nonlinear, [9, 10, 11]), (&[("observer.initial", MATCHED)], [12, 13, 14])]
    {
        let columns = [&[0, 1, 2, 3, 4, 5][..], &estimate].concat();
        assert_columns_match(&model_rows(controller), &columns, 1e-9);
    }
}
