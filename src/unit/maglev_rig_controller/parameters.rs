//! What the values of parameters mean to the observers and the laws.

use super::table::*;
use crate::controller::digital_pid::{Derivative, PidSettings};
use crate::controller::disturbance_rejection::DisturbanceRejection;
use crate::observer::extended_state::{
    ExtendedState, LinearInjection, NonlinearInjection, gains_from_bandwidth,
};
use crate::observer::sampled_extended_state::{Discretisation, ExtendedStateSettings, Form, InjectionChoice};
use crate::plant::maglev_rig::PositionSensor;
use crate::unit::UnitError;
use serde::{Deserialize, Serialize};

/// Costs at most \[s\], see [`crate::unit::work`]: of a tick, of a closed form for gains as large as they come, and of a
/// Runge-Kutta step of the observer.
const COST_OF_TICK: f64 = 200e-9;
const COST_OF_CLOSED_FORM: f64 = 3e-6;
const COST_OF_SUBSTEP: f64 = 300e-9;

pub(super) fn observer_settings(values: &[f64; COUNT]) -> ExtendedStateSettings {
    let gains = match Tuning::from_number(values[OBSERVER_TUNING]) {
        Tuning::Gains => [values[OBSERVER_GAIN_1], values[OBSERVER_GAIN_2], values[OBSERVER_GAIN_3]],
        Tuning::Bandwidth => gains_from_bandwidth(values[OBSERVER_BANDWIDTH]),
    };
    let kind = ObserverKind::from_number(values[OBSERVER]);
    let injection = match kind {
        ObserverKind::Linear => InjectionChoice::Linear(LinearInjection { gains }),
        ObserverKind::Nonlinear => InjectionChoice::Nonlinear(NonlinearInjection::new(
            gains,
            [values[EXPONENT_1], values[EXPONENT_2], values[EXPONENT_3]],
            [values[LINEAR_ZONE_1], values[LINEAR_ZONE_2], values[LINEAR_ZONE_3]],
        )),
    };
    let runge_kutta = Discretisation::RungeKutta(values[OBSERVER_SUBSTEPS] as u32);
    let discretisation = match (DiscretisationKind::from_number(values[OBSERVER_DISCRETISATION]), kind) {
        (DiscretisationKind::Exact, _) | (DiscretisationKind::Automatic, ObserverKind::Linear) => {
            Discretisation::Exact
        }
        (DiscretisationKind::RungeKutta, _) | (DiscretisationKind::Automatic, ObserverKind::Nonlinear) => {
            runge_kutta
        }
        (DiscretisationKind::Euler, _) => Discretisation::Euler,
    };
    let form = match FormKind::from_number(values[OBSERVER_FORM]) {
        FormKind::Predictor => Form::Predictor,
        FormKind::Current => Form::Current,
    };
    let (input_gain, sample_time) = (values[OBSERVER_INPUT_GAIN], values[SAMPLE_TIME]);
    ExtendedStateSettings { injection, input_gain, discretisation, form, sample_time }
}

/// The law divides by its input gain.
pub(super) fn check_input_gain(values: &[f64; COUNT]) -> Result<(), UnitError> {
    let divides = LawKind::DisturbanceRejection.is(values[CONTROLLER_KIND_CHOICE]);
    if !divides || values[CONTROLLER_INPUT_GAIN] != 0.0 {
        return Ok(());
    }
    let variable = &VARIABLES[CONTROLLER_INPUT_GAIN];
    let (name, unit) = (variable.name, variable.unit());
    let expected = "another number than 0 with controller.kind = disturbance_rejection";
    Err(UnitError::Unusable { name, value: 0.0, unit, expected })
}

/// What a tick costs at most \[s\], see [`crate::unit::work`].
pub(super) fn cost_of_tick(values: &[f64; COUNT]) -> f64 {
    let ExtendedStateSettings { injection, discretisation, .. } = observer_settings(values);
    let observer = match (discretisation, injection) {
        (Discretisation::RungeKutta(substeps), _) => COST_OF_SUBSTEP * f64::from(substeps),
        // Frozen gains make another closed form of each sample.
        (Discretisation::Exact, InjectionChoice::Nonlinear(_)) => COST_OF_CLOSED_FORM,
        _ => 0.0,
    };
    COST_OF_TICK + observer
}

/// How a sensor voltage \[V\] and the observer's measurement relate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Measurement {
    Volts(PositionSensor),
    Metres(PositionSensor),
}

impl Measurement {
    pub(super) fn from_values(values: &[f64; COUNT]) -> Self {
        let sensor = PositionSensor { gain: values[SENSOR_GAIN], offset: values[SENSOR_OFFSET] };
        match MeasurementKind::from_number(values[OBSERVER_MEASUREMENT]) {
            MeasurementKind::Volts => Self::Volts(sensor),
            MeasurementKind::Metres => Self::Metres(sensor),
        }
    }

    /// What the observer measures at a sensor voltage.
    #[inline]
    pub(super) fn of(&self, sensor_voltage: f64) -> f64 {
        match self {
            Self::Volts(_) => sensor_voltage,
            Self::Metres(sensor) => sensor.position(sensor_voltage),
        }
    }

    /// The observer's estimate in sensor volts.
    #[inline]
    pub(super) fn in_volts(&self, z: ExtendedState) -> ExtendedState {
        match self {
            Self::Volts(_) => z,
            Self::Metres(sensor) => ExtendedState {
                position: sensor.voltage(z.position),
                velocity: sensor.gain * z.velocity,
                extended: sensor.gain * z.extended,
            },
        }
    }

    /// The observer's estimate in metres.
    #[inline]
    pub(super) fn in_metres(&self, z: ExtendedState) -> ExtendedState {
        match self {
            Self::Metres(_) => z,
            Self::Volts(sensor) => ExtendedState {
                position: sensor.position(z.position),
                velocity: z.velocity / sensor.gain,
                extended: z.extended / sensor.gain,
            },
        }
    }

    /// The observer's input gain in sensor volts \[1/s2\].
    pub(super) fn input_gain_in_volts(&self, input_gain: f64) -> f64 {
        match self {
            Self::Volts(_) => input_gain,
            Self::Metres(sensor) => sensor.gain * input_gain,
        }
    }
}

/// z at the first tick, for what the observer measures then.
pub(super) fn initial_estimate(values: &[f64; COUNT], measurement: f64) -> ExtendedState {
    match Initial::from_number(values[OBSERVER_INITIAL]) {
        Initial::Zero => ExtendedState::default(),
        Initial::Steady => ExtendedState {
            position: measurement,
            velocity: 0.0,
            extended: -values[OBSERVER_INPUT_GAIN] * values[CONTROLLER_OPERATING_VOLTAGE],
        },
        Initial::Matched => ExtendedState { position: measurement, ..ExtendedState::default() },
    }
}

/// The law in use.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Law {
    Pid(PidSettings),
    DisturbanceRejection(DisturbanceRejection),
}

pub(super) fn law(values: &[f64; COUNT]) -> Law {
    match LawKind::from_number(values[CONTROLLER_KIND_CHOICE]) {
        LawKind::DisturbanceRejection => Law::DisturbanceRejection(DisturbanceRejection {
            bandwidth: values[CONTROLLER_BANDWIDTH],
            input_gain: values[CONTROLLER_INPUT_GAIN],
        }),
        LawKind::Pid => Law::Pid(PidSettings {
            proportional_gain: values[KP],
            integral_gain: values[KI],
            derivative_gain: values[KD],
            derivative: match DerivativeKind::from_number(values[CONTROLLER_DERIVATIVE]) {
                DerivativeKind::Error => Derivative::Error,
                DerivativeKind::Measurement => Derivative::Measurement,
            },
            operating_voltage: values[CONTROLLER_OPERATING_VOLTAGE],
            sample_time: values[SAMPLE_TIME],
            limits: limits(values),
        }),
    }
}

pub(super) fn limits(values: &[f64; COUNT]) -> (f64, f64) {
    (values[VOLTAGE_MIN], values[VOLTAGE_MAX])
}
