//! Smoothed reference with its derivatives, for laws that feed them forward.
//!
//! ```text
//! r'' = w^2 (c - r) - 2 w r'      two poles at -w, c the commanded value
//! ```
//!
//! solved exactly for a command held over each sample.

use serde::{Deserialize, Serialize};

/// Reference, in the unit of the command, and its first two derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    pub position: f64,
    /// per second
    pub velocity: f64,
    /// per second squared
    pub acceleration: f64,
}

impl Reference {
    /// A reference that rests.
    pub const fn at_rest(position: f64) -> Self {
        Self { position, velocity: 0.0, acceleration: 0.0 }
    }
}

/// The filter for one bandwidth and sample time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceFilter {
    bandwidth: f64,
    sample_time: f64,
    decay: f64,
}

impl ReferenceFilter {
    /// `bandwidth` w \[rad/s\], 0 for none; `sample_time` \[s\].
    pub fn new(bandwidth: f64, sample_time: f64) -> Self {
        Self { bandwidth, sample_time, decay: libm::exp(-bandwidth * sample_time) }
    }

    /// The reference one sample later, under the command of that sample; the command itself without a filter.
    ///
    /// With d = r - c: d(T) = e^-wT (d (1 + w T) + r' T), r'(T) = e^-wT (r' (1 - w T) - w^2 T d).
    #[inline]
    pub fn advance(&self, reference: Reference, command: f64) -> Reference {
        let (w, t) = (self.bandwidth, self.sample_time);
        if w == 0.0 {
            return Reference::at_rest(command);
        }
        let distance = reference.position - command;
        let left = self.decay * (distance * (1.0 + w * t) + reference.velocity * t);
        let velocity = self.decay * (reference.velocity * (1.0 - w * t) - w * w * t * distance);
        Reference { position: command + left, velocity, acceleration: -w * w * left - 2.0 * w * velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn samples_compose(w in 1.0..500.0f64, r in -1.0..1.0f64, rate in -10.0..10.0f64, command in -1.0..1.0f64) {
            let start = Reference { position: r, velocity: rate, acceleration: 0.0 };
            let whole = ReferenceFilter::new(w, 2e-3).advance(start, command);
            let half = ReferenceFilter::new(w, 1e-3);
            let halves = half.advance(half.advance(start, command), command);
            prop_assert!((whole.position - halves.position).abs() < 1e-14);
            prop_assert!((whole.velocity - halves.velocity).abs() < 1e-12);
            prop_assert!((whole.acceleration - halves.acceleration).abs() < 1e-12 * w * w);
        }

        #[test]
        fn derivatives_are_those_of_the_reference(w in 1.0..500.0f64, r in -1.0..1.0f64, rate in -10.0..10.0f64) {
            let start = Reference { position: r, velocity: rate, acceleration: 0.0 };
            let at = |time| ReferenceFilter::new(w, time).advance(start, 0.3);
            let (before, now, after) = (at(1e-3 - 1e-7), at(1e-3), at(1e-3 + 1e-7));
            let slope = (after.position - before.position) / 2e-7;
            let curvature = (after.velocity - before.velocity) / 2e-7;
            prop_assert!((slope - now.velocity).abs() < 1e-6 * (1.0 + w));
            prop_assert!((curvature - now.acceleration).abs() < 1e-6 * (1.0 + w * w));
        }
    }

    #[test]
    fn reference_settles_without_overshoot() {
        let filter = ReferenceFilter::new(50.0, 1e-3);
        let mut reference = Reference::at_rest(0.0);
        for _ in 0..1000 {
            let next = filter.advance(reference, 1.0);
            assert!(next.position >= reference.position && next.position <= 1.0);
            reference = next;
        }
        assert!((reference.position - 1.0).abs() < 1e-14);
        assert_eq!(ReferenceFilter::new(0.0, 1e-3).advance(reference, 0.2), Reference::at_rest(0.2));
    }
}
