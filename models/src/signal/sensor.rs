//! Sensor resolution.

use crate::scalar::Scalar;

/// `value` rounded to the nearest multiple of `resolution`, in the same unit; 0 is an ideal sensor.
pub fn quantise<S: Scalar>(value: S, resolution: S) -> S {
    if resolution.is_zero() {
        return value;
    }
    let quantised = (value / resolution).rint() * resolution;
    // A resolution beyond the range of the quotient cannot matter.
    if quantised.is_finite() { quantised } else { value }
}

#[cfg(test)]
mod tests {
    use super::quantise;

    #[test]
    fn rounds_to_the_grid() {
        assert_eq!(quantise(0.12, 0.0), 0.12);
        assert_eq!(quantise(0.8, 0.5), 1.0);
        assert_eq!(quantise(-0.8, 0.5), -1.0);
        assert_eq!(quantise(1.0, 1e-320), 1.0);
    }
}
