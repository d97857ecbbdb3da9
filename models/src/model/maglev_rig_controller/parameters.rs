//! What the values of parameters mean to the observers and the laws.

use super::table::*;
use crate::controller::digital_pid::{Derivative, PidSettings};
use crate::controller::disturbance_rejection::DisturbanceRejection;
use crate::model::ModelError;
use crate::observer::extended_state::{
    ExtendedState, LinearInjection, NonlinearInjection, gains_from_bandwidth,
};
use crate::observer::gauss_newton::GaussNewtonSettings;
use crate::observer::rig_kalman::RigKalmanSettings;
use crate::observer::rig_measurement::Measurement;
use crate::observer::rig_model::DisturbedRig;
use crate::observer::rig_observer::{RigEstimatorSettings, RigObserverSettings, RigStart};
use crate::observer::sampled_extended_state::{Discretisation, ExtendedStateSettings, Form, InjectionChoice};
use crate::plant::maglev_rig::{MaglevRig, PositionSensor};
use serde::{Deserialize, Serialize};

/// Costs at most \[s\], see [`crate::model::work`]: of a tick, of a closed form for gains as large as they come, of a
/// Runge-Kutta step of an extended state observer, of a sample of the Kalman filter, and of one that the windowed
/// observer goes over.
const COST_OF_TICK: f64 = 200e-9;
const COST_OF_CLOSED_FORM: f64 = 3e-6;
const COST_OF_SUBSTEP: f64 = 300e-9;
const COST_OF_FILTERING: f64 = 300e-9;
const COST_OF_WINDOW_SAMPLE: f64 = 150e-9;

/// What the observer is told.
pub(super) fn observer_settings(values: &[f64; COUNT]) -> RigObserverSettings {
    let sensor = PositionSensor { gain: values[SENSOR_GAIN], offset: values[SENSOR_OFFSET] };
    let estimates_disturbance = values[ESTIMATE_DISTURBANCE] != 0.0;
    let estimator = match ObserverKind::from_number(values[OBSERVER]) {
        kind @ (ObserverKind::Linear | ObserverKind::Nonlinear) => {
            RigEstimatorSettings::ExtendedState(extended_state_settings(values, kind))
        }
        ObserverKind::Kalman => RigEstimatorSettings::Kalman(RigKalmanSettings {
            model: model(values),
            position_noise: values[OBSERVER_SENSOR_NOISE] / sensor.gain,
            disturbance_noise: estimates_disturbance.then_some(values[DISTURBANCE_NOISE]),
        }),
        ObserverKind::WindowedNewton => RigEstimatorSettings::WindowedNewton(
            model(values),
            GaussNewtonSettings {
                window: values[WINDOW] as usize,
                max_iterations: values[MAX_ITERATIONS] as u32,
                estimated_states: if estimates_disturbance { 3 } else { 2 },
            },
        ),
    };
    let measurement = match MeasurementKind::from_number(values[OBSERVER_MEASUREMENT]) {
        MeasurementKind::Volts => Measurement::Volts(sensor),
        MeasurementKind::Metres => Measurement::Metres(sensor),
    };
    RigObserverSettings { measurement, input_gain: values[OBSERVER_INPUT_GAIN], estimator }
}

/// The rig as the model-based observers know it.
fn model(values: &[f64; COUNT]) -> DisturbedRig {
    let rig = MaglevRig {
        mass: values[MASS],
        gravity: values[GRAVITY],
        electromagnetic_constant: values[FORCE_CONSTANT],
        driver_gain: values[DRIVER_GAIN],
    };
    DisturbedRig { rig, sample_time: values[SAMPLE_TIME] }
}

fn extended_state_settings(values: &[f64; COUNT], kind: ObserverKind) -> ExtendedStateSettings {
    let gains = match Tuning::from_number(values[OBSERVER_TUNING]) {
        Tuning::Gains => [values[OBSERVER_GAIN_1], values[OBSERVER_GAIN_2], values[OBSERVER_GAIN_3]],
        Tuning::Bandwidth => gains_from_bandwidth(values[OBSERVER_BANDWIDTH]),
    };
    let is_nonlinear = kind == ObserverKind::Nonlinear;
    let injection = match is_nonlinear {
        false => InjectionChoice::Linear(LinearInjection { gains }),
        true => InjectionChoice::Nonlinear(NonlinearInjection::new(
            gains,
            [values[EXPONENT_1], values[EXPONENT_2], values[EXPONENT_3]],
            [values[LINEAR_ZONE_1], values[LINEAR_ZONE_2], values[LINEAR_ZONE_3]],
        )),
    };
    let runge_kutta = Discretisation::RungeKutta(values[OBSERVER_SUBSTEPS] as u32);
    let discretisation =
        match (DiscretisationKind::from_number(values[OBSERVER_DISCRETISATION]), is_nonlinear) {
            (DiscretisationKind::Exact, _) | (DiscretisationKind::Automatic, false) => Discretisation::Exact,
            (DiscretisationKind::RungeKutta, _) | (DiscretisationKind::Automatic, true) => runge_kutta,
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
pub(super) fn check_input_gain(values: &[f64; COUNT]) -> Result<(), ModelError> {
    let divides = LawKind::DisturbanceRejection.is(values[CONTROLLER_KIND_CHOICE]);
    if !divides || values[CONTROLLER_INPUT_GAIN] != 0.0 {
        return Ok(());
    }
    let variable = &VARIABLES[CONTROLLER_INPUT_GAIN];
    let (name, unit) = (variable.name, variable.unit());
    let expected = "another number than 0 with controller.kind = disturbance_rejection";
    Err(ModelError::Unusable { name, value: 0.0, unit, expected })
}

/// What a tick costs at most \[s\], see [`crate::model::work`].
pub(super) fn cost_of_tick(values: &[f64; COUNT]) -> f64 {
    let observer = match observer_settings(values).estimator {
        RigEstimatorSettings::Kalman(_) => COST_OF_FILTERING,
        // The window is gone over once per iteration, and once to the newest sample.
        RigEstimatorSettings::WindowedNewton(_, GaussNewtonSettings { window, max_iterations, .. }) => {
            COST_OF_WINDOW_SAMPLE * window as f64 * (1.0 + f64::from(max_iterations))
        }
        RigEstimatorSettings::ExtendedState(ExtendedStateSettings { injection, discretisation, .. }) => {
            match (discretisation, injection) {
                (Discretisation::RungeKutta(substeps), _) => COST_OF_SUBSTEP * f64::from(substeps),
                // Frozen gains make another closed form of each sample.
                (Discretisation::Exact, InjectionChoice::Nonlinear(_)) => COST_OF_CLOSED_FORM,
                _ => 0.0,
            }
        }
    };
    COST_OF_TICK + observer
}

/// Where the observer starts, for what it measures at the first tick.
pub(super) fn start(values: &[f64; COUNT], measured: f64) -> RigStart {
    match Initial::from_number(values[OBSERVER_INITIAL]) {
        Initial::Zero => RigStart::Position(0.0),
        Initial::Steady => RigStart::Held(measured, values[CONTROLLER_OPERATING_VOLTAGE]),
        Initial::Matched => RigStart::Position(measured),
    }
}

/// Estimate before the first tick.
pub(super) fn initial_estimate(values: &[f64; COUNT], measured: f64) -> ExtendedState {
    start(values, measured).extended_state(values[OBSERVER_INPUT_GAIN])
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
