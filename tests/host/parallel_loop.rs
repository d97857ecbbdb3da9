//! A master that steps both models at once hands the voltage over one step late. The observer converges all the same if
//! it gets the voltage that acted.

use maglev_fmu::host::{ControlLoop, ExchangeOrder, Trace};
use maglev_fmu::package::FmiVersion::{self, Three, Two};
use maglev_fmu_test::packages;

const STEPS: usize = 10_000;
const STATES: [&str; 3] = ["position", "velocity", "flux"];
/// Number of an item of `observer.voltage_source`.
const COMMAND: f64 = 1.0;
const APPLIED: f64 = 2.0;
/// Number of an item of `observer.map`.
const EXACT: f64 = 1.0;
const PRINTED: f64 = 2.0;

fn run(version: FmiVersion, voltage_source: f64, map: f64) -> Trace {
    let controller = packages::instantiate(
        version,
        "MagneticBearingController",
        &[("observer.voltage_source", voltage_source), ("observer.map", map)],
    );
    let plant = packages::instantiate(version, "MagneticBearingPlant", &[("initial.position", 0.01)]);
    let mut bearing = ControlLoop::connect(
        controller,
        plant,
        ExchangeOrder::Parallel,
        &[("position", "position"), ("voltage_measured", "voltage_applied")],
        &[("voltage", "voltage")],
    )
    .unwrap();
    for name in STATES {
        bearing.record(&[("plant", name), ("controller", &format!("estimate.{name}"))]).unwrap();
    }
    bearing.initialise(0.0, None, 1e-3).unwrap();
    bearing.run(STEPS).unwrap()
}

/// Magnitudes of the estimation errors of sample k; its estimate is in the next row, computed from the outputs of
/// this one.
fn errors(trace: &Trace) -> Vec<[f64; 3]> {
    (0..STEPS - 1)
        .map(|k| {
            STATES.map(|name| {
                let truth = trace.column(&format!("plant.{name}")).unwrap()[k];
                (trace.column(&format!("controller.estimate.{name}")).unwrap()[k + 1] - truth).abs()
            })
        })
        .collect()
}

/// Bounds of position \[m\], velocity \[m/s\] and flux \[Wb\] errors.
const BOUNDS: [f64; 3] = [1e-9, 1e-7, 1e-5];

fn is_below(errors: &[f64; 3], bounds: [f64; 3]) -> bool {
    errors.iter().zip(bounds).all(|(error, bound)| *error < bound)
}

/// Whether the true flux changes sign in the observer's window, the two steps before sample `k`.
fn flux_crosses_zero(trace: &Trace, k: usize) -> bool {
    let window = &trace.column("plant.flux").unwrap()[k - 2..=k];
    window.iter().any(|flux| flux.signum() != window[0].signum())
}

/// Median of the flux errors from sample 10 on \[Wb\].
fn median_flux_error(errors: &[[f64; 3]]) -> f64 {
    let mut errors: Vec<f64> = errors[10..].iter().map(|errors| errors[2]).collect();
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

#[test]
fn observer_converges_with_the_applied_voltage() {
    for (version, map, crossing_bound) in [(Two, PRINTED, 2e-5), (Three, PRINTED, 2e-5), (Two, EXACT, 1e-5)] {
        let trace = run(version, APPLIED, map);
        let errors = errors(&trace);
        let mut crossings = 0;
        let mut worst = [0.0f64; 3];
        for (k, errors) in errors.iter().enumerate().skip(4) {
            // The printed map is not exact where the flux changes sign.
            let crosses = flux_crosses_zero(&trace, k);
            crossings += usize::from(crosses);
            let bounds = if crosses { [1e-9, 1e-7, crossing_bound] } else { BOUNDS };
            assert!(is_below(errors, bounds), "{version:?}, map {map}, sample {k}: {errors:?}");
            worst = core::array::from_fn(|state| worst[state].max(errors[state]));
        }
        let median = median_flux_error(&errors);
        println!(
            "{version:?}, map {map}: worst {worst:?}, median flux error {median:e} Wb, {crossings} crossing samples"
        );
        let swing =
            trace.column("plant.flux").unwrap().iter().fold(0.0, |most, flux| f64::max(most, flux.abs()));
        assert!(crossings > 0 && swing > 0.1, "the trajectory asks something of the observer");
        assert!(median < 1e-10, "{median:e}");
    }
}

#[test]
fn observer_is_wrong_with_the_commanded_voltage() {
    for version in [Two, Three] {
        let errors = errors(&run(version, COMMAND, PRINTED));
        let median = median_flux_error(&errors);
        println!(
            "{version:?}: flux errors of samples 4 and 5 {:?}, median {median:e} Wb",
            [errors[4][2], errors[5][2]]
        );
        assert!(errors[4][2] > 1e-5 && errors[5][2] > 1e-5);
        // As large as what the voltage changes by in a step makes of the flux.
        assert!(median > 1e-9, "{median:e}");
    }
}
