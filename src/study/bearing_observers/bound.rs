//! Posterior Cramer-Rao bound of the bearing (Tichavsky, Muravchik, Nehorai 1998): without process noise, or with noise
//! on the flux alone, it is the Kalman covariance with the Jacobians along the true trajectory.

use super::conditions::SCORED_FROM;
use crate::observer::factored_covariance::FactoredCovariance;
use crate::observer::kalman::INITIAL_VARIANCES;
use crate::plant::magnetic_bearing::{MagneticBearing, Map};
use crate::study::run::Run;

/// Smallest possible root mean square errors of an unbiased observer over the scored part of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// \[m/s\]
    pub velocity: f64,
    /// \[Wb\]
    pub flux: f64,
}

/// The bound for a sensor of `noise` \[m\] along the trajectory of a run without process noise.
pub fn cramer_rao(run: &Run, sample_time: f64, noise: f64) -> Bound {
    let bearing = MagneticBearing { epsilon: 0.0 };
    let mut covariance = FactoredCovariance::from_variances(INITIAL_VARIANCES);
    let (mut velocity, mut flux, mut count) = (0.0, 0.0, 0.0);
    let samples = run.state("flux").iter().zip(&run["controller.voltage"]);
    for (time, (true_flux, voltage)) in run.time.iter().zip(samples) {
        if noise > 0.0 {
            covariance.measurement_update(noise * noise);
        }
        if *time >= SCORED_FROM {
            let matrix = covariance.matrix();
            velocity += matrix[(1, 1)];
            flux += matrix[(2, 2)];
            count += 1.0;
        }
        let slope = bearing.force_effect_slope(Map::Exact, *true_flux, *voltage, sample_time);
        covariance.advance([[0.0, sample_time, slope.position], [0.0, 0.0, slope.velocity], [0.0; 3]]);
    }
    if noise > 0.0 {
        Bound { velocity: (velocity / count).sqrt(), flux: (flux / count).sqrt() }
    } else {
        Bound { velocity: 0.0, flux: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::*;

    /// The same bound from the information matrix itself, in the textbook form.
    fn by_information(run: &Run, sample_time: f64, noise: f64) -> Bound {
        let bearing = MagneticBearing { epsilon: 0.0 };
        let mut information =
            Matrix3::from_diagonal(&Vector3::from(INITIAL_VARIANCES.map(|variance| 1.0 / variance)));
        let (mut velocity, mut flux, mut count) = (0.0, 0.0, 0.0);
        for (row, time) in run.time.iter().enumerate() {
            information[(0, 0)] += 1.0 / (noise * noise);
            if *time >= SCORED_FROM {
                let covariance = information.try_inverse().unwrap();
                velocity += covariance[(1, 1)];
                flux += covariance[(2, 2)];
                count += 1.0;
            }
            let (flux, voltage) = (run.state("flux")[row], run["controller.voltage"][row]);
            let back = bearing.jacobian(Map::Exact, flux, voltage, sample_time).try_inverse().unwrap();
            information = back.transpose() * information * back;
        }
        Bound { velocity: f64::sqrt(velocity / count), flux: f64::sqrt(flux / count) }
    }

    #[test]
    fn agrees_with_the_information_matrix() {
        let sample_time = 1e-2;
        let time: Vec<f64> = (0..200).map(|k| f64::from(k) * sample_time).collect();
        let voltage: Vec<f64> = time.iter().map(|t| 2.0 * (7.0 * t).cos()).collect();
        let flux = time.iter().map(|t| 0.1 + 2.0 / 7.0 * (7.0 * t).sin()).collect();
        let run = Run::new(time).with("plant.flux", flux).with("controller.voltage", voltage);
        // A noise at which the information matrix is still well conditioned.
        let (noise, relative) = (1e-3, |a: f64, b: f64| (a / b - 1.0).abs());
        let (bound, reference) =
            (cramer_rao(&run, sample_time, noise), by_information(&run, sample_time, noise));
        assert!(relative(bound.flux, reference.flux) < 1e-9, "{bound:?} {reference:?}");
        assert!(relative(bound.velocity, reference.velocity) < 1e-9, "{bound:?} {reference:?}");
        assert_eq!(cramer_rao(&run, sample_time, 0.0), Bound { velocity: 0.0, flux: 0.0 });
    }
}
