//! Digital PID controller with anti-windup, of the maglev rig (Humaidi et al. 2018, Kp = 4.2, Ki = 2.2, Kd = 0.02).
//!
//! The paper prints the gains alone. Position in sensor volts, the sign, the bias u0, T = 1 ms and the form are
//! reconstructed; with the position in metres, or with the usual error r - y, these gains do not stabilise the rig:
//!
//! ```text
//! e = y - r       u = sat(u0 + Kp e + Ki sum(e T) + Kd (e[k] - e[k-1]) / T)
//! ```
//!
//! y grows as the ball falls, therefore y - r. The sum contains the newest error. It stands still while the output is
//! limited and the error would drive it further beyond the limit (conditional integration).

use super::saturate_between;
use serde::{Deserialize, Serialize};

/// What the derivative is taken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Derivative {
    /// Of e, as reconstructed: a step of the reference kicks the output.
    Error,
    /// Of y alone.
    Measurement,
}

/// Gains and limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PidSettings {
    /// Kp \[V/V\]
    pub proportional_gain: f64,
    /// Ki \[V/(V s)\]
    pub integral_gain: f64,
    /// Kd \[V s/V\]
    pub derivative_gain: f64,
    pub derivative: Derivative,
    /// u0 \[V\], the output without an error.
    pub operating_voltage: f64,
    /// T \[s\]
    pub sample_time: f64,
    /// Smallest and largest output \[V\].
    pub limits: (f64, f64),
}

/// Memory of the controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DigitalPid {
    /// Ki sum(e T) \[V\]: a change of Ki does not kick the output.
    integral: f64,
    /// What the derivative is taken of, at the last sample.
    previous: Option<f64>,
}

impl DigitalPid {
    /// u \[V\] within the limits, for y and r \[V\].
    #[inline]
    pub fn update(&mut self, settings: &PidSettings, measurement: f64, reference: f64) -> f64 {
        let error = measurement - reference;
        let differentiated = match settings.derivative {
            Derivative::Error => error,
            Derivative::Measurement => measurement,
        };
        let change = differentiated - self.previous.unwrap_or(differentiated);
        self.previous = Some(differentiated);
        let increment = settings.integral_gain * error * settings.sample_time;
        let integral = self.integral + increment;
        let wanted = settings.operating_voltage
            + settings.proportional_gain * error
            + integral
            + settings.derivative_gain * change / settings.sample_time;
        let (minimum, maximum) = settings.limits;
        let winds_up = (wanted > maximum && increment > 0.0) || (wanted < minimum && increment < 0.0);
        // An integral that is not finite would never come back.
        if !winds_up && integral.is_finite() {
            self.integral = integral;
        }
        saturate_between(wanted, settings.limits, settings.operating_voltage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTINGS: PidSettings = PidSettings {
        proportional_gain: 4.2,
        integral_gain: 2.2,
        derivative_gain: 0.02,
        derivative: Derivative::Error,
        operating_voltage: 0.75,
        sample_time: 1e-3,
        limits: (0.0, 5.0),
    };

    #[test]
    fn output_at_hand_worked_points() {
        let mut pid = DigitalPid::default();
        // No derivative at the first sample: 0.75 + 4.2 * 0.01 + 2.2 * 0.01 * 1e-3.
        let first = pid.update(&SETTINGS, -1.49, -1.5);
        assert!((first - 0.792_022).abs() < 1e-15);
        // e = 0.015: 0.75 + 0.063 + 2.2e-3 * 0.025 + 0.02 * 0.005 / 1e-3.
        let second = pid.update(&SETTINGS, -1.485, -1.5);
        assert!((second - 0.913_055).abs() < 1e-14);
    }

    #[test]
    fn measurement_derivative_ignores_a_reference_step() {
        let settings = PidSettings { derivative: Derivative::Measurement, ..SETTINGS };
        let (mut on_error, mut on_measurement) = (DigitalPid::default(), DigitalPid::default());
        on_error.update(&SETTINGS, -1.5, -1.5);
        on_measurement.update(&settings, -1.5, -1.5);
        let kick = on_error.update(&SETTINGS, -1.5, -1.6) - on_measurement.update(&settings, -1.5, -1.6);
        assert!((kick - 2.0).abs() < 1e-12, "0.02 * 0.1 V / 1 ms, got {kick}");
    }

    #[test]
    fn integral_does_not_wind_up() {
        let mut pid = DigitalPid::default();
        for _ in 0..100_000 {
            assert_eq!(pid.update(&SETTINGS, 0.5, -1.5), 5.0);
        }
        assert!(pid.integral <= 2.2 * 2.0 * 1e-3, "{}", pid.integral);
        // Back at the set point the output is back, but for the derivative of one sample.
        pid.update(&SETTINGS, -1.5, -1.5);
        assert!((pid.update(&SETTINGS, -1.5, -1.5) - 0.75).abs() < 5e-3);
    }

    #[test]
    fn no_input_poisons_the_integral() {
        let mut pid = DigitalPid::default();
        for (measurement, reference) in [(f64::MAX, -f64::MAX), (-f64::MAX, f64::MAX), (1e300, 0.0)] {
            let voltage = pid.update(&SETTINGS, measurement, reference);
            assert!((0.0..=5.0).contains(&voltage));
        }
        for _ in 0..3 {
            pid.update(&SETTINGS, -1.5, -1.5);
        }
        assert!((pid.update(&SETTINGS, -1.5, -1.5) - 0.75).abs() < 1e-9);
    }
}
