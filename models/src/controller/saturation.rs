//! Limits of the actuator.

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

/// `voltage` limited to `minimum` .. `maximum`, all in V, for a drive that is not symmetric. A value that is not a number
/// yields `held`.
#[inline]
pub fn saturate_between(voltage: f64, (minimum, maximum): (f64, f64), held: f64) -> f64 {
    if voltage >= minimum && voltage <= maximum {
        return voltage;
    }
    let voltage = if voltage.is_nan() { held } else { voltage };
    voltage.max(minimum).min(maximum)
}

#[cfg(test)]
mod tests {
    use super::{saturate, saturate_between};

    #[test]
    fn unequal_limits_hold() {
        assert_eq!(saturate_between(0.7, (0.0, 5.0), 0.0), 0.7);
        assert_eq!(saturate_between(f64::INFINITY, (0.0, 5.0), 0.0), 5.0);
        assert_eq!(saturate_between(-0.1, (0.0, 5.0), 3.0), 0.0);
        assert_eq!(saturate_between(f64::NAN, (0.0, 5.0), 3.0), 3.0);
        assert_eq!(saturate_between(f64::NAN, (0.0, 5.0), -3.0), 0.0);
    }

    #[test]
    fn output_is_finite_and_within_the_limit() {
        assert_eq!(saturate(3.0, 150.0, 0.0), 3.0);
        assert_eq!(saturate(f64::INFINITY, 150.0, 0.0), 150.0);
        assert_eq!(saturate(f64::NEG_INFINITY, 150.0, 0.0), -150.0);
        assert_eq!(saturate(f64::NAN, 150.0, -7.0), -7.0);
        assert_eq!(saturate(f64::NAN, 150.0, 200.0), 150.0);
    }
}
