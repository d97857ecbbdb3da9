//! The adaptive observer with parameters that are not what it believes, a noisy current and an offset of the voltage.

use maglev_fmu::plant::levitated_ball::LevitatedBall;
use maglev_fmu::study::ball::BallReference::{self, Sinusoids, Steps};
use maglev_fmu_test::values::get;
use rand_core::Rng;
use rand_pcg::Pcg32;

use super::native_loop::{
    BallLoop, POLYNOMIAL_NEWTON, POLYNOMIAL_NEWTON_ADAPTIVE, VOLTAGE_OFFSET, carrying_flux,
};

/// One plant of spread A: R 1 %, k 2 %, m 1 %, 5 mV, 1 mA of noise, flux 10 %, all uniform but the noise.
fn plant_of_spread(signal: BallReference, seed: u64, settings: &[(&str, f64)]) -> BallLoop {
    let mut generator = Pcg32::new(seed, 0);
    let mut within = |share: f64| share * (2.0 * f64::from(generator.next_u32()) / f64::from(u32::MAX) - 1.0);
    let believed = LevitatedBall::LABORATORY;
    let real = LevitatedBall {
        resistance: believed.resistance * (1.0 + within(0.01)),
        inductance_constant: believed.inductance_constant * (1.0 + within(0.02)),
        mass: believed.mass * (1.0 + within(0.01)),
        ..believed
    };
    let flux = real.equilibrium_flux();
    let plant = [
        ("resistance", real.resistance),
        ("inductance_constant", real.inductance_constant),
        ("mass", real.mass),
        ("initial.flux", flux),
        ("sensor.noise", 1e-3),
        ("sensor.seed", seed as f64),
    ];
    let start = [
        ("sample_time", 2e-4),
        ("observer.startup_hold", 0.02),
        ("observer.initial.flux", flux - within(0.1) * carrying_flux()),
    ];
    let mut run = BallLoop::new(signal, 0.0, &plant, &[&start, settings].concat());
    run.voltage_offset = within(5e-3);
    run
}

/// Number of survivors and median of their root mean square error from 2 s to 4 s [m].
fn spread(signal: BallReference, runs: u64, settings: &[(&str, f64)]) -> (usize, f64) {
    let mut errors = Vec::new();
    for seed in 1..=runs {
        let summary = plant_of_spread(signal, seed, settings).run(2.0, 4.0);
        if summary.survived {
            errors.push(summary.rms_error);
        }
    }
    errors.sort_by(f64::total_cmp);
    (errors.len(), errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN))
}

#[test]
fn adaptive_observer_survives_wrong_parameters() {
    for (signal, median) in [(Sinusoids, 0.06e-3), (Steps, 0.04e-3)] {
        let (survivors, error) = spread(signal, 100, &[("observer.kind", POLYNOMIAL_NEWTON_ADAPTIVE)]);
        assert_eq!(survivors, 100, "{signal:?}");
        assert!(error <= median, "{signal:?}: {error}");
    }
}

/// Guards against a spread that is too easy: without adaptation some balls are lost, with DREM all.
#[test]
fn the_others_do_not() {
    let (survivors, error) = spread(Sinusoids, 40, &[("observer.kind", POLYNOMIAL_NEWTON)]);
    assert!(survivors < 40 && error > 0.3e-3, "{survivors} {error}");
    let (survivors, _) = spread(Sinusoids, 10, &[]);
    assert_eq!(survivors, 0);
}

#[test]
fn resistance_is_learnt() {
    for error in [-0.05, -0.01, 0.01, 0.03] {
        let resistance = LevitatedBall::LABORATORY.resistance * (1.0 + error);
        let settings = [("observer.kind", POLYNOMIAL_NEWTON_ADAPTIVE), ("observer.startup_hold", 0.02)];
        let mut run = BallLoop::new(Sinusoids, 0.02, &[("resistance", resistance)], &settings);
        assert!(run.run(0.0, 2.0).survived, "{error}");
        let end = run.run(2.0, 3.0);
        assert!(end.largest_flux_error < 1e-4, "{error}: {end:?}");
        let learnt = get(&*run.controller, "observer.estimated_resistance");
        assert!((learnt / resistance - 1.0).abs() < 1e-3, "{error}: {learnt} {resistance}");
        assert_eq!(get(&*run.controller, "observer.voltage_offset"), 0.0);
    }
}

#[test]
fn voltage_offset_is_learnt() {
    for offset in [-0.05, 0.01] {
        let settings = [
            ("observer.kind", POLYNOMIAL_NEWTON_ADAPTIVE),
            ("observer.adaptation", VOLTAGE_OFFSET),
            ("observer.startup_hold", 0.02),
        ];
        let mut run = BallLoop::new(Sinusoids, 0.02, &[], &settings);
        run.voltage_offset = offset;
        assert!(run.run(0.0, 2.0).survived, "{offset}");
        let end = run.run(2.0, 3.0);
        assert!(end.largest_flux_error < 1e-4, "{offset}: {end:?}");
        let learnt = get(&*run.controller, "observer.voltage_offset");
        assert!((learnt - offset).abs() < 1e-4, "{offset}: {learnt}");
        assert_eq!(
            get(&*run.controller, "observer.estimated_resistance"),
            LevitatedBall::LABORATORY.resistance
        );
    }
}
