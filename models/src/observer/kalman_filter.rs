//! Extended Kalman filter of any model: estimate, covariance in factors, scalar measurement of the first state.
//!
//! ```text
//! x[k] = F(x[k-1], u[k-1]) + w      w ~ N(0, Q)
//! y[k] = x1[k] + n                  n ~ N(0, R)
//! ```

use super::factored_covariance::FactoredCovariance;
use super::process_model::ProcessModel;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// Estimate and covariance after the last sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KalmanFilter<const N: usize> {
    #[serde(with = "BigArray")]
    pub state: [f64; N],
    pub covariance: FactoredCovariance<N>,
}

/// What a measurement came as news.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation {
    /// Measured less predicted.
    pub value: f64,
    pub variance: f64,
}

impl<const N: usize> KalmanFilter<N> {
    /// A filter that expects `state`, its components independently with `variances`.
    pub const fn new(state: [f64; N], variances: [f64; N]) -> Self {
        Self { state, covariance: FactoredCovariance::from_variances(variances) }
    }

    /// x := F(x, u), P := F' P F'^T + Q
    #[inline]
    pub fn predict(&mut self, model: &impl ProcessModel<N>, input: f64, noise: &FactoredCovariance<N>) {
        let (state, slope) = model.linearised(&self.state, input);
        self.state = state;
        self.covariance.propagate(&slope, noise);
    }

    /// x := x + K (y - x1) for a `measured` y with variance R > 0.
    #[inline]
    pub fn correct(&mut self, measured: f64, variance: f64) -> Innovation {
        let value = measured - self.state[0];
        let gain = self.covariance.measurement_update(variance);
        for (component, weight) in self.state.iter_mut().zip(gain.weights) {
            *component += weight * value;
        }
        Innovation { value, variance: gain.innovation_variance }
    }

    /// Whether estimate and covariance are finite and no variance is negative.
    pub fn is_valid(&self) -> bool {
        self.state.iter().all(|component| component.is_finite()) && self.covariance.is_valid()
    }
}
