//! Kalman filter of the magnetic bearing: not in the paper, for positions with noise.
//!
//! ```text
//! x[k] = F(x[k-1], u[k-1]) + (0, 0, w)      w ~ N(0, flux_noise^2)
//! y[k] = x1[k] + n                          n ~ N(0, position_noise^2)
//! ```
//!
//! The covariance is kept as U D U^T (`factored_covariance`), the correction is scalar. Once the flux is known the
//! prediction is that of the extended Kalman filter: F and its Jacobian in closed form. While the flux is uncertain
//! the force is strongly nonlinear in it, and a filter that only linearises at its latest estimate takes early errors
//! of the linearisation for information: with flux_noise = 0 it stays up to 1.45 times (T = 0.1 ms: 30 to 100 times)
//! above the Cramer-Rao bound for seconds. Two measures avoid that:
//!
//! - Three nodes, the flux and the flux +- sqrt(3 P33), give the mean of the force effect and of its slope (Gauss and
//!   Hermite's, Simpson's rule), and what a linear function of the flux cannot explain counts as noise. As P33 falls
//!   this becomes F and its Jacobian.
//! - The first 64 samples are kept. After 8, 16, 32 and 64 the filter runs over them again, linearised along the flux
//!   that the latest estimate implies for them: a Gauss-Newton step on the whole beginning. This waits until the
//!   flux is known to a tenth of its size.
//!
//! Measured in the loop with law (8a), x1(0) = 0.01, u(0) = -150, T = 1 ms, over 0.5 to 10 s: with flux_noise = 0 and
//! the right model the rms flux error is 1.01 times the bound from 1e-9 to 1e-6 m of position noise (1000 seeds, +-
//! 1.5 %), with flux noise in plant and filter 0.99 to 1.00 times (100 seeds). For T = 0.1 ms and flux_noise = 0 the
//! flux stays uncertain beyond the 64 samples, and 3 to 8 times the bound remain.
//!
//! What flux_noise costs and buys at 1e-6 m of position noise, rms flux error in Wb over 100 seeds; a drive that is
//! off by 1 mV moves the flux by 1e-6 Wb per sample:
//!
//! ```text
//! flux_noise           0         1e-7      1e-6      1e-5      1e-4
//! right model          3.0e-6    3.2e-6    9.8e-6    6.7e-5    4.7e-4
//! drive off by 1 mV    3.2e-3    1.3e-3    6.1e-4    3.0e-4    5.1e-4
//! drive off by 10 mV   3.2e-2    1.4e-2    5.7e-3    2.8e-3    1.6e-3
//! ```
//!
//! The default 1e-6 Wb thus gives up a factor of 3 with a perfect model for one of 5 with a drive off by 1 mV, and the
//! gain stays above zero: with 0 the covariance goes to zero and in the end measurements have no effect. A wrong
//! eps (0.001 for 0: 4.9e-4 Wb) is a bias no flux_noise removes. `converged` is then false in most samples where the
//! filter trusts its model too much (84 % in the second row for 0 and 1e-7, none from 1e-6 on).

use super::Estimate;
use super::kalman_filter::{Innovation, KalmanFilter};
use super::sample_window::{MAX_WINDOW, SampleWindow};
use crate::plant::magnetic_bearing::{ForceEffect, MagneticBearing, Map, State};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// Variances of the initial position \[m2\], velocity \[m2/s2\] and flux \[Wb2\].
pub const INITIAL_VARIANCES: [f64; 3] = [1e-4, 1e-4, 1e-2];

/// Limits of the position noise \[m\]: below a double's resolution of a millimetre nothing is measured, and the
/// square of the upper one is finite.
const NOISE_LIMITS: (f64, f64) = (1e-18, 1e100);

/// Innovations of more than so many standard deviations do not fit the model.
const GATE: f64 = 6.0;

/// Samples of the beginning that are kept, and the fewest over which the filter runs again.
const BEGINNING: usize = MAX_WINDOW;
const SHORTEST_BEGINNING: usize = 8;

/// Uncertainty of the flux, relative to its size, up to which the beginning is linearised anew.
const KNOWN_FLUX: f64 = 0.1;

/// What the filter believes of its plant and its sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KalmanSettings {
    pub bearing: MagneticBearing,
    /// Model of a step; the filter is meant for the exact one.
    pub map: Map,
    /// T \[s\]
    pub sample_time: f64,
    /// Standard deviation of the measured position \[m\], above 0.
    pub position_noise: f64,
    /// Standard deviation of what each sample adds to the flux beyond u T \[Wb\], at least 0.
    pub flux_noise: f64,
}

/// Estimate and covariance after the last sample, and the first samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KalmanObserver {
    filter: KalmanFilter<3>,
    /// Where the filter starts, again when a sample yields nothing finite.
    initial: State,
    /// The first samples, up to [`BEGINNING`]: outputs \[m\] and voltages \[V\].
    beginning: SampleWindow,
    /// Last estimate, kept when a sample yields nothing finite.
    estimate: State,
}

impl KalmanObserver {
    /// A filter that expects `initial`, with [`INITIAL_VARIANCES`].
    pub fn new(initial: State) -> Self {
        Self {
            filter: KalmanFilter::expecting(initial),
            initial,
            beginning: SampleWindow::EMPTY,
            estimate: initial,
        }
    }

    /// Covariance of (position, velocity, flux) after the last sample.
    pub fn covariance(&self) -> Matrix3<f64> {
        self.filter.covariance.matrix()
    }

    /// Standard deviations of position, velocity and flux after the last sample, by the filter's own account.
    #[inline]
    pub fn standard_deviation(&self) -> State {
        // The factors are finite, their products may overflow.
        let [position, velocity, flux] =
            self.filter.covariance.variances().map(|variance| variance.sqrt().min(f64::MAX));
        State { position, velocity, flux }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    ///
    /// The first sample corrects the initial state; there is no step before it. The estimate is the filter's own
    /// from the first sample on, and counts as converged from the third. After a sample that yields nothing finite
    /// the last estimate stands and the filter starts over.
    #[inline(never)]
    pub fn update(&mut self, settings: &KalmanSettings, position: f64, applied_voltage: f64) -> Estimate {
        if self.beginning.len() > 0 {
            self.filter.predict_bearing(settings, applied_voltage);
        }
        let innovation = self.filter.correct_position(settings, position);
        let residual = innovation.value.abs().min(f64::MAX);
        if !self.filter.is_valid() {
            self.filter = KalmanFilter::expecting(self.initial);
            self.beginning = SampleWindow::EMPTY;
            return Estimate { state: self.estimate, residual, iterations: 1, converged: false };
        }
        if self.beginning.len() < BEGINNING {
            self.beginning.push(position, applied_voltage);
            let samples = self.beginning.len();
            if samples >= SHORTEST_BEGINNING && samples.is_power_of_two() {
                self.begin_again(settings);
            }
        }
        let fits = innovation.value * innovation.value <= GATE * GATE * innovation.variance;
        let converged = fits && self.beginning.len() >= 3;
        self.estimate = estimate(&self.filter);
        Estimate { state: self.estimate, residual, iterations: 1, converged }
    }

    /// Runs over the beginning once more, linearised along the flux that the latest estimate implies.
    #[cold]
    fn begin_again(&mut self, settings: &KalmanSettings) {
        let KalmanSettings { sample_time, flux_noise, .. } = *settings;
        let (positions, voltages) = (self.beginning.measurements(), self.beginning.inputs());
        let latest = self.filter.state[2];
        let first = latest - sample_time * voltages.iter().sum::<f64>();
        let variance =
            self.filter.covariance.last_variance() + voltages.len() as f64 * flux_noise * flux_noise;
        if variance.sqrt() > KNOWN_FLUX * latest.abs().max(first.abs()) {
            return;
        }
        let mut filter = KalmanFilter::expecting(self.initial);
        let mut reference = first;
        filter.correct_position(settings, positions[0]);
        for (position, voltage) in positions[1..].iter().zip(voltages) {
            filter.predict_along(settings, *voltage, reference);
            filter.correct_position(settings, *position);
            reference += sample_time * voltage;
        }
        if filter.is_valid() {
            self.filter = filter;
        }
    }
}

impl KalmanFilter<3> {
    fn expecting(initial: State) -> Self {
        Self::new([initial.position, initial.velocity, initial.flux], INITIAL_VARIANCES)
    }

    /// One step, the force effect replaced by its best linear function of a flux with variance P33.
    #[inline]
    fn predict_bearing(&mut self, settings: &KalmanSettings, voltage: f64) {
        let KalmanSettings { bearing, map, sample_time, .. } = *settings;
        let flux = self.state[2];
        let spread = (3.0 * self.covariance.last_variance()).sqrt();
        let nodes = [flux - spread, flux, flux + spread];
        let [low, middle, high] = nodes.map(|node| bearing.force_effect(map, node, voltage, sample_time));
        let slopes = nodes.map(|node| bearing.force_effect_slope(map, node, voltage, sample_time));
        // Three times the variance, times the second derivative.
        let bend = combine([low, middle, high], [1.0, -2.0, 1.0]);
        let mean = combine([middle, bend, bend], [1.0, 1.0 / 6.0, 0.0]);
        let slope = combine(slopes, [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]);
        self.step(settings, voltage, mean, slope);
        self.covariance.add_noise([bend.position, bend.velocity], 1.0 / 18.0);
    }

    /// One step linearised at the flux `reference`.
    fn predict_along(&mut self, settings: &KalmanSettings, voltage: f64, reference: f64) {
        let KalmanSettings { bearing, map, sample_time, .. } = *settings;
        let (effect, slope) = bearing.linearised_force_effect(map, reference, voltage, sample_time);
        let offset = self.state[2] - reference;
        let effect = combine([effect, slope, slope], [1.0, offset, 0.0]);
        self.step(settings, voltage, effect, slope);
    }

    /// x := F(x, u), P := F' P F'^T + Q with the given force effect and slope.
    #[inline]
    fn step(&mut self, settings: &KalmanSettings, voltage: f64, effect: ForceEffect, slope: ForceEffect) {
        let KalmanSettings { sample_time, flux_noise, .. } = *settings;
        let State { position, velocity, flux } = estimate(self).after(effect, voltage, sample_time);
        self.state = [position, velocity, flux];
        self.covariance.advance([[0.0, sample_time, slope.position], [0.0, 0.0, slope.velocity], [0.0; 3]]);
        self.covariance.add_noise_to_last(flux_noise * flux_noise);
    }

    /// A measured position \[m\].
    #[inline]
    fn correct_position(&mut self, settings: &KalmanSettings, position: f64) -> Innovation {
        let noise = settings.position_noise.max(NOISE_LIMITS.0).min(NOISE_LIMITS.1);
        self.correct(position, noise * noise)
    }
}

#[inline]
fn estimate(filter: &KalmanFilter<3>) -> State {
    let [position, velocity, flux] = filter.state;
    State { position, velocity, flux }
}

/// Weighted sum of three force effects.
#[inline]
fn combine(effects: [ForceEffect; 3], weights: [f64; 3]) -> ForceEffect {
    let sum = |component: fn(&ForceEffect) -> f64| {
        component(&effects[0]) * weights[0]
            + component(&effects[1]) * weights[1]
            + component(&effects[2]) * weights[2]
    };
    ForceEffect { velocity: sum(|effect| effect.velocity), position: sum(|effect| effect.position) }
}
