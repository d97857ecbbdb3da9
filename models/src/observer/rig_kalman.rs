//! Kalman filter of the maglev rig: not in its paper, for a sensor with noise and a disturbance that is to be estimated.
//!
//! An extended Kalman filter on [`DisturbedRig`] whose disturbing acceleration performs a random walk, the only process
//! noise. Its innovation is that of the position in metres.

use super::kalman_filter::{Innovation, KalmanFilter};
use super::rig_model::{DisturbedRig, RigEstimate, is_plausible};
use serde::{Deserialize, Serialize};

/// Variances of the initial position \[m2\], velocity \[m2/s2\] and disturbance \[m2/s4\].
const INITIAL_VARIANCES: [f64; 3] = [1e-6, 1e-4, 1.0];

/// A prediction over one sample that misses by more than this part of the measured distance, and by so many of its
/// standard deviations, was that of another ball: the filter starts anew. Without a disturbance, and thus without
/// process noise, it would not come back, for far from the coil the model is stable and the gain goes to zero.
const MISSED: f64 = 0.1;
const GATE: f64 = 10.0;

/// What the filter believes of its plant and its sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigKalmanSettings {
    pub model: DisturbedRig,
    /// Standard deviation of the measured position \[m\], above 0.
    pub position_noise: f64,
    /// Standard deviation of the disturbance's random walk after a second \[m/s2\], at least 0; without one there is no
    /// disturbance at all.
    pub disturbance_noise: Option<f64>,
}

/// Estimate and covariance after the last sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigKalmanObserver {
    filter: KalmanFilter<3>,
    is_first: bool,
}

impl RigKalmanObserver {
    /// A filter that expects `initial`.
    pub fn new(settings: &RigKalmanSettings, initial: [f64; 3]) -> Self {
        Self { filter: expecting(settings, initial), is_first: true }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before. The first
    /// sample corrects the initial state; there is no step before it.
    #[inline(never)]
    pub fn update(&mut self, settings: &RigKalmanSettings, position: f64, voltage: f64) -> RigEstimate {
        let RigKalmanSettings { model, position_noise, disturbance_noise } = settings;
        let mut filter = self.filter;
        if !self.is_first {
            filter.predict(model, voltage, &model.random_walk(disturbance_noise.unwrap_or(0.0)));
        }
        let innovation = filter.correct(position, position_noise * position_noise);
        // At the first sample the start may be anywhere.
        let is_missed = !self.is_first && misses(&innovation, position);
        self.is_first = false;
        let restarted = is_missed || !(filter.is_valid() && is_plausible(&filter.state));
        self.filter = if restarted { expecting(settings, [position, 0.0, 0.0]) } else { filter };
        RigEstimate { state: self.filter.state, innovation: innovation.value, restarted }
    }
}

/// Whether the position before a sample was another one than that measured \[m\], see [`MISSED`].
#[inline]
fn misses(innovation: &Innovation, position: f64) -> bool {
    let miss = innovation.value.abs();
    miss > MISSED * position.abs() && miss * miss > GATE * GATE * innovation.variance
}

fn expecting(settings: &RigKalmanSettings, [position, velocity, disturbance]: [f64; 3]) -> KalmanFilter<3> {
    let [first, second, third] = INITIAL_VARIANCES;
    match settings.disturbance_noise {
        Some(_) => KalmanFilter::new([position, velocity, disturbance], [first, second, third]),
        // Known to be none: it stays 0, and so does its variance.
        None => KalmanFilter::new([position, velocity, 0.0], [first, second, 0.0]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::process_model::ProcessModel;
    use crate::plant::maglev_rig::MaglevRig;
    use nalgebra::{Matrix3, RowVector3, Vector3};

    const MODEL: DisturbedRig = DisturbedRig { rig: MaglevRig::PRINTED, sample_time: 1e-3 };
    const SETTINGS: RigKalmanSettings =
        RigKalmanSettings { model: MODEL, position_noise: 7e-6, disturbance_noise: Some(2.0) };

    /// A moving ball whose position is read with a deterministic error: state, reading and the voltage from then on.
    fn samples(disturbance: f64, error: f64) -> impl Iterator<Item = ([f64; 3], f64, f64)> {
        (0..400).scan([9e-3, 0.0, disturbance], move |state, k| {
            let at = *state;
            // Held near the set point, so that the ball stays in the air.
            let wanted = 0.76 + 0.02 * libm::sin(0.05 * f64::from(k));
            let voltage = wanted + 150.0 * (at[0] - 9e-3) + 2.5 * at[1];
            *state = MODEL.predict(&at, voltage);
            Some((at, at[0] + error * libm::sin(91.0 * f64::from(k)), voltage))
        })
    }

    #[test]
    fn filter_is_the_textbooks_with_joseph_form() {
        let mut observer = RigKalmanObserver::new(&SETTINGS, [9.2e-3, 0.0, 0.0]);
        let (mut state, mut acted) = (Vector3::new(9.2e-3, 0.0, 0.0), 0.0);
        let mut covariance = Matrix3::from_diagonal(&Vector3::from(INITIAL_VARIANCES));
        let noise = MODEL.random_walk(2.0).matrix();
        let variance = SETTINGS.position_noise * SETTINGS.position_noise;
        for (k, (_, measured, voltage)) in samples(0.5, 7e-6).enumerate() {
            if k > 0 {
                let (next, slope) = MODEL.linearised(&state.into(), acted);
                let f = Matrix3::from_fn(|row, column| slope[row][column]);
                state = next.into();
                covariance = f * covariance * f.transpose() + noise;
            }
            let gain = covariance.column(0) / (covariance[(0, 0)] + variance);
            state += gain * (measured - state.x);
            let left = Matrix3::identity() - gain * RowVector3::new(1.0, 0.0, 0.0);
            covariance = left * covariance * left.transpose() + gain * gain.transpose() * variance;
            let estimate = observer.update(&SETTINGS, measured, acted);
            acted = voltage;
            assert!(!estimate.restarted);
            for (own, expected) in estimate.state.iter().zip([1e-2, 1e-1, 10.0].iter().zip(state.iter())) {
                assert!((own - expected.1).abs() < 1e-9 * expected.0, "{k}: {:?} {state}", estimate.state);
            }
            let spread = covariance.diagonal().map(libm::sqrt);
            let difference = observer.filter.covariance.matrix() - covariance;
            assert!(difference.component_div(&(spread * spread.transpose())).amax() < 1e-6, "{k}");
        }
    }

    #[test]
    fn disturbance_is_found_and_without_one_there_is_none() {
        let last = |settings: RigKalmanSettings, disturbance: f64| {
            let mut observer = RigKalmanObserver::new(&settings, [9e-3, 0.0, 3.0]);
            let mut acted = 0.0;
            let pairs = samples(disturbance, 0.0).map(|(state, measured, voltage)| {
                let estimate = observer.update(&settings, measured, acted).state;
                acted = voltage;
                (state, estimate)
            });
            pairs.last().unwrap()
        };
        let exact = RigKalmanSettings { position_noise: 1e-9, ..SETTINGS };
        let (state, estimate) = last(exact, 0.5);
        assert!((state[1] - estimate[1]).abs() < 1e-6 && (estimate[2] - 0.5).abs() < 1e-3, "{estimate:?}");
        let (state, estimate) = last(RigKalmanSettings { disturbance_noise: None, ..SETTINGS }, 0.0);
        assert!((state[1] - estimate[1]).abs() < 1e-6 && estimate[2] == 0.0, "{estimate:?}");
    }

    #[test]
    fn a_ball_beyond_the_coil_is_a_restart() {
        let mut observer = RigKalmanObserver::new(&SETTINGS, [9e-3, 0.0, 0.0]);
        assert!(!observer.update(&SETTINGS, 9e-3, 0.0).restarted);
        let estimate = observer.update(&SETTINGS, -1.0, 0.76);
        assert_eq!((estimate.state, estimate.restarted), ([-1.0, 0.0, 0.0], true));
        // The ball is back in one sample, which is another miss; from then on it is followed.
        let estimate = observer.update(&SETTINGS, 9e-3, 0.76);
        assert_eq!((estimate.state, estimate.restarted), ([9e-3, 0.0, 0.0], true));
        let estimate = observer.update(&SETTINGS, 9e-3, 0.76);
        assert!(!estimate.restarted && (estimate.state[0] - 9e-3).abs() < 1e-4, "{estimate:?}");
    }
}
