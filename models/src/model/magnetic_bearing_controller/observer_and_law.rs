//! Observer and law of the magnetic bearing.

use super::parameters::{cost_of_tick, initial_estimate, law, observer_settings};
use super::table::*;
use crate::controller::{BearingLaw, saturate};
use crate::model::controller_choices::Feedback;
use crate::model::sampled_controller::{ObserverAndLaw, Sample, SampledController};
use crate::model::{Description, LogSink, Topic};
use crate::observer::{BearingObserver, Estimate};
use crate::plant::magnetic_bearing::State;
use serde::{Deserialize, Serialize};

/// The controller as a model.
pub type MagneticBearingController = SampledController<BearingObserverAndLaw, COUNT>;

/// What observer and law remember from tick to tick.
#[derive(Clone, Serialize, Deserialize)]
pub struct BearingObserverAndLaw {
    law: BearingLaw,
    observer: BearingObserver,
}

impl BearingObserverAndLaw {
    /// Sets the outputs that describe the observer's state.
    #[inline]
    fn publish(&self, estimate: State, values: &mut [f64; COUNT]) {
        values[ESTIMATE_POSITION] = estimate.position;
        values[ESTIMATE_VELOCITY] = estimate.velocity;
        values[ESTIMATE_FLUX] = estimate.flux;
        if let Some(standard_deviation) = self.observer.standard_deviation() {
            values[POSITION_DEVIATION] = standard_deviation.position;
            values[VELOCITY_DEVIATION] = standard_deviation.velocity;
            values[FLUX_DEVIATION] = standard_deviation.flux;
        }
    }
}

impl ObserverAndLaw<COUNT> for BearingObserverAndLaw {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    fn new(values: &[f64; COUNT]) -> Self {
        let observer = BearingObserver::new(observer_settings(values), initial_estimate(values));
        Self { law: law(values), observer }
    }

    fn apply_tunable_parameters(&mut self, values: &[f64; COUNT]) {
        self.observer.apply_settings(observer_settings(values));
        self.law = law(values);
    }

    fn initialise(&mut self, values: &mut [f64; COUNT]) {
        *self = Self::new(values);
        for output in [
            VOLTAGE_OUTPUT,
            OBSERVER_RESIDUAL,
            OBSERVER_ITERATIONS,
            OBSERVER_CONVERGED,
            POSITION_DEVIATION,
            VELOCITY_DEVIATION,
            FLUX_DEVIATION,
        ] {
            values[output] = 0.0;
        }
        self.publish(initial_estimate(values), values);
    }

    /// The first tick puts out u(0).
    #[inline]
    fn tick(&mut self, values: &mut [f64; COUNT], sample: Sample, sink: &mut dyn LogSink) {
        let estimate = self.observer.update(values[POSITION], sample.acting_voltage);
        let fed_back = if Feedback::State.is(values[CONTROLLER_FEEDBACK]) {
            State { position: values[POSITION], velocity: values[STATE_VELOCITY], flux: values[STATE_FLUX] }
        } else {
            // The laws use the measured position, not its estimate.
            State { position: values[POSITION], ..estimate.state }
        };
        let wanted = if sample.is_first { values[INITIAL_VOLTAGE] } else { self.law.voltage(fed_back) };
        values[VOLTAGE_OUTPUT] = saturate(wanted, values[VOLTAGE_LIMIT], values[VOLTAGE_OUTPUT]);
        values[OBSERVER_RESIDUAL] = estimate.residual;
        values[OBSERVER_ITERATIONS] = f64::from(estimate.iterations);
        let converged = f64::from(u8::from(estimate.converged));
        if converged != values[OBSERVER_CONVERGED] && sink.enabled(Topic::Observer) {
            log_convergence(sample.time, &estimate, sink);
        }
        values[OBSERVER_CONVERGED] = converged;
        self.publish(estimate.state, values);
    }

    fn is_consistent(&self, values: &[f64; COUNT]) -> bool {
        self.observer.settings() == observer_settings(values) && self.law == law(values)
    }

    fn cost_of_tick(values: &[f64; COUNT]) -> f64 {
        cost_of_tick(values)
    }
}

#[cold]
fn log_convergence(time: f64, estimate: &Estimate, sink: &mut dyn LogSink) {
    let verb = if estimate.converged { "converged" } else { "did not converge" };
    sink.log(
        Topic::Observer,
        format_args!(
            "t = {time} s: the observer {verb} after {} iterations, residual {:e} m",
            estimate.iterations, estimate.residual
        ),
    );
}
