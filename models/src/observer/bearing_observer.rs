//! Any of the magnetic bearing's observers, chosen when a loop is set up.

use super::Estimate;
use super::kalman::{KalmanObserver, KalmanSettings};
use super::newton::{NewtonObserver, NewtonSettings};
use super::reduced_newton::{ReducedNewtonObserver, ReducedNewtonSettings};
use super::windowed_newton::{WindowedNewtonObserver, WindowedNewtonSettings};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};

/// Which observer, and what it knows of its plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BearingObserverSettings {
    Newton(NewtonSettings),
    WindowedNewton(WindowedNewtonSettings),
    ReducedNewton(ReducedNewtonSettings),
    Kalman(KalmanSettings),
}

/// An observer with its settings.
///
/// A windowed or a Kalman observer takes a kilobyte, which is not worth a pointer: observers are plain memory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum BearingObserver {
    Newton(NewtonSettings, NewtonObserver),
    WindowedNewton(WindowedNewtonSettings, WindowedNewtonObserver),
    ReducedNewton(ReducedNewtonSettings, ReducedNewtonObserver),
    Kalman(KalmanSettings, KalmanObserver),
}

impl BearingObserver {
    /// An observer that starts from `initial`.
    pub fn new(settings: BearingObserverSettings, initial: State) -> Self {
        match settings {
            BearingObserverSettings::Newton(settings) => Self::Newton(settings, NewtonObserver::new(initial)),
            BearingObserverSettings::WindowedNewton(settings) => {
                Self::WindowedNewton(settings, WindowedNewtonObserver::new(initial))
            }
            BearingObserverSettings::ReducedNewton(settings) => {
                Self::ReducedNewton(settings, ReducedNewtonObserver::new(initial))
            }
            BearingObserverSettings::Kalman(settings) => Self::Kalman(settings, KalmanObserver::new(initial)),
        }
    }

    /// What it was set up with.
    pub fn settings(&self) -> BearingObserverSettings {
        match self {
            Self::Newton(settings, _) => BearingObserverSettings::Newton(*settings),
            Self::WindowedNewton(settings, _) => BearingObserverSettings::WindowedNewton(*settings),
            Self::ReducedNewton(settings, _) => BearingObserverSettings::ReducedNewton(*settings),
            Self::Kalman(settings, _) => BearingObserverSettings::Kalman(*settings),
        }
    }

    /// Goes on with other settings of the same observer; settings of another one change nothing.
    pub fn apply_settings(&mut self, settings: BearingObserverSettings) {
        match (self, settings) {
            (Self::Newton(own, _), BearingObserverSettings::Newton(new)) => *own = new,
            (Self::WindowedNewton(own, _), BearingObserverSettings::WindowedNewton(new)) => *own = new,
            (Self::ReducedNewton(own, _), BearingObserverSettings::ReducedNewton(new)) => *own = new,
            (Self::Kalman(own, _), BearingObserverSettings::Kalman(new)) => *own = new,
            _ => {}
        }
    }

    /// Takes the sample y\[k\] = `position` \[m\] and the voltage \[V\] that acted since the sample before.
    #[inline]
    pub fn update(&mut self, position: f64, applied_voltage: f64) -> Estimate {
        match self {
            Self::Newton(settings, observer) => observer.update(settings, position, applied_voltage),
            Self::WindowedNewton(settings, observer) => observer.update(settings, position, applied_voltage),
            Self::ReducedNewton(settings, observer) => observer.update(settings, position, applied_voltage),
            Self::Kalman(settings, observer) => observer.update(settings, position, applied_voltage),
        }
    }

    /// Standard deviations of the last estimate, of an observer that knows them.
    #[inline]
    pub fn standard_deviation(&self) -> Option<State> {
        match self {
            Self::Kalman(_, observer) => Some(observer.standard_deviation()),
            Self::Newton(..) | Self::WindowedNewton(..) | Self::ReducedNewton(..) => None,
        }
    }
}
