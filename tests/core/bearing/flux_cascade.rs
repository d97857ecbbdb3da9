//! The flux cascade in closed loop, from every start of the paper's Table 1.

use maglev_fmu::controller::flux_cascade::FluxCascade;
use maglev_fmu::observer::Estimate;
use maglev_fmu::observer::kalman::{KalmanObserver, KalmanSettings};
use maglev_fmu::observer::newton::{NewtonObserver, NewtonSettings};
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use maglev_fmu_test::sampled_bearing::{Experiment, LIMIT, OBSERVER_START, T, state_feedback};

const SLOW: FluxCascade =
    FluxCascade { position_gain: 25.0, velocity_gain: 10.0, flux_gain: 200.0, regularisation: 1e-3 };
const FAST: FluxCascade = FluxCascade { position_gain: 100.0, velocity_gain: 20.0, ..SLOW };

/// Largest values over all starts.
#[derive(Debug, Default)]
struct Worst {
    /// Time after which |x1| stays below 1e-5 m \[s\].
    settling_time: f64,
    /// |u| after the first sample \[V\].
    voltage: f64,
    /// |x1| after 3 s \[m\].
    rest: f64,
}

type Observe = Box<dyn FnMut(State, f64, f64) -> Estimate>;

fn worst(
    cascade: FluxCascade,
    epsilon: f64,
    noise: f64,
    observer: impl Fn(MagneticBearing) -> Observe,
) -> Worst {
    let bearing = MagneticBearing { epsilon };
    let mut worst = Worst::default();
    for position in [0.0, 0.001, 0.01] {
        for initial_voltage in [-50.0, -100.0, -150.0] {
            let experiment = Experiment {
                bearing,
                start: State { position, velocity: 0.0, flux: 1e-9 },
                initial_voltage,
                position_noise: noise,
                samples: 4000,
                ..Experiment::noise_free()
            };
            let law = |state| cascade.voltage(&bearing, state);
            experiment.run(law, observer(bearing), |tick, truth, _, voltage| {
                let time = tick as f64 * T;
                assert!(voltage.abs() <= LIMIT);
                if tick > 0 {
                    worst.voltage = worst.voltage.max(voltage.abs());
                }
                if truth.position.abs() > 1e-5 {
                    worst.settling_time = worst.settling_time.max(time + T);
                }
                if time >= 3.0 {
                    worst.rest = worst.rest.max(truth.position.abs());
                }
            });
        }
    }
    worst
}

fn newton(bearing: MagneticBearing) -> Observe {
    let (map, sample_time, max_iterations, step_size) = (Map::Exact, T, 10, 1.0);
    let settings =
        NewtonSettings { bearing, map, sample_time, max_iterations, step_size, line_search: false };
    let mut observer = NewtonObserver::new(OBSERVER_START);
    Box::new(move |_, position, voltage| observer.update(&settings, position, voltage))
}

fn kalman(bearing: MagneticBearing, position_noise: f64) -> Observe {
    let settings =
        KalmanSettings { bearing, map: Map::Exact, sample_time: T, position_noise, flux_noise: 1e-6 };
    let mut observer = KalmanObserver::new(OBSERVER_START);
    Box::new(move |_, position, voltage| observer.update(&settings, position, voltage))
}

#[test]
fn settles_with_state_feedback() {
    for epsilon in [0.0, 0.0909] {
        let slow = worst(SLOW, epsilon, 0.0, |_| Box::new(state_feedback));
        // An independent implementation found 1.86 s and 90 V, and 0.93 s.
        assert!(
            slow.settling_time <= 1.86 && slow.voltage <= 90.0,
            "{} {}",
            slow.settling_time,
            slow.voltage
        );
        let fast = worst(FAST, epsilon, 0.0, |_| Box::new(state_feedback));
        assert!(fast.settling_time <= 0.94, "{fast:?}");
    }
}

#[test]
fn settles_with_estimates() {
    for epsilon in [0.0, 0.0909] {
        let exact = worst(SLOW, epsilon, 0.0, newton);
        assert!(exact.settling_time <= 1.87 && exact.voltage <= 100.0, "newton {exact:?}");
        for position_noise in [1e-9, 1e-6] {
            let filtered = worst(SLOW, epsilon, 0.0, |bearing| kalman(bearing, position_noise));
            assert!(filtered.settling_time <= 1.87, "{filtered:?}");
        }
    }
}

#[test]
fn settles_under_noise() {
    let noise = 1e-7;
    for epsilon in [0.0, 0.0909] {
        // The filter's default assumes ten times as much.
        for position_noise in [noise, 1e-6] {
            let filtered = worst(SLOW, epsilon, noise, |bearing| kalman(bearing, position_noise));
            assert!(filtered.settling_time <= 2.0, "{filtered:?}");
            assert!(filtered.rest <= 20.0 * noise, "{filtered:?}");
        }
    }
}
