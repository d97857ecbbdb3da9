//! Observers of three papers on the rig, behind one interface: sensor voltage and voltage in, velocity out.

use nalgebra::{Matrix3, RowVector3, Vector3};

use crate::observer::extended_state::ExtendedState;
use crate::observer::sampled_extended_state::{ExtendedStateObserver, ExtendedStateSettings};
use crate::plant::maglev_rig::MaglevRig;
use crate::study::rig::recording::{RIG, Recording, SAMPLE_TIME, SENSOR, SET_POINT};

/// An observer that is run over a recording.
pub trait Estimator {
    /// Takes the sensor voltage of a sample and the voltage that acted since the sample before \[V\]; returns the velocity
    /// at the sample \[m/s\].
    fn update(&mut self, sensor_voltage: f64, voltage: f64) -> f64;
}

/// rms (x' - estimate) \[m/s\] from sample `start` on; `None` if it is not finite.
pub fn velocity_error(mut estimator: impl Estimator, recording: &Recording, start: usize) -> Option<f64> {
    let (mut sum, mut count, mut acted) = (0.0, 0.0, RIG.operating_voltage(SET_POINT));
    for (sample, (measured, voltage)) in recording.sensor_voltage.iter().zip(&recording.voltage).enumerate() {
        let error = recording.velocity[sample] - estimator.update(*measured, acted);
        acted = *voltage;
        if sample >= start {
            sum += error * error;
            count += 1.0;
        }
    }
    let error = libm::sqrt(sum / count);
    error.is_finite().then_some(error)
}

/// LESO, NESO and their current forms in sensor volts, from a steady start.
pub struct ExtendedStateEstimator(ExtendedStateObserver);

impl ExtendedStateEstimator {
    pub fn new(settings: ExtendedStateSettings) -> Self {
        let steady = ExtendedState {
            position: SENSOR.voltage(SET_POINT),
            velocity: 0.0,
            extended: -settings.input_gain * RIG.operating_voltage(SET_POINT),
        };
        Self(ExtendedStateObserver::new(settings, steady))
    }
}

impl Estimator for ExtendedStateEstimator {
    fn update(&mut self, sensor_voltage: f64, voltage: f64) -> f64 {
        self.0.update(sensor_voltage, voltage).state.velocity / SENSOR.gain
    }
}

/// x \[m\], x' \[m/s\] and a disturbing acceleration d \[m/s2\] that keeps its value.
type State = Vector3<f64>;

/// State after a sample under a held voltage, one Runge-Kutta step of (6) with the printed mass.
fn predict(state: &State, voltage: f64) -> State {
    let rig: &MaglevRig = &RIG;
    let rate = |s: &State| Vector3::new(s.y, rig.acceleration(s.x, voltage, 0.0) + s.z, 0.0);
    let first = rate(state);
    let second = rate(&(state + first * (0.5 * SAMPLE_TIME)));
    let third = rate(&(state + second * (0.5 * SAMPLE_TIME)));
    let fourth = rate(&(state + third * SAMPLE_TIME));
    state + (first + (second + third) * 2.0 + fourth) * (SAMPLE_TIME / 6.0)
}

/// Derivative of [`predict`]: I + A T + A^2 T^2 / 2 with the stiffness 2 a u^2 / x^3.
fn slope(state: &State, voltage: f64) -> Matrix3<f64> {
    let stiffness = 2.0 * (RIG.gravity - RIG.acceleration(state.x, voltage, 0.0)) / state.x;
    let a = Matrix3::new(0.0, 1.0, 0.0, stiffness, 0.0, 1.0, 0.0, 0.0, 0.0);
    Matrix3::identity() + a * SAMPLE_TIME + a * a * (0.5 * SAMPLE_TIME * SAMPLE_TIME)
}

fn at_rest() -> State {
    Vector3::new(SET_POINT, 0.0, 0.0)
}

/// Extended Kalman filter with a disturbing acceleration as third state, which performs a random walk.
pub struct DisturbanceKalman {
    state: State,
    covariance: Matrix3<f64>,
    /// Of the disturbance's random walk over a sample, with what it does to velocity and position.
    process_noise: Matrix3<f64>,
    /// Variance of the measured position \[m2\].
    sensor_variance: f64,
    is_first: bool,
}

impl DisturbanceKalman {
    /// `intensity` q of the random walk \[m/s2 per square root of s\], `sensor_noise` that it assumes \[V\].
    pub fn new(intensity: f64, sensor_noise: f64) -> Self {
        let t = SAMPLE_TIME;
        let powers = [t, t * t / 2.0, t * t * t / 6.0, t * t * t / 3.0, t.powi(4) / 8.0, t.powi(5) / 20.0];
        let [p1, p2, p3, v3, v4, v5] = powers;
        let noise = Matrix3::new(v5, v4, p3, v4, v3, p2, p3, p2, p1) * (intensity * intensity);
        Self {
            state: at_rest(),
            covariance: Matrix3::from_diagonal(&Vector3::new(1e-6, 1e-4, 1.0)),
            process_noise: noise,
            sensor_variance: (sensor_noise / SENSOR.gain).powi(2),
            is_first: true,
        }
    }
}

impl Estimator for DisturbanceKalman {
    fn update(&mut self, sensor_voltage: f64, voltage: f64) -> f64 {
        if !self.is_first {
            let slope = slope(&self.state, voltage);
            self.state = predict(&self.state, voltage);
            self.covariance = slope * self.covariance * slope.transpose() + self.process_noise;
        }
        self.is_first = false;
        let innovation = SENSOR.position(sensor_voltage) - self.state.x;
        let gain = self.covariance.column(0) / (self.covariance[(0, 0)] + self.sensor_variance);
        self.state += gain * innovation;
        // Joseph's form keeps the covariance symmetric and positive.
        let left = Matrix3::identity() - gain * RowVector3::new(1.0, 0.0, 0.0);
        self.covariance =
            left * self.covariance * left.transpose() + gain * gain.transpose() * self.sensor_variance;
        self.state.y
    }
}

/// Longest window of [`WindowedNewton`].
pub const MAX_WINDOW: usize = 64;

/// Newton observer of the bearing's paper on the rig's model: the state at the window's first sample from which the model
/// explains all its samples best, by Gauss-Newton, carried to the last one.
pub struct WindowedNewton {
    /// Samples, oldest first: sensor position \[m\] and the voltage that acted up to it \[V\].
    samples: Vec<(f64, f64)>,
    window: usize,
    /// Whether a constant disturbance over the window is estimated, too.
    with_disturbance: bool,
    /// Estimate at the oldest sample.
    oldest: State,
}

/// Gauss-Newton iterations per sample; it starts from the last solution.
const ITERATIONS: usize = 3;

impl WindowedNewton {
    pub fn new(window: usize, with_disturbance: bool) -> Self {
        Self {
            samples: Vec::with_capacity(MAX_WINDOW),
            window: window.clamp(3, MAX_WINDOW),
            with_disturbance,
            oldest: at_rest(),
        }
    }

    /// One step, false if the equations have no solution.
    fn improve(&mut self) -> bool {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        let (mut state, mut sensitivity) = (self.oldest, Matrix3::identity());
        for (index, (position, voltage)) in self.samples.iter().enumerate() {
            if index > 0 {
                sensitivity = slope(&state, *voltage) * sensitivity;
                state = predict(&state, *voltage);
            }
            let row = sensitivity.row(0).transpose();
            normal += row * row.transpose();
            right += row * (position - state.x);
        }
        if !self.with_disturbance {
            normal.row_mut(2).fill(0.0);
            normal.column_mut(2).fill(0.0);
            normal[(2, 2)] = 1.0;
            right.z = 0.0;
        }
        // Scaled to unit diagonal: columns are in m, s and s2.
        let scale = normal.diagonal().map(|element| 1.0 / libm::sqrt(element));
        let scaled = Matrix3::from_fn(|row, column| normal[(row, column)] * scale[row] * scale[column]);
        let Some(step) = scaled.lu().solve(&right.component_mul(&scale)) else { return false };
        let step = step.component_mul(&scale);
        if !step.iter().all(|component| component.is_finite()) {
            return false;
        }
        self.oldest += step;
        // The model is singular at the coil.
        self.oldest.x = self.oldest.x.clamp(1e-3, 0.1);
        true
    }

    /// State at the newest sample.
    fn newest(&self) -> State {
        self.samples.iter().skip(1).fold(self.oldest, |state, (_, voltage)| predict(&state, *voltage))
    }
}

impl Estimator for WindowedNewton {
    fn update(&mut self, sensor_voltage: f64, voltage: f64) -> f64 {
        if self.samples.len() == self.window {
            self.samples.remove(0);
            if let Some((_, acted)) = self.samples.first() {
                self.oldest = predict(&self.oldest, *acted);
            }
        }
        self.samples.push((SENSOR.position(sensor_voltage), voltage));
        if self.samples.len() > 3 {
            for _ in 0..ITERATIONS {
                if !self.improve() {
                    break;
                }
            }
        }
        self.newest().y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::rig::recording::{Conditions, Reference};

    #[test]
    fn model_based_observers_are_exact_without_noise_and_error() {
        let recording = Recording::make(&Conditions::new(Reference::SineAndStep, 3.0));
        let kalman = velocity_error(DisturbanceKalman::new(100.0, 1e-6), &recording, 500).unwrap();
        let newton = velocity_error(WindowedNewton::new(8, false), &recording, 500).unwrap();
        let disturbed = velocity_error(WindowedNewton::new(12, true), &recording, 500).unwrap();
        for error in [kalman, newton, disturbed] {
            assert!(error < 2e-5, "{kalman:e} {newton:e} {disturbed:e}");
        }
    }

    #[test]
    fn disturbance_states_bear_a_wrong_mass() {
        let heavy = Conditions { mass_ratio: 1.2, ..Conditions::new(Reference::SineAndStep, 3.0) };
        let recording = Recording::make(&heavy);
        let without = velocity_error(WindowedNewton::new(8, false), &recording, 500).unwrap();
        let with = velocity_error(WindowedNewton::new(8, true), &recording, 500).unwrap();
        let kalman = velocity_error(DisturbanceKalman::new(100.0, 1e-5), &recording, 500).unwrap();
        assert!(without > 5.0 * with && without > 5.0 * kalman, "{without:e} {with:e} {kalman:e}");
    }

    #[test]
    fn slope_is_the_derivative_of_the_prediction() {
        let state = Vector3::new(9.3e-3, 0.05, 2.0);
        let analytic = slope(&state, 0.8);
        for column in 0..3 {
            let mut shift = Vector3::zeros();
            shift[column] = [1e-8, 1e-5, 1e-3][column];
            let difference =
                (predict(&(state + shift), 0.8) - predict(&(state - shift), 0.8)) / (2.0 * shift[column]);
            // The slope is that at the start of the step, 1 % off over a millisecond.
            let column = analytic.column(column);
            assert!((difference - column).norm() < 0.01 * column.norm(), "{difference} {column}");
        }
    }
}
