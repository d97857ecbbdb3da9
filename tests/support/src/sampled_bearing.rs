//! The sampled loop of the paper with sensor and process noise, and a source of normally distributed numbers.

use maglev_fmu::controller::bearing_feedback::{self, Gains, Law};
use maglev_fmu::controller::saturate;
use maglev_fmu::observer::Estimate;
use maglev_fmu::plant::magnetic_bearing::{MagneticBearing, Map, State};
use rand_core::Rng;
use rand_pcg::Pcg64;

pub const T: f64 = 1e-3;
pub const LIMIT: f64 = 150.0;
pub const OBSERVER_START: State = State { position: 0.0, velocity: 0.0, flux: 1e-9 };
pub const PRINTED_GAINS: Gains = Gains { position: 0.92, velocity: 9.94 };

/// Standard normal numbers by Box and Muller.
pub struct Normal(Pcg64);

impl Normal {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::new(u128::from(seed), 0xa02bdbf7bb3c0a7ac28fa16a64abf96))
    }

    /// Uniform in (0, 1\].
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 1.0) / (1u64 << 53) as f64
    }

    pub fn sample(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }
}

/// One experiment: true plant, its noise, and how long.
#[derive(Clone, Copy)]
pub struct Experiment {
    pub bearing: MagneticBearing,
    pub start: State,
    pub initial_voltage: f64,
    /// T \[s\]
    pub sample_time: f64,
    /// Standard deviations \[m\], \[Wb\].
    pub position_noise: f64,
    pub flux_noise: f64,
    /// What the actuator adds to the voltage \[V\] unknown to the observer.
    pub voltage_offset: f64,
    pub seed: u64,
    pub samples: usize,
}

impl Experiment {
    /// Table 1 of the paper, x1(0) = 0.01, u(0) = -150, 10 s without noise.
    pub fn noise_free() -> Self {
        Self {
            bearing: MagneticBearing { epsilon: 0.0 },
            start: State { position: 0.01, velocity: 0.0, flux: 1e-9 },
            initial_voltage: -150.0,
            sample_time: T,
            position_noise: 0.0,
            flux_noise: 0.0,
            voltage_offset: 0.0,
            seed: 0,
            samples: 10_000,
        }
    }

    /// Runs the loop. `observe` gets the true state, the measured position and the voltage that acted before;
    /// `look` sees each tick: index, true state, estimate, voltage from now on.
    pub fn run(
        &self,
        law: impl Fn(State) -> f64,
        mut observe: impl FnMut(State, f64, f64) -> Estimate,
        mut look: impl FnMut(usize, State, &Estimate, f64),
    ) {
        let mut normal = Normal::new(self.seed);
        let (mut state, mut voltage) = (self.start, 0.0);
        for tick in 0..self.samples {
            let position = state.position + self.position_noise * normal.sample();
            let estimate = observe(state, position, voltage);
            voltage = if tick == 0 {
                self.initial_voltage
            } else {
                saturate(law(State { position, ..estimate.state }), LIMIT, voltage)
            };
            look(tick, state, &estimate, voltage);
            state = self.bearing.advance(Map::Exact, state, voltage + self.voltage_offset, self.sample_time);
            state.flux += self.flux_noise * normal.sample();
        }
    }
}

/// The printed law (8a).
pub fn law_a(state: State) -> f64 {
    bearing_feedback::voltage(Law::A, PRINTED_GAINS, state)
}

/// The true state, as an observer.
pub fn state_feedback(state: State, _position: f64, _voltage: f64) -> Estimate {
    Estimate { state, residual: 0.0, iterations: 0, converged: true }
}

/// Root of a mean square.
#[derive(Clone, Copy, Default)]
pub struct RootMeanSquare {
    sum: f64,
    count: f64,
}

impl RootMeanSquare {
    pub fn add(&mut self, error: f64) {
        self.add_square(error * error);
    }

    pub fn add_square(&mut self, square: f64) {
        self.sum += square;
        self.count += 1.0;
    }

    pub fn value(&self) -> f64 {
        (self.sum / self.count).sqrt()
    }
}
