//! Limit of the actuator.

/// `voltage` limited to ±`limit`, both in V. A value that is not a number yields `held`, so that nothing
/// non-finite can leave a law.
#[inline]
pub fn saturate(voltage: f64, limit: f64, held: f64) -> f64 {
    // The usual case first: a predicted branch costs the control loop no latency.
    if voltage.abs() <= limit {
        return voltage;
    }
    let voltage = if voltage.is_nan() { held } else { voltage };
    voltage.max(-limit).min(limit)
}

#[cfg(test)]
mod tests {
    use super::saturate;

    #[test]
    fn output_is_finite_and_within_the_limit() {
        assert_eq!(saturate(3.0, 150.0, 0.0), 3.0);
        assert_eq!(saturate(f64::INFINITY, 150.0, 0.0), 150.0);
        assert_eq!(saturate(f64::NEG_INFINITY, 150.0, 0.0), -150.0);
        assert_eq!(saturate(f64::NAN, 150.0, -7.0), -7.0);
        assert_eq!(saturate(f64::NAN, 150.0, 200.0), 150.0);
    }
}
