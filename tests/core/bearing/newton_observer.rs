//! The shipped Newton observer against the literal algorithm of the paper.

use maglev_fmu::observer::newton::{NewtonObserver, NewtonSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use maglev_fmu_test::printed_newton;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

const T: f64 = 1e-3;

fn vector(state: State) -> Vector3<f64> {
    Vector3::new(state.position, state.velocity, state.flux)
}

fn state(vector: Vector3<f64>) -> State {
    State { position: vector[0], velocity: vector[1], flux: vector[2] }
}

/// Feeds three samples to a fresh observer; the third triggers the inversion from `guess`.
fn shipped(settings: &NewtonSettings, y: [f64; 3], u: [f64; 2], guess: State) -> State {
    let mut observer = NewtonObserver::new(guess);
    observer.update(settings, y[0], 0.0);
    observer.update(settings, y[1], u[0]);
    observer.update(settings, y[2], u[1]).state
}

/// Random state, held voltages and guess, away from the singularity at zero flux.
fn problem() -> impl Strategy<Value = (Vector3<f64>, [f64; 2], Vector3<f64>)> {
    (
        (0.05..0.2f64, any::<bool>(), -0.02..0.02f64, -0.02..0.02f64),
        [-30.0..30.0f64, -30.0..30.0f64],
        (-0.01..0.01f64, -0.01..0.01f64, -0.01..0.01f64),
    )
        .prop_map(|((flux, mirrored, position, velocity), voltages, offset)| {
            let sign = if mirrored { -1.0 } else { 1.0 };
            // Voltages that drive the flux away from zero keep both steps on one branch of |x3|.
            let voltages = voltages.map(|voltage: f64| sign * voltage.abs());
            let truth = Vector3::new(position, velocity, sign * flux);
            (truth, voltages, truth + Vector3::new(offset.0, offset.1, sign * offset.2))
        })
}

/// (6) for any map, by composition, chain rule and a general solve.
fn composed(settings: &NewtonSettings, y: [f64; 3], u: [f64; 2], guess: Vector3<f64>) -> Vector3<f64> {
    let NewtonSettings { bearing, map, .. } = *settings;
    let mut w = guess;
    for _ in 0..settings.max_iterations {
        let first = bearing.advance(map, state(w), u[0], T);
        let second = bearing.advance(map, first, u[1], T);
        let to_first = bearing.jacobian(map, w[2], u[0], T);
        let to_second = bearing.jacobian(map, first.flux, u[1], T) * to_first;
        let row = |matrix: &Matrix3<f64>| [matrix[(0, 0)], matrix[(0, 1)], matrix[(0, 2)]];
        let (a, b) = (row(&to_first), row(&to_second));
        let jacobian = Matrix3::new(1.0, 0.0, 0.0, a[0], a[1], a[2], b[0], b[1], b[2]);
        let residual = Vector3::from(y) - Vector3::new(w[0], first.position, second.position);
        w += settings.step_size * jacobian.lu().solve(&residual).expect("away from the singularity");
    }
    w
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn paper_prints_the_composition_correctly((x, u, _) in problem(), epsilon in 0.0..1.0f64) {
        let first = printed_newton::printed_map(x, u[0], epsilon, T);
        let second = printed_newton::printed_map(first, u[1], epsilon, T);
        let outputs = printed_newton::outputs(x, u, epsilon, T);
        prop_assert!((outputs - Vector3::new(x[0], first[0], second[0])).amax() < 1e-16);
        let bearing = MagneticBearing { epsilon };
        let advanced = vector(bearing.advance(Map::Printed, state(x), u[0], T));
        prop_assert!((advanced - first).amax() < 1e-16);
    }

    #[test]
    fn agrees_with_the_printed_algorithm(
        (x, u, guess) in problem(), epsilon in 0.0..1.0f64, alpha in 0.3..1.0f64, d in 1u32..12, damped: bool,
    ) {
        let step_size = if damped { alpha } else { 1.0 };
        let bearing = MagneticBearing { epsilon };
        let settings = NewtonSettings { bearing, map: Map::Printed, sample_time: T, max_iterations: d, step_size, line_search: false };
        let y: [f64; 3] = printed_newton::outputs(x, u, epsilon, T).into();
        let w = printed_newton::invert(y, u, guess, d, step_size, epsilon, T).expect("away from the singularity");
        let forward = printed_newton::printed_map(printed_newton::printed_map(w, u[0], epsilon, T), u[1], epsilon, T);
        let estimate = vector(shipped(&settings, y, u, state(guess)));
        prop_assert!((estimate - forward).amax() < 1e-9, "{estimate} {forward}");
    }

    #[test]
    fn agrees_with_a_general_solver_on_the_exact_map(
        (x, u, guess) in problem(), epsilon in 0.0..1.0f64, d in 1u32..12, reversed: bool,
    ) {
        // Reversed voltages let the flux cross zero, which only the exact map describes.
        let u = if reversed { u.map(|voltage| -2.0 * voltage) } else { u };
        let bearing = MagneticBearing { epsilon };
        let map = Map::Exact;
        let settings = NewtonSettings { bearing, map, sample_time: T, max_iterations: d, step_size: 1.0, line_search: false };
        let first = bearing.advance(map, state(x), u[0], T);
        let second = bearing.advance(map, first, u[1], T);
        let y = [x[0], first.position, second.position];
        let w = composed(&settings, y, u, guess);
        let forward = bearing.advance(map, bearing.advance(map, state(w), u[0], T), u[1], T);
        let estimate = shipped(&settings, y, u, state(guess));
        prop_assert!((vector(estimate) - vector(forward)).amax() < 1e-9, "{estimate:?} {forward:?}");
    }

    #[test]
    fn starts_at_the_truth_and_stays_there((x, u, _) in problem(), epsilon in 0.0..1.0f64) {
        let bearing = MagneticBearing { epsilon };
        let map = Map::Exact;
        let settings = NewtonSettings { bearing, map, sample_time: T, max_iterations: 10, step_size: 1.0, line_search: false };
        let first = bearing.advance(map, state(x), u[0], T);
        let second = bearing.advance(map, first, u[1], T);
        let mut observer = NewtonObserver::new(state(x));
        observer.update(&settings, x[0], 0.0);
        observer.update(&settings, first.position, u[0]);
        let estimate = observer.update(&settings, second.position, u[1]);
        prop_assert!((vector(estimate.state) - vector(second)).amax() < 1e-10);
        prop_assert!(estimate.converged && estimate.iterations <= 2);
    }

    #[test]
    fn nothing_non_finite_leaves_the_observer(
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 3..12), exact: bool, epsilon in 0.0..1.0f64,
    ) {
        let map = if exact { Map::Exact } else { Map::Printed };
        let bearing = MagneticBearing { epsilon };
        let settings = NewtonSettings { bearing, map, sample_time: T, max_iterations: 10, step_size: 1.0, line_search: false };
        let mut observer = NewtonObserver::new(State { position: 0.0, velocity: 0.0, flux: 1e-9 });
        for (position, voltage) in samples {
            prop_assume!(position.is_finite() && voltage.is_finite());
            let estimate = observer.update(&settings, position, voltage);
            prop_assert!(estimate.state.is_finite() && estimate.residual.is_finite());
        }
    }
}

#[test]
fn singular_window_keeps_the_estimate() {
    // Zero flux, zero voltage, zero bias: the second difference does not depend on the flux at all.
    for map in [Map::Exact, Map::Printed] {
        let bearing = MagneticBearing { epsilon: 0.0 };
        let settings = NewtonSettings {
            bearing,
            map,
            sample_time: T,
            max_iterations: 10,
            step_size: 1.0,
            line_search: false,
        };
        let mut observer = NewtonObserver::new(State::default());
        for sample in 0..5 {
            let estimate = observer.update(&settings, 0.0, 0.0);
            assert_eq!(estimate.state, State::default(), "{map:?} sample {sample}");
            assert!(!estimate.converged);
        }
        // It works again once there is something to see.
        let mut truth = State { position: 0.0, velocity: 0.0, flux: 0.1 };
        let mut estimate = observer.update(&settings, truth.position, 0.0);
        for _ in 0..10 {
            truth = settings.bearing.advance(map, truth, 5.0, T);
            estimate = observer.update(&settings, truth.position, 5.0);
        }
        assert!(estimate.converged && (estimate.state.flux - truth.flux).abs() < 1e-9, "{estimate:?}");
    }
}
