//! The reduced-order observer in closed loop with law (8a): the printed one's bias, and its absence once the lag is
//! compensated.

mod sampled_loop;

use maglev_fmu::observer::reduced_newton::{ReducedNewtonObserver, ReducedNewtonSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map};
use sampled_loop::{Experiment, OBSERVER_START, RootMeanSquare, T, law_a};

/// d = 100 of Table 1: with 10 the printed map needs several samples to leave the start at nearly zero flux.
fn settings(map: Map, filter_time: f64, lag_compensated: bool) -> ReducedNewtonSettings {
    ReducedNewtonSettings {
        bearing: MagneticBearing { epsilon: 0.0 },
        map,
        sample_time: T,
        filter_time,
        lag_compensated,
        max_iterations: 100,
        step_size: 1.0,
    }
}

/// Root mean square of the flux error \[Wb\] from 50 ms to 10 s.
fn flux_error(settings: ReducedNewtonSettings) -> f64 {
    let mut observer = ReducedNewtonObserver::new(OBSERVER_START);
    let mut error = RootMeanSquare::default();
    Experiment::noise_free().run(
        law_a,
        |_, position, voltage| observer.update(&settings, position, voltage),
        |tick, truth, estimate, _| {
            if tick >= 50 {
                error.add(estimate.state.flux - truth.flux);
            }
        },
    );
    error.value()
}

#[test]
fn printed_observer_is_biased() {
    // An independent implementation found 0.0161, 0.0277, 0.0518 Wb.
    for (filter_time, expected) in [(1e-4, 0.0161), (1e-3, 0.0277), (1e-2, 0.0518)] {
        let error = flux_error(settings(Map::Printed, filter_time, false));
        assert!((error / expected - 1.0).abs() < 0.005, "T_s = {filter_time}: {error}");
    }
}

#[test]
fn compensated_observer_is_not() {
    for filter_time in [0.0, 1e-4, 1e-3, 1e-2, 1e-1] {
        for (map, limit) in [(Map::Printed, 1e-7), (Map::Exact, 1e-9)] {
            for max_iterations in [10, 100] {
                let error =
                    flux_error(ReducedNewtonSettings { max_iterations, ..settings(map, filter_time, true) });
                assert!(error < limit, "T_s = {filter_time}, {map:?}: {error}");
            }
        }
    }
}
