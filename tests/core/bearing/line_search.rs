//! The varying step size of Remark 5 against its literal form, and what it is good for.

use maglev_fmu::observer::newton::{NewtonObserver, NewtonSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use maglev_fmu_test::sampled_bearing::{OBSERVER_START, T};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

fn settings(max_iterations: u32, step_size: f64, line_search: bool) -> NewtonSettings {
    let bearing = MagneticBearing { epsilon: 0.0 };
    NewtonSettings { bearing, map: Map::Exact, sample_time: T, max_iterations, step_size, line_search }
}

fn state(vector: Vector3<f64>) -> State {
    State { position: vector[0], velocity: vector[1], flux: vector[2] }
}

fn outputs(bearing: MagneticBearing, w: Vector3<f64>, u: [f64; 2]) -> (Vector3<f64>, State) {
    let first = bearing.advance(Map::Exact, state(w), u[0], T);
    let second = bearing.advance(Map::Exact, first, u[1], T);
    (Vector3::new(w[0], first.position, second.position), second)
}

/// (6) with a general solve and lambda = alpha, alpha / 2, .. until the residual's norm decreases.
fn literal(settings: &NewtonSettings, y: Vector3<f64>, u: [f64; 2], guess: Vector3<f64>) -> State {
    let bearing = settings.bearing;
    let mut w = guess;
    for _ in 0..settings.max_iterations {
        let to_first = bearing.jacobian(Map::Exact, w[2], u[0], T);
        let to_second = bearing.jacobian(Map::Exact, w[2] + u[0] * T, u[1], T) * to_first;
        let rows = [Matrix3::identity().row(0).into_owned(), to_first.row(0).into(), to_second.row(0).into()];
        let residual = y - outputs(bearing, w, u).0;
        let step = Matrix3::from_rows(&rows).lu().solve(&residual).expect("away from the singularity");
        let mut length = settings.step_size;
        while step[2].abs() > 1e-6 * w[2].abs()
            && (y - outputs(bearing, w + length * step, u).0).norm() >= residual.norm()
        {
            length /= 2.0;
        }
        w += length * step;
    }
    outputs(bearing, w, u).1
}

fn shipped(settings: &NewtonSettings, y: Vector3<f64>, u: [f64; 2], guess: Vector3<f64>) -> State {
    let mut observer = NewtonObserver::new(state(guess));
    observer.update(settings, y[0], 0.0);
    observer.update(settings, y[1], u[0]);
    observer.update(settings, y[2], u[1]).state
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The guess knows position and velocity, so that the flux alone decides the residual: full steps from a small
    /// flux overshoot and the search has work to do.
    #[test]
    fn agrees_with_its_literal_form(
        flux in 0.1..0.2f64, start in 0.002..0.3f64, u in [0.0..3.0f64, 0.0..3.0f64], d in 1u32..6,
        position in -0.01..0.01f64, velocity in -0.01..0.01f64, damped: bool,
    ) {
        let settings = settings(d, if damped { 0.7 } else { 1.0 }, true);
        let truth = Vector3::new(position, velocity, flux);
        let guess = Vector3::new(position, velocity, start);
        let y = outputs(settings.bearing, truth, u).0;
        let (actual, expected) = (shipped(&settings, y, u, guess), literal(&settings, y, u, guess));
        prop_assert!((actual.flux - expected.flux).abs() < 1e-7, "{actual:?} {expected:?}");
        prop_assert!((actual.velocity - expected.velocity).abs() < 1e-9);
    }

    /// From nearly zero flux a full step overshoots by the ratio of the slopes and each further one halves that.
    #[test]
    fn poor_start_needs_fewer_iterations(flux in 0.05..0.2f64, exponent in -9.0..-6.0f64, mirrored: bool) {
        let flux = if mirrored { -flux } else { flux };
        let start = libm::pow(10.0, exponent) * flux.signum();
        let (truth, guess) = (Vector3::new(0.01, 0.0, flux), Vector3::new(0.01, 0.0, start));
        let y = outputs(settings(1, 1.0, false).bearing, truth, [0.0; 2]).0;
        let error = |line_search| (shipped(&settings(10, 1.0, line_search), y, [0.0; 2], guess).flux - flux).abs();
        prop_assert!(error(true) < 1e-9, "{}", error(true));
        prop_assert!(error(false) > 1.0, "{}", error(false));
    }

    #[test]
    fn nothing_non_finite_leaves_the_observer(
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 3..12), epsilon in 0.0..1.0f64,
    ) {
        let mut settings = settings(10, 1.0, true);
        settings.bearing.epsilon = epsilon;
        let mut observer = NewtonObserver::new(OBSERVER_START);
        for (position, voltage) in samples {
            prop_assume!(position.is_finite() && voltage.is_finite());
            let estimate = observer.update(&settings, position, voltage);
            prop_assert!(estimate.state.is_finite() && estimate.residual.is_finite());
        }
    }
}
