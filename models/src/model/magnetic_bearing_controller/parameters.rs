//! What the values of parameters mean to the observers and the laws.

use super::table::*;
use crate::controller::BearingLaw;
use crate::controller::bearing_feedback::{Gains, Law};
use crate::controller::flux_cascade::FluxCascade;
use crate::model::magnetic_bearing::map;
use crate::observer::BearingObserverSettings;
use crate::observer::kalman::KalmanSettings;
use crate::observer::newton::NewtonSettings;
use crate::observer::reduced_newton::ReducedNewtonSettings;
use crate::observer::windowed_newton::WindowedNewtonSettings;
use crate::plant::magnetic_bearing::{MagneticBearing, Map, State};

/// Costs at most \[s\], see [`crate::model::work`]: of a tick without iterations, of an iteration, of what each sample of a
/// longer window adds to it, and of a sample of the Kalman filter, which may go over the beginning again and again.
const COST_OF_TICK: f64 = 200e-9;
const COST_OF_ITERATION: f64 = 60e-9;
const COST_OF_WINDOW_SAMPLE: f64 = 60e-9;
const COST_OF_FILTERING: f64 = 1e-6;
/// Residuals that a line search may compute per iteration, each as costly as the iteration.
const SEARCHED_LENGTHS: f64 = 41.0;

/// What a tick costs at most \[s\].
pub(super) fn cost_of_tick(values: &[f64; COUNT]) -> f64 {
    let iterations = |newton: &NewtonSettings| {
        let line_search = if newton.line_search { 1.0 + SEARCHED_LENGTHS } else { 1.0 };
        f64::from(newton.max_iterations) * line_search
    };
    COST_OF_TICK
        + match observer_settings(values) {
            BearingObserverSettings::Kalman(_) => COST_OF_FILTERING,
            BearingObserverSettings::ReducedNewton(settings) => {
                COST_OF_ITERATION * f64::from(settings.max_iterations)
            }
            BearingObserverSettings::Newton(settings) => COST_OF_ITERATION * iterations(&settings),
            BearingObserverSettings::WindowedNewton(WindowedNewtonSettings { newton, window }) => {
                COST_OF_WINDOW_SAMPLE * window as f64 * iterations(&newton)
            }
        }
}

pub(super) fn observer_settings(values: &[f64; COUNT]) -> BearingObserverSettings {
    let (bearing, sample_time) = (bearing(values), values[SAMPLE_TIME]);
    let (max_iterations, step_size) = (values[MAX_ITERATIONS] as u32, values[STEP_SIZE]);
    let map = map(values[OBSERVER_MAP]);
    match ObserverKind::from_number(values[OBSERVER]) {
        ObserverKind::Kalman => BearingObserverSettings::Kalman(KalmanSettings {
            bearing,
            map: Map::Exact,
            sample_time,
            position_noise: values[POSITION_NOISE],
            flux_noise: values[FLUX_NOISE],
        }),
        kind @ (ObserverKind::ReducedNewton | ObserverKind::ReducedNewtonCompensated) => {
            BearingObserverSettings::ReducedNewton(ReducedNewtonSettings {
                bearing,
                map,
                sample_time,
                filter_time: values[FILTER_TIME],
                lag_compensated: kind == ObserverKind::ReducedNewtonCompensated,
                max_iterations,
                step_size,
            })
        }
        ObserverKind::Newton => {
            let line_search = values[LINE_SEARCH] != 0.0;
            let newton = NewtonSettings { bearing, map, sample_time, max_iterations, step_size, line_search };
            if values[WINDOW] > SQUARE_WINDOW {
                let window = values[WINDOW] as usize;
                BearingObserverSettings::WindowedNewton(WindowedNewtonSettings { newton, window })
            } else {
                BearingObserverSettings::Newton(newton)
            }
        }
    }
}

pub(super) fn initial_estimate(values: &[f64; COUNT]) -> State {
    State {
        position: values[OBSERVER_INITIAL_POSITION],
        velocity: values[OBSERVER_INITIAL_VELOCITY],
        flux: values[OBSERVER_INITIAL_FLUX],
    }
}

pub(super) fn law(values: &[f64; COUNT]) -> BearingLaw {
    let printed = match LawKind::from_number(values[CONTROLLER_LAW]) {
        LawKind::FluxCascade => return BearingLaw::FluxCascade(cascade(values), bearing(values)),
        LawKind::A => Law::A,
        LawKind::B => Law::B,
        LawKind::C => Law::C,
    };
    BearingLaw::Printed(printed, Gains { position: values[K1], velocity: values[K2] })
}

fn cascade(values: &[f64; COUNT]) -> FluxCascade {
    FluxCascade {
        position_gain: values[CASCADE_POSITION_GAIN],
        velocity_gain: values[CASCADE_VELOCITY_GAIN],
        flux_gain: values[CASCADE_FLUX_GAIN],
        regularisation: values[CASCADE_REGULARISATION],
    }
}

fn bearing(values: &[f64; COUNT]) -> MagneticBearing {
    MagneticBearing::with_bias(values[BIAS_FLUX], values[SATURATION_FLUX])
}
