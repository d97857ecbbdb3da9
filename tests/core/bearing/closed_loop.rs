//! Plant and controller models wired natively, sensor included, from every start of the paper's Table 1.

use maglev_fmu::model::ClosedLoop;
use maglev_fmu::model::system::BEARING;
use maglev_fmu::model::variable::{Causality, Kind};
use maglev_fmu::model::{MagneticBearingController, Model, NullLogSink};
use maglev_fmu_test::bearing::{EXACT, FLUX_CASCADE, KALMAN};
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::values::{get, set};
use proptest::prelude::*;

const T: f64 = 1e-3;
const POSITIONS: [f64; 3] = [0.0, 0.001, 0.01];
const VOLTAGES: [f64; 3] = [-50.0, -100.0, -150.0];
/// Bias flux of the paper's low-bias operation [Wb], epsilon = 0.0909.
const LOW_BIAS: f64 = 1e-4;

/// All starts of Table 1 with the given parameters of both models.
fn starts(
    plant: &[(&'static str, f64)],
    controller: &[(&'static str, f64)],
) -> impl Iterator<Item = (String, ClosedLoop)> {
    POSITIONS.into_iter().flat_map(move |position| {
        VOLTAGES.map(|voltage| {
            let plant = [plant, &[("initial.position", position)]].concat();
            let controller = [controller, &[("controller.initial_voltage", voltage)]].concat();
            (format!("{position} m, {voltage} V"), closed_loop(&BEARING, &plant, &controller))
        })
    })
}

/// Runs 4 s and asserts |u| <= 150 V; returns the time after which |x1| stays below 1e-5 m \[s\], and the largest
/// |x1| in the last second \[m\].
fn settle(run: &mut ClosedLoop) -> (f64, f64) {
    let (mut settling_time, mut rest) = (0.0, 0.0f64);
    for tick in 0..4000 {
        run.step_controller().unwrap();
        let (position, voltage) = (get(&*run.plant, "position").abs(), get(&*run.controller, "voltage"));
        assert!(voltage.abs() <= 150.0);
        if position > 1e-5 {
            settling_time = f64::from(tick + 1) * T;
        }
        if tick >= 3000 {
            rest = rest.max(position);
        }
        run.step_plant().unwrap();
    }
    (settling_time, rest)
}

#[test]
fn flux_cascade_settles_with_estimates() {
    let newton = [("controller.law", FLUX_CASCADE), ("observer.map", EXACT)];
    let kalman = [("controller.law", FLUX_CASCADE), ("observer.kind", KALMAN)];
    let mut slowest = 0.0f64;
    for observer in [newton, kalman] {
        for bias_flux in [0.0, LOW_BIAS] {
            let controller = [&observer[..], &[("bias_flux", bias_flux)]].concat();
            for (name, mut run) in starts(&[("bias_flux", bias_flux)], &controller) {
                let (time, _) = settle(&mut run);
                assert!(time <= 2.0, "{controller:?} {name}: {time} s");
                slowest = slowest.max(time);
            }
        }
    }
    println!("slowest: {slowest} s");
}

#[test]
fn kalman_settles_within_twenty_times_the_noise() {
    let noise = 1e-7;
    // The filter's default assumes ten times as much.
    for assumed in [noise, 1e-6] {
        for bias_flux in [0.0, LOW_BIAS] {
            let controller = [
                ("controller.law", FLUX_CASCADE),
                ("observer.kind", KALMAN),
                ("observer.position_noise", assumed),
                ("bias_flux", bias_flux),
            ];
            for (name, mut run) in starts(&[("sensor.noise", noise), ("bias_flux", bias_flux)], &controller) {
                let (time, rest) = settle(&mut run);
                assert!(time <= 2.0 && rest <= 20.0 * noise, "{name}, {assumed} m: {time} s, {rest} m");
            }
        }
    }
}

/// Largest flux error \[Wb\] of the exact-map Newton observer from 50 ms to 10 s in all 27 runs of Table 1.
fn largest_flux_error(plant: &[(&'static str, f64)]) -> f64 {
    let mut worst = 0.0f64;
    for law in [1.0, 2.0, 3.0] {
        for (_, mut run) in starts(plant, &[("controller.law", law), ("observer.map", EXACT)]) {
            for tick in 0..10_000 {
                run.step_controller().unwrap();
                let error = (get(&*run.controller, "estimate.flux") - get(&*run.plant, "flux")).abs();
                if tick >= 50 {
                    worst = worst.max(error);
                }
                run.step_plant().unwrap();
            }
        }
    }
    println!("{plant:?}: {worst:e} Wb");
    worst
}

#[test]
fn exact_map_newton_knows_the_flux_in_all_runs_of_table_1() {
    assert!(largest_flux_error(&[]) < 1e-7);
}

/// Table 1 starts the observer with the plant's own flux; here it has to find it.
#[test]
fn exact_map_newton_finds_an_unknown_flux() {
    for flux in [-0.02, 0.003, 0.05] {
        assert!(largest_flux_error(&[("initial.flux", flux), ("initial.velocity", 0.001)]) < 1e-7);
    }
}

#[test]
fn first_output_is_the_initial_voltage_for_every_law() {
    for law in 1..=4 {
        for (name, mut run) in starts(&[], &[("controller.law", f64::from(law))]) {
            run.step_controller().unwrap();
            let wanted = get(&*run.controller, "controller.initial_voltage");
            assert_eq!(get(&*run.controller, "voltage"), wanted, "{name}");
        }
    }
}

/// Values of all parameters within their ranges, the larger ones on a logarithmic scale.
fn parameters() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.0..=1.0f64, MagneticBearingController::new().values().len())
}

/// Any finite number.
fn any_finite() -> impl Strategy<Value = f64> + Copy {
    use prop::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn nothing_non_finite_leaves_any_observer_and_law(
        shares in parameters(),
        samples in prop::collection::vec([any_finite(); 4], 3..80),
        plausible: bool,
    ) {
        let mut model = MagneticBearingController::new();
        let variables = model.description().variables;
        for (reference, (variable, share)) in variables.iter().zip(&shares).enumerate() {
            // Every sample is to reach observer and law.
            if variable.causality != Causality::Parameter || ["start_delay", "longest_step"].contains(&variable.name) {
                continue;
            }
            let (minimum, maximum) = variable.range;
            model.values_mut()[reference] = match variable.kind {
                Kind::Enumeration(items) => (1.0 + share * items.items.len() as f64).floor().min(items.items.len() as f64),
                Kind::Boolean => share.round(),
                Kind::Integer => (minimum + share * (maximum - minimum)).round(),
                // Towards one end or the other by decades.
                Kind::Real(_) if *share < 0.5 => minimum + (maximum - minimum) * libm::pow(10.0, -60.0 * share),
                Kind::Real(_) => variable.start,
            };
            prop_assert!(variable.check(model.values()[reference]).is_ok(), "{}", variable.name);
        }
        model.initialise(0.0).unwrap();
        let (limit, sample_time) = (get(&model, "controller.voltage_limit"), get(&model, "sample_time"));
        for sample in samples {
            for (input, value) in ["position", "voltage_applied", "state.velocity", "state.flux"].iter().zip(sample) {
                // Small numbers are ordinary positions and voltages.
                let value = if plausible { value.signum() * (value.abs() % 1.0) } else { value };
                set(&mut model, input, value);
            }
            model.advance(sample_time, &mut NullLogSink).unwrap();
            for (value, variable) in model.values().iter().zip(variables) {
                prop_assert!(value.is_finite(), "{} = {value}", variable.name);
            }
            prop_assert!(get(&model, "voltage").abs() <= limit);
        }
    }
}
