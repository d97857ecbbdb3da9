//! Any of the maglev rig's observers, chosen when a loop is set up: from a sensor voltage and the voltage that acted to
//! position, velocity and extended state in the unit that is wanted.
//!
//! The extended state is what the acceleration is beyond b u, whatever the observer. A model-based one knows the
//! acceleration under the voltage that acted, a(x, u) + d, and gives a(x, u) + d - b u.

use super::extended_state::ExtendedState;
use super::gauss_newton::{GaussNewtonObserver, GaussNewtonSettings};
use super::rig_kalman::{RigKalmanObserver, RigKalmanSettings};
use super::rig_measurement::Measurement;
use super::rig_model::{DisturbedRig, RigEstimate, is_plausible};
use super::sampled_extended_state::{
    ExtendedStateEstimate, ExtendedStateObserver, ExtendedStateSettings, finite,
};
use serde::{Deserialize, Serialize};

/// What is computed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigEstimatorSettings {
    /// In the unit of the measurement.
    ExtendedState(ExtendedStateSettings),
    Kalman(RigKalmanSettings),
    WindowedNewton(DisturbedRig, GaussNewtonSettings),
}

/// Which observer, what it knows of its plant, and in which unit it speaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigObserverSettings {
    pub measurement: Measurement,
    /// b \[y/(s2 V)\], y the unit of the measurement.
    pub input_gain: f64,
    pub estimator: RigEstimatorSettings,
}

/// Where an observer starts at its first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigStart {
    /// At this position \[y\]; all else zero.
    Position(f64),
    /// At rest at this position \[y\], held by a voltage \[V\].
    Held(f64, f64),
}

/// An observer with its settings; plain memory, even if a window takes a kilobyte.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigObserver {
    measurement: Measurement,
    input_gain: f64,
    estimator: Estimator,
}

#[expect(clippy::large_enum_variant, reason = "observers are plain memory: nothing is allocated")]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Estimator {
    ExtendedState(ExtendedStateObserver),
    Kalman(RigKalmanSettings, RigKalmanObserver),
    WindowedNewton(DisturbedRig, GaussNewtonSettings, GaussNewtonObserver<3>),
}

impl RigStart {
    /// As an extended state observer with this input gain starts.
    pub fn extended_state(self, input_gain: f64) -> ExtendedState {
        let (position, extended) = match self {
            Self::Position(position) => (position, 0.0),
            Self::Held(position, voltage) => (position, -input_gain * voltage),
        };
        ExtendedState { position, velocity: 0.0, extended }
    }

    fn state(self, measurement: &Measurement, model: &DisturbedRig) -> [f64; 3] {
        match self {
            Self::Position(position) => [measurement.position(position), 0.0, 0.0],
            Self::Held(position, voltage) => model.at_rest(measurement.position(position), voltage),
        }
    }
}

impl RigObserver {
    /// An observer before its first sample.
    pub fn new(settings: RigObserverSettings, start: RigStart) -> Self {
        let RigObserverSettings { measurement, input_gain, estimator } = settings;
        let estimator = match estimator {
            RigEstimatorSettings::ExtendedState(settings) => {
                let initial = start.extended_state(input_gain);
                Estimator::ExtendedState(ExtendedStateObserver::new(settings, initial))
            }
            RigEstimatorSettings::Kalman(settings) => {
                let initial = start.state(&measurement, &settings.model);
                Estimator::Kalman(settings, RigKalmanObserver::new(&settings, initial))
            }
            RigEstimatorSettings::WindowedNewton(model, settings) => {
                let [position, velocity, disturbance] = start.state(&measurement, &model);
                let disturbance = if settings.estimated_states == 3 { disturbance } else { 0.0 };
                let initial = [position, velocity, disturbance];
                Estimator::WindowedNewton(model, settings, GaussNewtonObserver::new(initial))
            }
        };
        Self { measurement, input_gain, estimator }
    }

    /// What it was set up with.
    pub fn settings(&self) -> RigObserverSettings {
        let estimator = match &self.estimator {
            Estimator::ExtendedState(observer) => RigEstimatorSettings::ExtendedState(observer.settings()),
            Estimator::Kalman(settings, _) => RigEstimatorSettings::Kalman(*settings),
            Estimator::WindowedNewton(model, settings, _) => {
                RigEstimatorSettings::WindowedNewton(*model, *settings)
            }
        };
        RigObserverSettings { measurement: self.measurement, input_gain: self.input_gain, estimator }
    }

    /// How the sensor is read.
    #[inline]
    pub fn measurement(&self) -> &Measurement {
        &self.measurement
    }

    /// Goes on with other settings of the same observer; those of another estimator change nothing in it.
    pub fn apply_settings(&mut self, settings: RigObserverSettings) {
        self.measurement = settings.measurement;
        self.input_gain = settings.input_gain;
        match (&mut self.estimator, settings.estimator) {
            (Estimator::ExtendedState(observer), RigEstimatorSettings::ExtendedState(new)) => {
                observer.apply_settings(new)
            }
            (Estimator::Kalman(own, _), RigEstimatorSettings::Kalman(new)) => *own = new,
            (Estimator::WindowedNewton(model, own, _), RigEstimatorSettings::WindowedNewton(other, new)) => {
                (*model, *own) = (other, new);
            }
            _ => {}
        }
    }

    /// Takes the sample `sensor_voltage` \[V\] and the voltage \[V\] that acted since the sample before.
    #[inline]
    pub fn update(&mut self, sensor_voltage: f64, voltage: f64) -> ExtendedStateEstimate {
        match &mut self.estimator {
            Estimator::ExtendedState(observer) => {
                observer.update(self.measurement.of(sensor_voltage), voltage)
            }
            Estimator::Kalman(settings, observer) => {
                let position = self.measurement.sensor().position(sensor_voltage);
                let estimate = observer.update(settings, position, voltage);
                let model = settings.model;
                self.published(estimate, &model, voltage)
            }
            Estimator::WindowedNewton(model, settings, observer) => {
                let position = self.measurement.sensor().position(sensor_voltage);
                let estimate = updated(observer, model, settings, position, voltage);
                let model = *model;
                self.published(estimate, &model, voltage)
            }
        }
    }

    /// An estimate of a model-based observer in the unit of the measurement.
    #[inline]
    fn published(&self, estimate: RigEstimate, model: &DisturbedRig, voltage: f64) -> ExtendedStateEstimate {
        let RigEstimate { state, innovation, restarted } = estimate;
        let scale = self.measurement.scale();
        let state = ExtendedState {
            position: self.measurement.of_position(state[0]),
            velocity: scale * state[1],
            extended: scale * model.acceleration(&state, voltage) - self.input_gain * voltage,
        };
        ExtendedStateEstimate { state, innovation: finite(scale * innovation), restarted }
    }
}

/// One sample of the windowed observer, which starts anew where its estimate is none of a ball.
#[inline(never)]
fn updated(
    observer: &mut GaussNewtonObserver<3>,
    model: &DisturbedRig,
    settings: &GaussNewtonSettings,
    position: f64,
    voltage: f64,
) -> RigEstimate {
    let innovation = observer.update(model, settings, position, voltage);
    let restarted = !is_plausible(observer.state());
    if restarted {
        observer.reset([position, 0.0, 0.0], position);
    }
    RigEstimate { state: *observer.state(), innovation, restarted }
}
