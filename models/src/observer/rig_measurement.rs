//! What an observer of the maglev rig takes for its measurement y: the sensor voltage, or the distance it stands for.

use super::extended_state::ExtendedState;
use crate::plant::maglev_rig::PositionSensor;
use serde::{Deserialize, Serialize};

/// How a sensor voltage \[V\] and the observer's measurement relate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Measurement {
    Volts(PositionSensor),
    Metres(PositionSensor),
}

impl Measurement {
    #[inline]
    pub fn sensor(&self) -> &PositionSensor {
        match self {
            Self::Volts(sensor) | Self::Metres(sensor) => sensor,
        }
    }

    /// y at a sensor voltage \[V\].
    #[inline]
    pub fn of(&self, sensor_voltage: f64) -> f64 {
        match self {
            Self::Volts(_) => sensor_voltage,
            Self::Metres(sensor) => sensor.position(sensor_voltage),
        }
    }

    /// y at a position \[m\].
    #[inline]
    pub fn of_position(&self, position: f64) -> f64 {
        match self {
            Self::Volts(sensor) => sensor.voltage(position),
            Self::Metres(_) => position,
        }
    }

    /// Inverse of [`Self::of_position`] \[m\].
    #[inline]
    pub fn position(&self, measured: f64) -> f64 {
        match self {
            Self::Volts(sensor) => sensor.position(measured),
            Self::Metres(_) => measured,
        }
    }

    /// y per metre.
    #[inline]
    pub fn scale(&self) -> f64 {
        match self {
            Self::Volts(sensor) => sensor.gain,
            Self::Metres(_) => 1.0,
        }
    }

    /// An estimate of y in sensor volts.
    #[inline]
    pub fn in_volts(&self, z: ExtendedState) -> ExtendedState {
        match self {
            Self::Volts(_) => z,
            Self::Metres(sensor) => ExtendedState {
                position: sensor.voltage(z.position),
                velocity: sensor.gain * z.velocity,
                extended: sensor.gain * z.extended,
            },
        }
    }

    /// An estimate of y in metres.
    #[inline]
    pub fn in_metres(&self, z: ExtendedState) -> ExtendedState {
        match self {
            Self::Metres(_) => z,
            Self::Volts(sensor) => ExtendedState {
                position: sensor.position(z.position),
                velocity: z.velocity / sensor.gain,
                extended: z.extended / sensor.gain,
            },
        }
    }

    /// An input gain for y in sensor volts \[1/s2\].
    pub fn input_gain_in_volts(&self, input_gain: f64) -> f64 {
        match self {
            Self::Volts(_) => input_gain,
            Self::Metres(sensor) => sensor.gain * input_gain,
        }
    }
}
