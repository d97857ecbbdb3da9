//! The rig's plant model: driver, sensor, stops, and what does not depend on the communication step.

use maglev_fmu::model::{MaglevRigPlant, Model, ModelError, NullLogSink};
use maglev_fmu_test::values::{get, set};
use proptest::prelude::*;

use super::experiment::{SENSOR, plant_step, root_mean_square};

fn plant(values: &[(&str, f64)]) -> MaglevRigPlant {
    let mut plant = MaglevRigPlant::new();
    values.iter().for_each(|(name, value)| set(&mut plant, name, *value));
    plant.initialise(0.0).unwrap();
    plant
}

fn advance(plant: &mut MaglevRigPlant, duration: f64) {
    plant.advance(duration, &mut NullLogSink).unwrap();
}

#[test]
fn ball_rests_at_the_start_values() {
    let mut plant = plant(&[]);
    assert_eq!(get(&plant, "sensor_voltage_measured"), -1.50868);
    advance(&mut plant, 0.1);
    // The unstable pole of 46.7 1/s lets rounding errors grow by a factor of a hundred.
    assert!((get(&plant, "position") - 9e-3).abs() < 1e-16);
    assert!((get(&plant, "magnetic_force") - 0.02 * 9.8).abs() < 1e-13);
    assert!((get(&plant, "current") - 0.796_894).abs() < 1e-6);
    assert_eq!(get(&plant, "contact"), 0.0);
}

#[test]
fn driver_limits_the_voltage_and_reports_what_acted() {
    for (wanted, acted) in [(-3.0, 0.0), (0.5, 0.5), (7.0, 5.0), (f64::MAX, 5.0)] {
        let mut plant = plant(&[("voltage", wanted)]);
        assert_eq!(get(&plant, "voltage_measured"), 0.0);
        advance(&mut plant, 1e-3);
        assert_eq!(get(&plant, "voltage_measured"), acted);
        assert_eq!(get(&plant, "current"), 1.05 * acted);
    }
}

#[test]
fn force_accelerates_downwards() {
    let mut plant = plant(&[("force", 0.02)]);
    advance(&mut plant, 1e-4);
    assert!((get(&plant, "velocity") - 1e-4).abs() < 1e-9);
    assert!((get(&plant, "acceleration") - 1.0).abs() < 1e-4);
}

#[test]
fn sensor_has_noise_resolution_and_a_range() {
    // Beyond the range on the lower stop.
    let low = plant(&[("initial.position", 1.0), ("lower_stop", 0.05), ("voltage", 0.0)]);
    assert_eq!((get(&low, "sensor_voltage_measured"), get(&low, "contact")), (1.25, 1.0));
    assert_eq!(get(&low, "sensor_voltage"), SENSOR.voltage(0.05));

    let coarse = plant(&[("sensor.resolution", 0.25)]);
    assert_eq!(get(&coarse, "sensor_voltage_measured"), -1.5);

    let readings = |seed: f64| {
        let mut noisy = plant(&[("sensor.noise", 1e-3), ("sensor.seed", seed)]);
        [(); 1000].map(|()| {
            advance(&mut noisy, 1e-5);
            get(&noisy, "sensor_voltage_measured") - get(&noisy, "sensor_voltage")
        })
    };
    let deviation = root_mean_square(readings(1.0).into_iter());
    assert!((deviation / 1e-3 - 1.0).abs() < 0.1, "{deviation}");
    assert_eq!(readings(3.0), readings(3.0));
    assert_ne!(readings(3.0), readings(4.0));
}

#[test]
fn a_step_of_hours_is_refused_and_changes_nothing() {
    let mut plant = plant(&[]);
    let before = plant.values().to_vec();
    let refused = plant.advance(1e5, &mut NullLogSink).unwrap_err();
    let ModelError::StepTooLong { limit, .. } = refused else { panic!("{refused}") };
    let said = format!("a step of 100000 s: expected at most {limit} s, about a second of computing");
    assert!(refused.to_string().starts_with(&said), "{refused}");
    assert_eq!(plant.values(), before);
    // Sensor and integrator share the second.
    let mut read = self::plant(&[("sensor.sample_time", 1e-6)]);
    let refused = read.advance(1e5, &mut NullLogSink).unwrap_err();
    assert!(
        matches!(refused, ModelError::StepTooLong { limit: shorter, .. } if shorter < limit),
        "{refused}"
    );
}

proptest! {
    #[test]
    fn result_agrees_with_fine_classical_runge_kutta_and_does_not_depend_on_the_step(
        voltage in 0.0..3.0f64, force in -0.1..0.1f64, position in 7e-3..0.02f64, velocity in -0.1..0.1f64,
        share in 0.01..0.99f64,
    ) {
        let start = [
            ("voltage", voltage), ("force", force), ("initial.position", position), ("initial.velocity", velocity),
        ];
        let (mut whole, mut parts) = (plant(&start), plant(&start));
        advance(&mut whole, 1e-3);
        advance(&mut parts, 1e-3 * share);
        advance(&mut parts, 1e-3 * (1.0 - share));
        let fine = plant_step(maglev_fmu::plant::maglev_rig::State { position, velocity }, voltage, force, 400);
        for (name, fine) in [("position", fine.position), ("velocity", fine.velocity)] {
            prop_assert!((get(&whole, name) - fine).abs() < 1e-14, "{} {}", get(&whole, name), fine);
            prop_assert!((get(&parts, name) - fine).abs() < 1e-14, "{} {}", get(&parts, name), fine);
        }
    }

    #[test]
    fn nothing_gets_past_the_stops(
        voltages in prop::collection::vec(0.0..5.0f64, 50), force in -0.5..0.5f64, upper in 1e-4..8e-3f64,
        step in 1e-4..5e-2f64,
    ) {
        let mut plant = plant(&[("upper_stop", upper), ("force", force)]);
        for voltage in voltages {
            set(&mut plant, "voltage", voltage);
            advance(&mut plant, step);
            let position = get(&plant, "position");
            prop_assert!((upper..=25e-3).contains(&position), "{position}");
            let at_stop = position == upper || position == 25e-3;
            prop_assert!(get(&plant, "contact") == 0.0 || at_stop && get(&plant, "velocity") == 0.0);
            prop_assert!(plant.values().iter().all(|value| value.is_finite()));
        }
    }
}
