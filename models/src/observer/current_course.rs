//! Current and integrated voltage between two samples of the levitated ball's observer, normalised as in
//! [`super::flux_regression`].

use super::flux_regression::Sample;

/// Smallest normalised flux to divide by.
pub(super) const SMALLEST_FLUX: f64 = 0.2;

/// How current and integrated voltage went between two samples, with the voltage constant.
///
/// The current is a parabola through both samples; its curvature is the change of I' = -v l + z S over the sample, in which
/// z = I / l^ and v^ are the observer's and v^ is taken to change as over the sample before. What they are wrong by enters
/// with the square of the sample time, and not at all at rest.
pub(super) struct Course {
    past: Sample,
    rise: f64,
    /// Height of the parabola above the straight line is `bulge` x (1 - x).
    bulge: f64,
    /// U, damping and T
    source: f64,
    damping: f64,
    duration: f64,
}

impl Course {
    #[inline]
    pub(super) fn new(
        past: Sample,
        current: f64,
        (source, damping): (f64, f64),
        [offset, velocity, velocity_after]: [f64; 3],
        duration: f64,
    ) -> Self {
        let (induced_before, induced_after) = (source - damping * past.current, source - damping * current);
        let flux_before = past.flux + offset;
        let flux_after = flux_before + 0.5 * duration * (induced_before + induced_after);
        let slope = |flux: f64, velocity: f64, current: f64, induced: f64| {
            current / flux.max(SMALLEST_FLUX) * induced - velocity * flux
        };
        let before = slope(flux_before, velocity, past.current, induced_before);
        let after = slope(flux_after, velocity_after, current, induced_after);
        Self {
            past,
            rise: current - past.current,
            bulge: 0.5 * duration * (before - after),
            source,
            damping,
            duration,
        }
    }

    /// At the share `x` of the sample.
    #[inline]
    pub(super) fn at(&self, x: f64) -> Sample {
        let mean_current = self.past.current + x * (0.5 * self.rise + self.bulge * (0.5 - x * (1.0 / 3.0)));
        Sample {
            flux: self.past.flux + x * self.duration * (self.source - self.damping * mean_current),
            current: self.past.current + x * (self.rise + self.bulge * (1.0 - x)),
        }
    }
}
