//! Posterior Cramer-Rao bound of the bearing (Tichavsky, Muravchik, Nehorai 1998): without process noise, or with noise
//! on the flux alone, it is the Kalman covariance with the Jacobians along the true trajectory.

use super::SCORED_FROM;
use crate::host::Trace;
use crate::observer::factored_covariance::FactoredCovariance;
use crate::observer::kalman::INITIAL_VARIANCES;
use crate::plant::magnetic_bearing::{MagneticBearing, Map};

/// Smallest possible root mean square errors of an unbiased observer over the scored part of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// \[m/s\]
    pub velocity: f64,
    /// \[Wb\]
    pub flux: f64,
}

/// The bound for a sensor of `noise` \[m\] along the trajectory of a run without process noise.
pub fn cramer_rao(trace: &Trace, sample_time: f64, noise: f64) -> Bound {
    let bearing = MagneticBearing { epsilon: 0.0 };
    let mut covariance = FactoredCovariance::diagonal(INITIAL_VARIANCES);
    let (mut velocity, mut flux, mut count) = (0.0, 0.0, 0.0);
    let columns = trace.column("plant.flux").unwrap_or_default().iter();
    let samples = columns.zip(trace.column("controller.voltage").unwrap_or_default());
    for (time, (true_flux, voltage)) in trace.time.iter().zip(samples) {
        if noise > 0.0 {
            covariance.measure_position(noise * noise);
        }
        if *time >= SCORED_FROM {
            let matrix = covariance.matrix();
            velocity += matrix[(1, 1)];
            flux += matrix[(2, 2)];
            count += 1.0;
        }
        let slope = bearing.force_effect_slope(Map::Exact, *true_flux, *voltage, sample_time);
        covariance.advance(slope, sample_time);
    }
    if noise > 0.0 {
        Bound { velocity: (velocity / count).sqrt(), flux: (flux / count).sqrt() }
    } else {
        Bound { velocity: 0.0, flux: 0.0 }
    }
}
