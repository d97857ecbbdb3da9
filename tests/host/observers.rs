//! The controller model runs the observers of the core, bit for bit, natively and as a packaged model of both standards.

use maglev_fmu::host::Logging;
use maglev_fmu::model::{MagneticBearingController, Model, NullLogSink};
use maglev_fmu::observer::kalman::{KalmanObserver, KalmanSettings};
use maglev_fmu::observer::newton::{NewtonObserver, NewtonSettings};
use maglev_fmu::observer::reduced_newton::{ReducedNewtonObserver, ReducedNewtonSettings};
use maglev_fmu::observer::windowed_newton::{WindowedNewtonObserver, WindowedNewtonSettings};
use maglev_fmu::package::Form;
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map};
use maglev_fmu_test::bearing::{APPLIED, KALMAN, OBSERVERS};
use maglev_fmu_test::packages;
use maglev_fmu_test::sampled_bearing::{Experiment, OBSERVER_START, T, law_a, state_feedback};
use maglev_fmu_test::values::{get, set};

const BIAS_FLUX: f64 = 1e-4;

/// What is compared, as the model names it.
const RESULTS: [&str; 9] = [
    "estimate.position",
    "estimate.velocity",
    "estimate.flux",
    "observer.residual",
    "observer.iterations",
    "observer.converged",
    "estimate.position_deviation",
    "estimate.velocity_deviation",
    "estimate.flux_deviation",
];
type Results = [f64; RESULTS.len()];

fn bearing() -> MagneticBearing {
    MagneticBearing::with_bias(BIAS_FLUX, 0.0022)
}

/// Measured positions and the voltages that acted before them, with sensor noise.
fn samples() -> Vec<(f64, f64)> {
    let experiment =
        Experiment { bearing: bearing(), position_noise: 1e-7, samples: 400, ..Experiment::noise_free() };
    let mut samples = Vec::new();
    experiment.run(
        law_a,
        |state, position, voltage| {
            samples.push((position, voltage));
            state_feedback(state, position, voltage)
        },
        |_, _, _, _| {},
    );
    samples
}

/// Results of the core's observer with the settings that `name` of [`OBSERVERS`] means.
fn expected(name: &str, samples: &[(f64, f64)]) -> Vec<Results> {
    let (bearing, sample_time) = (bearing(), T);
    let newton = |map, max_iterations, step_size, line_search| NewtonSettings {
        bearing,
        map,
        sample_time,
        max_iterations,
        step_size,
        line_search,
    };
    let reduced = |map, filter_time, lag_compensated| ReducedNewtonSettings {
        bearing,
        map,
        sample_time,
        filter_time,
        lag_compensated,
        max_iterations: 10,
        step_size: 1.0,
    };
    macro_rules! run {
        ($observer:ident, $settings:expr) => {
            run!($observer, $settings, |_| [0.0; 3])
        };
        ($observer:ident, $settings:expr, $deviations:expr) => {{
            let (settings, mut observer) = ($settings, $observer::new(OBSERVER_START));
            let update = |&(position, voltage): &(f64, f64)| {
                let estimate = observer.update(&settings, position, voltage);
                let deviations: fn(&$observer) -> [f64; 3] = $deviations;
                let [p, v, f] = deviations(&observer);
                let state = estimate.state;
                let (iterations, converged) = (estimate.iterations.into(), estimate.converged.into());
                [
                    state.position,
                    state.velocity,
                    state.flux,
                    estimate.residual,
                    iterations,
                    converged,
                    p,
                    v,
                    f,
                ]
            };
            samples.iter().map(update).collect()
        }};
    }
    match name {
        "newton" => run!(NewtonObserver, newton(Map::Printed, 10, 1.0, false)),
        "newton, exact map" => run!(NewtonObserver, newton(Map::Exact, 10, 1.0, false)),
        "newton, line search" => run!(NewtonObserver, newton(Map::Exact, 10, 1.0, true)),
        "newton, small steps" => run!(NewtonObserver, newton(Map::Printed, 20, 0.7, false)),
        "newton, N = 10" => run!(
            WindowedNewtonObserver,
            WindowedNewtonSettings { newton: newton(Map::Exact, 10, 1.0, false), window: 10 }
        ),
        "reduced_newton" => run!(ReducedNewtonObserver, reduced(Map::Printed, 2e-3, false)),
        "reduced_newton_compensated" => run!(ReducedNewtonObserver, reduced(Map::Exact, 1e-3, true)),
        "kalman" => run!(
            KalmanObserver,
            KalmanSettings { bearing, map: Map::Exact, sample_time, position_noise: 1e-7, flux_noise: 1e-7 },
            |observer| {
                let deviation = observer.covariance().diagonal().map(f64::sqrt);
                [deviation[0], deviation[1], deviation[2]]
            }
        ),
        other => panic!("no observer {other}"),
    }
}

#[test]
fn native_model_runs_the_cores_observers() {
    let samples = samples();
    for (name, parameters) in OBSERVERS {
        let mut model = MagneticBearingController::new();
        set(&mut model, "bias_flux", BIAS_FLUX);
        set(&mut model, "observer.voltage_source", APPLIED);
        parameters.iter().for_each(|(parameter, value)| set(&mut model, parameter, *value));
        model.initialise(0.0).unwrap();
        for (tick, (sample, expected)) in samples.iter().zip(expected(name, &samples)).enumerate() {
            set(&mut model, "position", sample.0);
            set(&mut model, "voltage_applied", sample.1);
            model.advance(T, &mut NullLogSink).unwrap();
            assert_eq!(RESULTS.map(|result| get(&model, result)), expected, "{name}, tick {tick}");
        }
    }
}

#[test]
fn packaged_models_run_the_cores_observers() {
    let samples = samples();
    for form in Form::ALL {
        let fmu = packages::open(form, "MagneticBearingController");
        for (name, parameters) in OBSERVERS {
            let mut model = fmu.instantiate(name, Logging::Off).unwrap();
            model.set_by_name("bias_flux", BIAS_FLUX).unwrap();
            model.set_by_name("observer.voltage_source", APPLIED).unwrap();
            for (parameter, value) in parameters {
                let variable = model.variable(parameter).unwrap();
                model.set(variable, *value).unwrap();
            }
            model.initialise(0.0, None).unwrap();
            for (tick, (sample, expected)) in samples.iter().zip(expected(name, &samples)).enumerate() {
                model.set_by_name("position", sample.0).unwrap();
                model.set_by_name("voltage_applied", sample.1).unwrap();
                model.step(tick as f64 * T, T).unwrap();
                let actual = RESULTS.map(|result| model.get_by_name(result).unwrap());
                assert_eq!(actual, expected, "{name}, {form:?}, tick {tick}");
            }
        }
    }
}

#[test]
fn kalman_ignores_the_map_and_announces_its_prior() {
    let mut runs = [1.0, 2.0].map(|map| {
        let mut model = MagneticBearingController::new();
        set(&mut model, "observer.kind", KALMAN);
        set(&mut model, "observer.map", map);
        model.initialise(0.0).unwrap();
        model
    });
    let deviations = ["position", "velocity", "flux"].map(|part| format!("estimate.{part}_deviation"));
    assert_eq!(deviations.map(|name| get(&runs[0], &name)), [1e-2, 1e-2, 1e-1]);
    for (position, voltage) in samples() {
        let results = runs.each_mut().map(|model| {
            set(model, "position", position);
            set(model, "voltage_applied", voltage);
            model.advance(T, &mut NullLogSink).unwrap();
            RESULTS.map(|result| get(model, result))
        });
        assert_eq!(results[0], results[1]);
    }
}

#[test]
fn tunable_parameters_reach_the_running_observer() {
    let mut model = MagneticBearingController::new();
    set(&mut model, "observer.kind", KALMAN);
    model.initialise(0.0).unwrap();
    let deviation = |model: &mut MagneticBearingController| {
        (0..200).for_each(|_| model.advance(T, &mut NullLogSink).unwrap());
        get(model, "estimate.position_deviation")
    };
    let fine = deviation(&mut model);
    set(&mut model, "observer.position_noise", 1e-3);
    model.apply_tunable_parameters();
    assert!(deviation(&mut model) > 2.0 * fine, "the filter goes on with the new noise");
}
