//! The continuous loop of the levitated ball against trajectories of an independent prototype of the same
//! equations: sensorless control, a tenth too little flux, every 10 ms for 5 s.

mod literal_ball;

use literal_ball::{Row, Settings, rows};

/// Columns of the data after the time.
const COLUMNS: [&str; 10] = [
    "reference",
    "position",
    "momentum",
    "flux",
    "current",
    "voltage",
    "flux estimate",
    "momentum estimate",
    "position estimate",
    "excitation",
];

fn data(text: &str) -> Vec<[f64; 11]> {
    text.lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            fields.try_into().unwrap()
        })
        .collect()
}

fn columns(row: &Row) -> [f64; 10] {
    [
        row.target.position,
        row.motion.position,
        row.motion.momentum,
        row.motion.flux,
        row.current,
        row.voltage,
        row.estimate.flux,
        row.estimate.momentum,
        row.estimate.position,
        row.scalar.excitation,
    ]
}

/// Largest difference in each column relative to the column's range.
fn differences(settings: Settings, text: &str) -> [f64; 10] {
    let data = data(text);
    let rows = rows(settings, 5.0, 0.01).expect("the ball does not reach the magnet");
    assert_eq!(rows.len(), data.len());
    std::array::from_fn(|column| {
        let values = || data.iter().map(|row| row[column + 1]);
        let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
        let worst = rows
            .iter()
            .zip(values())
            .map(|(row, expected)| (columns(row)[column] - expected).abs())
            .fold(0.0, f64::max);
        println!("step {:e} s, {}: {:.1e} of its range", settings.step, COLUMNS[column], worst / range);
        worst / range
    })
}

const SINUSOIDS: &str = include_str!("reference/ball_sinusoids.csv");
const STEPS: &str = include_str!("reference/ball_steps.csv");

fn same_scheme(settings: Settings, text: &str) {
    let differences = differences(Settings { step: 5e-5, ..settings }, text);
    assert!(differences.iter().all(|&difference| difference < 1e-6), "{differences:?}");
}

fn finer_scheme(settings: Settings, text: &str) {
    let differences = differences(Settings { step: 2.5e-5, ..settings }, text);
    assert!(differences.iter().all(|&difference| difference < 1e-2), "{differences:?}");
}

#[test]
fn sinusoids_match_the_prototype_in_the_same_scheme() {
    same_scheme(Settings::sinusoids(), SINUSOIDS);
}

#[test]
fn steps_match_the_prototype_in_the_same_scheme() {
    same_scheme(Settings::steps(), STEPS);
}

#[test]
fn sinusoids_of_half_the_step_stay_within_a_hundredth() {
    finer_scheme(Settings::sinusoids(), SINUSOIDS);
}

#[test]
fn steps_of_half_the_step_stay_within_a_hundredth() {
    finer_scheme(Settings::steps(), STEPS);
}
