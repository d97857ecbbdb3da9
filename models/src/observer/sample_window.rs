//! The last samples of a measurement, with the inputs that acted between them.

use super::saved_count::count_up_to;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// Longest window \[samples\].
pub const MAX_WINDOW: usize = 64;

/// Samples, oldest first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SampleWindow {
    #[serde(with = "BigArray")]
    measurements: [f64; MAX_WINDOW],
    /// What acted from each of these to the next.
    #[serde(with = "BigArray")]
    inputs: [f64; MAX_WINDOW],
    #[serde(deserialize_with = "count_up_to::<_, MAX_WINDOW>")]
    samples: usize,
}

impl SampleWindow {
    pub const EMPTY: Self = Self { measurements: [0.0; MAX_WINDOW], inputs: [0.0; MAX_WINDOW], samples: 0 };

    #[inline]
    pub fn len(&self) -> usize {
        self.samples
    }

    #[inline]
    pub fn measurements(&self) -> &[f64] {
        &self.measurements[..self.samples]
    }

    /// One less than measurements.
    #[inline]
    pub fn inputs(&self) -> &[f64] {
        &self.inputs[..self.samples.saturating_sub(1)]
    }

    /// Takes a sample and the input that acted since the one before; a full window drops its oldest one.
    #[inline]
    pub fn push(&mut self, measurement: f64, input: f64) {
        if self.samples == MAX_WINDOW {
            self.drop_oldest();
        }
        if self.samples > 0 {
            self.inputs[self.samples - 1] = input;
        }
        self.measurements[self.samples] = measurement;
        self.samples += 1;
    }

    /// Forgets the oldest sample, if there is one.
    #[inline]
    pub fn drop_oldest(&mut self) {
        if self.samples > 0 {
            self.measurements.copy_within(1..self.samples, 0);
            self.inputs.copy_within(1..self.samples, 0);
            self.samples -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_keeps_the_last_samples_and_what_acted_between_them() {
        let mut window = SampleWindow::EMPTY;
        window.drop_oldest();
        assert_eq!((window.measurements(), window.inputs()), (&[][..], &[][..]));
        for k in 0..100 {
            window.push(f64::from(k), 0.5 + f64::from(k));
        }
        assert_eq!(window.len(), MAX_WINDOW);
        window.drop_oldest();
        let (measurements, inputs) = (window.measurements(), window.inputs());
        assert_eq!((measurements.len(), inputs.len()), (63, 62));
        assert!(measurements.iter().zip(37..).all(|(measurement, k)| *measurement == f64::from(k)));
        // What acted before a sample came with it.
        assert!(inputs.iter().zip(38..).all(|(input, k)| *input == 0.5 + f64::from(k)));
    }
}
