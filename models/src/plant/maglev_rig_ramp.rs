//! The maglev rig under inputs that move along straight lines.

use super::contact::{Contact, Guided};
use super::end_stops;
use super::maglev_rig::{HeldBall, LONGEST_SUBSTEP, State};

/// The ball under a voltage and a force that start from those of `begin`; the driver limits the voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampedBall {
    /// With the voltage that is asked for, not yet limited.
    pub begin: HeldBall,
    /// \[V/s\]
    pub voltage_slope: f64,
    /// \[N/s\]
    pub force_slope: f64,
    /// Smallest and largest voltage of the driver \[V\].
    pub voltage_limits: (f64, f64),
}

impl RampedBall {
    /// State and contact after `duration` \[s\].
    pub fn advance(&self, state: State, contact: Contact, duration: f64) -> (State, Contact) {
        let (mut numbers, mut contact) = ([state.position, state.velocity, 0.0], contact);
        end_stops::advance(self, &mut numbers, &mut contact, duration, LONGEST_SUBSTEP);
        let [position, velocity, _] = numbers;
        (State { position, velocity }, contact)
    }

    /// Mean of the limited voltage over `duration` \[s\], without cancellation: within the limits the mean of the ends,
    /// beyond them the limit, each for its share of the time.
    pub fn mean_voltage(&self, duration: f64) -> f64 {
        let (begin, end) = (self.begin.voltage, self.begin.voltage + self.voltage_slope * duration);
        let (first, last) = (self.limited(begin), self.limited(end));
        let span = end - begin;
        if span == 0.0 || (first == begin && last == end) {
            return 0.5 * (first + last);
        }
        let (before, after) = ((first - begin) / span, (end - last) / span);
        // Beyond a limit all the time.
        if first == last {
            return first;
        }
        before * first + after * last + (1.0 - before - after) * 0.5 * (first + last)
    }

    fn limited(&self, voltage: f64) -> f64 {
        voltage.max(self.voltage_limits.0).min(self.voltage_limits.1)
    }
}

impl Guided<3> for RampedBall {
    /// The third state is the time since the begin \[s\].
    #[inline]
    fn rate(&self, &[position, velocity, time]: &[f64; 3]) -> [f64; 3] {
        let held = HeldBall {
            voltage: self.limited(self.begin.voltage + self.voltage_slope * time),
            force: self.begin.force + self.force_slope * time,
            ..self.begin
        };
        let [position_rate, velocity_rate] = held.rate(&[position, velocity]);
        [position_rate, velocity_rate, 1.0]
    }

    #[inline]
    fn rate_at_rest(&self, _: &[f64; 3]) -> [f64; 3] {
        [0.0, 0.0, 1.0]
    }

    fn stops(&self) -> (f64, f64) {
        self.begin.stops()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::maglev_rig::MaglevRig;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn mean_voltage_is_that_of_many_samples(voltage in -3.0..8.0f64, slope in -2e4..2e4f64) {
            let begin = HeldBall { rig: MaglevRig::PRINTED, voltage, force: 0.0, upper_stop: 1e-3, lower_stop: 25e-3 };
            let ball = RampedBall { begin, voltage_slope: slope, force_slope: 0.0, voltage_limits: (0.0, 5.0) };
            let samples = 100_000;
            let sampled = (0..samples)
                .map(|k| ball.limited(voltage + slope * 1e-3 * (f64::from(k) + 0.5) / f64::from(samples)))
                .sum::<f64>() / f64::from(samples);
            prop_assert!((ball.mean_voltage(1e-3) - sampled).abs() < 1e-7, "{} {}", ball.mean_voltage(1e-3), sampled);
        }
    }
}
