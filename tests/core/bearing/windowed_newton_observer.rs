//! The windowed Newton observer against the square system, the literal pseudo-inverse and the theory of least squares.

use maglev_fmu::observer::newton::{NewtonObserver, NewtonSettings};
use maglev_fmu::observer::windowed_newton::{MAX_WINDOW, WindowedNewtonObserver, WindowedNewtonSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use maglev_fmu_test::sampled_bearing::{Experiment, Normal, OBSERVER_START, RootMeanSquare, T, law_a};
use nalgebra::{SMatrix, SVector, Vector3};
use proptest::prelude::*;

fn settings(max_iterations: u32, window: usize) -> WindowedNewtonSettings {
    let newton = NewtonSettings {
        bearing: MagneticBearing { epsilon: 0.0 },
        map: Map::Exact,
        sample_time: T,
        max_iterations,
        step_size: 1.0,
        line_search: false,
    };
    WindowedNewtonSettings { newton, window }
}

fn vector(state: State) -> Vector3<f64> {
    Vector3::new(state.position, state.velocity, state.flux)
}

/// Outputs of a window and their derivatives; rows beyond the window are zero, which least squares does not notice.
type Outputs = SVector<f64, MAX_WINDOW>;
type Jacobian = SMatrix<f64, MAX_WINDOW, 3>;

/// H(w), its Jacobian by the chain rule, and the state at the newest sample.
fn outputs(settings: &NewtonSettings, w: State, voltages: &[f64]) -> (Outputs, Jacobian, State) {
    let NewtonSettings { bearing, map, .. } = *settings;
    let count = voltages.len() + 1;
    let (mut values, mut rows) = (Outputs::zeros(), Jacobian::zeros());
    let (mut state, mut sensitivity) = (w, nalgebra::Matrix3::identity());
    for j in 0..count {
        values[j] = state.position;
        rows.row_mut(j).copy_from(&sensitivity.row(0));
        if j < voltages.len() {
            sensitivity = bearing.jacobian(map, state.flux, voltages[j], T) * sensitivity;
            state = bearing.advance(map, state, voltages[j], T);
        }
    }
    (values, rows, state)
}

/// (6) with the pseudo-inverse, d times.
fn literal(settings: &NewtonSettings, positions: &[f64], voltages: &[f64], guess: State) -> State {
    let mut w = vector(guess);
    for _ in 0..settings.max_iterations {
        let state = State { position: w[0], velocity: w[1], flux: w[2] };
        let (values, rows, _) = outputs(settings, state, voltages);
        let residual =
            Outputs::from_fn(|row, _| positions.get(row).map_or(0.0, |position| position - values[row]));
        // Columns scaled to unit length: they differ by five decades.
        let scale: Vec<f64> = (0..3).map(|column| rows.column(column).norm()).collect();
        let scaled = Jacobian::from_fn(|row, column| rows[(row, column)] / scale[column]);
        let step = scaled.svd(true, true).solve(&residual, 0.0).expect("both factors were asked for");
        for column in 0..3 {
            w[column] += settings.step_size * step[column] / scale[column];
        }
    }
    let state = State { position: w[0], velocity: w[1], flux: w[2] };
    outputs(settings, state, voltages).2
}

/// The estimate of a fresh observer from the whole window at once. Earlier, shorter windows would move the start.
fn at_once(settings: &WindowedNewtonSettings, positions: &[f64], voltages: &[f64], guess: State) -> State {
    let mut observer = WindowedNewtonObserver::new(guess);
    let idle = WindowedNewtonSettings {
        newton: NewtonSettings { max_iterations: 0, ..settings.newton },
        ..*settings
    };
    let last = positions.len() - 1;
    for j in 0..last {
        observer.update(&idle, positions[j], if j > 0 { voltages[j - 1] } else { 0.0 });
    }
    observer.update(settings, positions[last], voltages[last - 1]).state
}

/// True state at the window's start, voltages, guess and noise of the positions.
fn problem() -> impl Strategy<Value = (State, Vec<f64>, State, u64)> {
    (
        (0.05..0.2f64, any::<bool>(), -0.02..0.02f64, -0.02..0.02f64),
        prop::collection::vec(-3.0..3.0f64, MAX_WINDOW - 1),
        -0.01..0.01f64,
        any::<u64>(),
    )
        .prop_map(|((size, mirrored, position, velocity), voltages, offset, seed)| {
            let flux = if mirrored { -size } else { size };
            let truth = State { position, velocity, flux };
            (truth, voltages, State { flux: flux + offset, ..truth }, seed)
        })
}

fn measured(settings: &NewtonSettings, truth: State, voltages: &[f64], noise: f64, seed: u64) -> Vec<f64> {
    let mut normal = Normal::new(seed);
    let positions = outputs(settings, truth, voltages).0;
    positions.iter().take(voltages.len() + 1).map(|position| position + noise * normal.sample()).collect()
}

proptest! {
    #[test]
    fn agrees_with_the_pseudo_inverse(
        (truth, voltages, guess, seed) in problem(), d in 1u32..8, damped: bool, alpha in 0.3..1.0f64,
        epsilon in 0.0..1.0f64, noise in -12.0..-9.0f64,
    ) {
        for window in [3, 4, 10, 30, 64] {
            let mut settings = settings(d, window);
            settings.newton.step_size = if damped { alpha } else { 1.0 };
            settings.newton.bearing.epsilon = epsilon;
            let voltages = &voltages[..window - 1];
            let positions = measured(&settings.newton, truth, voltages, libm::pow(10.0, noise), seed);
            let expected = literal(&settings.newton, &positions, voltages, guess);
            let actual = at_once(&settings, &positions, voltages, guess);
            // A last digit of a position of 0.02 m is 3e-18 m, and 1e-6 s2 * 0.05 Wb turn it into 7e-11 Wb.
            let limit = if window == 3 { 1e-8 } else { 1e-9 };
            prop_assert!((vector(actual) - vector(expected)).amax() < limit, "{window} {actual:?} {expected:?}");
        }
    }

    #[test]
    fn three_samples_are_the_square_system(
        (truth, voltages, guess, seed) in problem(), d in 1u32..8, damped: bool, alpha in 0.3..1.0f64,
        line_search: bool, noisy: bool,
    ) {
        let mut settings = settings(d, 3);
        settings.newton.step_size = if damped { alpha } else { 1.0 };
        settings.newton.line_search = line_search;
        let noise = if noisy { 1e-9 } else { 0.0 };
        let positions = measured(&settings.newton, truth, &voltages[..2], noise, seed);
        let mut square = NewtonObserver::new(guess);
        square.update(&settings.newton, positions[0], 0.0);
        square.update(&settings.newton, positions[1], voltages[0]);
        let expected = square.update(&settings.newton, positions[2], voltages[1]).state;
        let actual = at_once(&settings, &positions, &voltages[..2], guess);
        prop_assert!((vector(actual) - vector(expected)).amax() < 1e-9, "{actual:?} {expected:?}");
    }

    #[test]
    fn nothing_non_finite_leaves_the_observer(
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 3..20), window in 0usize..100,
        line_search: bool, exact: bool, epsilon in 0.0..1.0f64,
    ) {
        let mut settings = settings(10, window);
        settings.newton.line_search = line_search;
        settings.newton.bearing.epsilon = epsilon;
        settings.newton.map = if exact { Map::Exact } else { Map::Printed };
        let mut observer = WindowedNewtonObserver::new(OBSERVER_START);
        for (position, voltage) in samples {
            prop_assume!(position.is_finite() && voltage.is_finite());
            let estimate = observer.update(&settings, position, voltage);
            prop_assert!(estimate.state.is_finite() && estimate.residual.is_finite());
        }
    }
}

#[test]
fn noise_averages_as_least_squares_should() {
    // sigma sqrt(180 / (N (N^2 - 1) (N^2 - 4))) / (T^2 x3) at a steady flux, from sigma |pinv(J)'s flux row|.
    let (truth, noise, seeds) = (State { position: 0.01, velocity: 0.0, flux: 0.15 }, 1e-10, 1000);
    for window in [3usize, 10, 30, 64] {
        let settings = settings(10, window);
        let voltages = vec![0.0; window - 1];
        let mut error = RootMeanSquare::default();
        for seed in 0..seeds {
            let positions = measured(&settings.newton, truth, &voltages, noise, seed);
            error.add(at_once(&settings, &positions, &voltages, truth).flux - truth.flux);
        }
        let n = window as f64;
        let spread = n * (n * n - 1.0) * (n * n - 4.0) / 180.0;
        let expected = noise / (spread.sqrt() * T * T * truth.flux);
        // The standard deviation of 1000 numbers is known to 2.2 %.
        assert!((error.value() / expected - 1.0).abs() < 0.08, "{window}: {} {expected}", error.value());
    }
}

#[test]
fn longer_windows_see_through_noise_in_the_loop() {
    let mut before = f64::MAX;
    for (window, noise_free_limit) in [(3, 1e-7), (10, 1e-9), (30, 1e-9), (64, 1e-9)] {
        let settings = settings(10, window);
        for noise in [0.0, 1e-9] {
            let mut observer = WindowedNewtonObserver::new(OBSERVER_START);
            let mut error = RootMeanSquare::default();
            Experiment { position_noise: noise, seed: 7, ..Experiment::noise_free() }.run(
                law_a,
                |_, position, voltage| observer.update(&settings, position, voltage),
                |tick, truth, estimate, _| {
                    if tick >= 500 {
                        error.add(estimate.state.flux - truth.flux);
                    }
                },
            );
            if noise == 0.0 {
                assert!(error.value() < noise_free_limit, "{window}: {}", error.value());
            } else {
                // 4.4e-2, 4.5e-3, 3.2e-4, 4.4e-5 Wb: at least N^-1.5, as the flux is not steady.
                assert!(error.value() < before / 4.0, "{window}: {} after {before}", error.value());
                before = error.value();
            }
        }
    }
}

#[test]
fn window_may_change_on_the_way() {
    let mut observer = WindowedNewtonObserver::new(OBSERVER_START);
    let mut tick = 0;
    let windows = [3, 64, 10, 5, 30];
    Experiment { samples: 500, ..Experiment::noise_free() }.run(
        law_a,
        |_, position, voltage| {
            tick += 1;
            observer.update(&settings(10, windows[(tick - 1) / 100]), position, voltage)
        },
        |tick, truth, estimate, _| {
            assert!(tick < 50 || (estimate.state.flux - truth.flux).abs() < 1e-7, "{tick}");
        },
    );
}
