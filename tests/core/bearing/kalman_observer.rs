//! The Kalman filter in closed loop against the posterior Cramer-Rao bound.

use maglev_fmu::observer::kalman::{INITIAL_VARIANCES, KalmanObserver, KalmanSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use maglev_fmu_test::sampled_bearing::{Experiment, OBSERVER_START, RootMeanSquare, T, law_a};
use proptest::prelude::*;

const BEARING: MagneticBearing = MagneticBearing { epsilon: 0.0 };

fn settings(position_noise: f64, flux_noise: f64) -> KalmanSettings {
    KalmanSettings { bearing: BEARING, map: Map::Exact, sample_time: T, position_noise, flux_noise }
}

/// Information about the state along the true trajectory, as its upper triangular root: J = R^T R. Independent of
/// the filter's covariance form, and as sound.
struct Information([[f64; 3]; 3]);

impl Information {
    fn prior() -> Self {
        let root = INITIAL_VARIANCES.map(|variance| 1.0 / variance.sqrt());
        Self([[root[0], 0.0, 0.0], [0.0, root[1], 0.0], [0.0, 0.0, root[2]]])
    }

    /// J + h h^T / sigma^2 with h = (1, 0, 0).
    fn measure(&mut self, noise: f64) {
        let [a, b, c] = self.0;
        let mut rows = [a, b, c, [1.0 / noise, 0.0, 0.0]];
        triangularise(&mut rows);
        self.0 = [rows[0], rows[1], rows[2]];
    }

    /// x := F x + (0, 0, w), linearised at the true flux. Stacks the information on w / q and on x and eliminates w.
    fn advance(&mut self, flux: f64, voltage: f64, noise: f64) {
        let f = BEARING.jacobian(Map::Exact, flux, voltage, T);
        let (t, p, v) = (f[(0, 1)], f[(0, 2)], f[(1, 2)]);
        // R F^-1
        let moved = self.0.map(|[x, y, z]| [x, y - t * x, z - v * y - (p - t * v) * x]);
        let mut rows = [[1.0, 0.0, 0.0, 0.0]; 4];
        for (row, [x, y, z]) in rows[1..].iter_mut().zip(moved) {
            *row = [-z * noise, x, y, z];
        }
        triangularise(&mut rows);
        self.0 = [1, 2, 3].map(|row| [rows[row][1], rows[row][2], rows[row][3]]);
    }

    /// Bound of the flux's variance \[Wb2\]: the flux is last, so that its root stands alone.
    fn flux_variance(&self) -> f64 {
        1.0 / (self.0[2][2] * self.0[2][2])
    }
}

/// Givens rotations of the rows.
fn triangularise<const N: usize>(rows: &mut [[f64; N]; 4]) {
    for column in 0..N {
        for row in column + 1..4 {
            let (upper, lower) = (rows[column], rows[row]);
            if lower[column] == 0.0 {
                continue;
            }
            let length = libm::hypot(upper[column], lower[column]);
            let (c, s) = (upper[column] / length, lower[column] / length);
            for k in 0..N {
                rows[column][k] = c * upper[k] + s * lower[k];
                rows[row][k] = c * lower[k] - s * upper[k];
            }
        }
    }
}

/// Root mean squares of the flux error and of its bound \[Wb\] from 0.5 s on.
fn efficiency(position_noise: f64, flux_noise: f64, seeds: u64, samples: usize) -> (f64, f64) {
    let settings = settings(position_noise, flux_noise);
    let (mut error, mut bound) = (RootMeanSquare::default(), RootMeanSquare::default());
    for seed in 0..seeds {
        let mut observer = KalmanObserver::new(OBSERVER_START);
        let mut information = Information::prior();
        let experiment = Experiment { position_noise, flux_noise, seed, samples, ..Experiment::noise_free() };
        experiment.run(
            law_a,
            |_, position, voltage| observer.update(&settings, position, voltage),
            |tick, truth, estimate, voltage| {
                information.measure(position_noise);
                if tick >= 500 {
                    error.add(estimate.state.flux - truth.flux);
                    bound.add_square(information.flux_variance());
                }
                information.advance(truth.flux, voltage, flux_noise);
            },
        );
    }
    (error.value(), bound.value())
}

/// rms flux error over 100 runs of 10 s, the first 0.5 s left out, within 1.1 times its bound.
fn assert_efficient(position_noise: f64, flux_noise: f64) {
    let (error, bound) = efficiency(position_noise, flux_noise, 100, 10_000);
    let ratio = error / bound;
    println!("{position_noise:e} m {flux_noise:e} Wb: {error:.3e} bound {bound:.3e} ratio {ratio:.3}");
    assert!(ratio <= 1.1, "{position_noise} m, {flux_noise} Wb: {ratio}");
}

#[test]
fn reaches_the_bound_with_small_process_noise() {
    for position_noise in [1e-7, 1e-6] {
        assert_efficient(position_noise, 1e-6);
    }
}

#[test]
fn reaches_the_bound_with_large_process_noise() {
    for position_noise in [1e-7, 1e-6] {
        assert_efficient(position_noise, 1e-5);
    }
}

/// The errors of a run have one cause, so that 100 runs know their size to 7 %.
#[test]
fn reaches_the_bound_without_process_noise() {
    for position_noise in [1e-9, 1e-8, 1e-7, 1e-6] {
        assert_efficient(position_noise, 0.0);
    }
}

#[test]
fn finds_a_wrong_start_without_noise() {
    for position_noise in [1e-12, 1e-9, 1e-7] {
        for flux_noise in [0.0, 1e-6] {
            for (velocity, flux) in [(0.0, 0.1), (0.01, -0.3), (0.05, 0.3)] {
                let settings = settings(position_noise, flux_noise);
                let mut observer = KalmanObserver::new(OBSERVER_START);
                let start = State { position: 0.01, velocity, flux };
                Experiment { start, samples: 1000, ..Experiment::noise_free() }.run(
                    law_a,
                    |_, position, voltage| observer.update(&settings, position, voltage),
                    |tick, truth, estimate, _| {
                        let error = (estimate.state.flux - truth.flux).abs();
                        assert!(
                            tick < 500 || (error < 1e-6 && estimate.converged),
                            "{start:?} {tick} {error}"
                        );
                    },
                );
            }
        }
    }
}

#[test]
fn covariance_survives_a_million_steps() {
    for (position_noise, flux_noise) in [(1e-12, 0.0), (1e-6, 1e-6)] {
        let settings = settings(position_noise, flux_noise);
        let observer = std::cell::RefCell::new(KalmanObserver::new(OBSERVER_START));
        Experiment { position_noise, samples: 1_000_000, ..Experiment::noise_free() }.run(
            law_a,
            |_, position, voltage| observer.borrow_mut().update(&settings, position, voltage),
            |tick, truth, estimate, _| {
                let covariance = observer.borrow().covariance();
                let deviation = covariance.diagonal().map(f64::sqrt);
                assert!(deviation.iter().all(|value| *value > 0.0), "{tick} {deviation}");
                for (row, column) in [(0, 1), (0, 2), (1, 2)] {
                    let correlation = covariance[(row, column)] / (deviation[row] * deviation[column]);
                    assert!(correlation.abs() <= 1.0 + 1e-12, "{tick} {correlation}");
                }
                let error = (estimate.state.flux - truth.flux).abs();
                assert!(tick < 500 || error < 8.0 * deviation[2] + 1e-12, "{tick} {error} {deviation}");
            },
        );
    }
}

#[test]
fn flux_noise_buys_robustness() {
    // An actuator 1 mV off moves the flux by 1e-6 Wb per sample: the default flux noise follows, zero does not.
    let error = |flux_noise| {
        let settings = settings(1e-6, flux_noise);
        let mut observer = KalmanObserver::new(OBSERVER_START);
        let mut error = RootMeanSquare::default();
        let experiment =
            Experiment { position_noise: 1e-6, voltage_offset: 1e-3, ..Experiment::noise_free() };
        experiment.run(
            law_a,
            |_, position, voltage| observer.update(&settings, position, voltage),
            |tick, truth, estimate, _| {
                if tick >= 500 {
                    error.add(estimate.state.flux - truth.flux);
                }
            },
        );
        println!("{flux_noise:e}: {:.3e}", error.value());
        error.value()
    };
    let (none, default, large) = (error(0.0), error(1e-6), error(1e-5));
    assert!(default < none / 2.0 && large < default, "{none} {default} {large}");
}

proptest! {
    #[test]
    fn nothing_non_finite_leaves_the_observer(
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 3..80), epsilon in 0.0..1.0f64,
        position_noise in any::<f64>(), flux_noise in any::<f64>(), exact: bool,
    ) {
        prop_assume!(position_noise.is_finite() && flux_noise.is_finite());
        let map = if exact { Map::Exact } else { Map::Printed };
        let bearing = MagneticBearing { epsilon };
        let settings = KalmanSettings { bearing, map, sample_time: T, position_noise, flux_noise };
        let mut observer = KalmanObserver::new(OBSERVER_START);
        for (position, voltage) in samples {
            let estimate = observer.update(&settings, position, voltage);
            prop_assert!(estimate.state.is_finite() && estimate.residual.is_finite());
        }
    }

    /// After a sample that overflows the model the filter starts over and finds the flux again.
    #[test]
    fn recovers_from_overflow(exponent in 250.0..308.0f64, mirrored: bool, voltage in -150.0..150.0f64) {
        let position = libm::pow(10.0, exponent) * if mirrored { -1.0 } else { 1.0 };
        let settings = settings(1e-9, 1e-6);
        let mut observer = KalmanObserver::new(OBSERVER_START);
        let mut truth = State { position: 0.01, velocity: 0.0, flux: 0.1 };
        for tick in 0..400 {
            let estimate = if tick == 100 {
                observer.update(&settings, position, voltage)
            } else {
                observer.update(&settings, truth.position, if tick > 0 { 1.0 } else { 0.0 })
            };
            let error = (estimate.state.flux - truth.flux).abs();
            prop_assert!(tick != 100 || !estimate.converged);
            prop_assert!(!(50..100).contains(&tick) && tick < 350 || error < 1e-4, "{} {}", tick, error);
            truth = BEARING.advance(Map::Exact, truth, 1.0, T);
        }
    }
}
