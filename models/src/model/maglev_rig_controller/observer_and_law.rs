//! Observer and law of the maglev rig.

use super::parameters::{
    Law, check_input_gain, cost_of_tick, initial_estimate, law, limits, observer_settings, start,
};
use super::table::*;
use crate::controller::digital_pid::DigitalPid;
use crate::controller::saturate_between;
use crate::model::sampled_controller::{ObserverAndLaw, Sample, SampledController};
use crate::model::{Description, LogSink, ModelError, Topic};
use crate::observer::extended_state::ExtendedState;
use crate::observer::rig_observer::{RigObserver, RigStart};
use crate::signal::reference_filter::{Reference, ReferenceFilter};
use serde::{Deserialize, Serialize};

/// The controller as a model.
pub type MaglevRigController = SampledController<RigObserverAndLaw, COUNT>;

/// What observer, reference filter and law remember from tick to tick.
#[derive(Clone, Serialize, Deserialize)]
pub struct RigObserverAndLaw {
    observer: RigObserver,
    reference_filter: ReferenceFilter,
    reference: Reference,
    law: Law,
    pid: DigitalPid,
}

impl RigObserverAndLaw {
    /// What the first tick adds: observer and reference start from the inputs.
    #[cold]
    fn begin(&mut self, values: &[f64; COUNT], sink: &mut dyn LogSink) {
        let settings = observer_settings(values);
        let measured = settings.measurement.of(values[SENSOR_VOLTAGE]);
        self.observer = RigObserver::new(settings, start(values, measured));
        self.reference = Reference::at_rest(values[REFERENCE]);
        if let Law::DisturbanceRejection(law) = self.law {
            let assumed = settings.measurement.input_gain_in_volts(values[OBSERVER_INPUT_GAIN]);
            if (assumed / law.input_gain - 1.0).abs() > 0.01 && sink.enabled(Topic::Observer) {
                sink.log(
                    Topic::Observer,
                    format_args!(
                        "observer.input_gain stands for {assumed} 1/s2 in sensor volts, controller.input_gain for \
                         {} 1/s2: disturbance_rejection expects them to be the same",
                        law.input_gain
                    ),
                );
            }
        }
    }

    /// Sets the outputs that describe the observer's state.
    #[inline]
    fn publish(&self, estimate: ExtendedState, values: &mut [f64; COUNT]) {
        let metres = self.observer.measurement().in_metres(estimate);
        values[ESTIMATE_POSITION] = estimate.position;
        values[ESTIMATE_VELOCITY] = estimate.velocity;
        values[ESTIMATE_EXTENDED] = estimate.extended;
        values[SI_POSITION] = metres.position;
        values[SI_VELOCITY] = metres.velocity;
        values[SI_EXTENDED] = metres.extended;
    }
}

impl ObserverAndLaw<COUNT> for RigObserverAndLaw {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    fn new(values: &[f64; COUNT]) -> Self {
        Self {
            observer: RigObserver::new(observer_settings(values), RigStart::Position(0.0)),
            reference_filter: ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME]),
            reference: Reference::default(),
            law: law(values),
            pid: DigitalPid::default(),
        }
    }

    fn check_parameters(values: &[f64; COUNT]) -> Result<(), ModelError> {
        check_input_gain(values)
    }

    fn apply_tunable_parameters(&mut self, values: &[f64; COUNT]) {
        self.observer.apply_settings(observer_settings(values));
        self.reference_filter = ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME]);
        let law = law(values);
        if core::mem::discriminant(&law) != core::mem::discriminant(&self.law) {
            // What the PID remembers of the time before another law took over means nothing now.
            self.pid = DigitalPid::default();
        }
        self.law = law;
    }

    fn initialise(&mut self, values: &mut [f64; COUNT]) {
        *self = Self::new(values);
        self.reference = Reference::at_rest(values[REFERENCE]);
        values[OBSERVER_RESIDUAL] = 0.0;
        values[OBSERVER_RESTARTS] = 0.0;
        values[FILTERED_REFERENCE] = values[REFERENCE];
        values[VOLTAGE_OUTPUT] = saturate_between(values[CONTROLLER_OPERATING_VOLTAGE], limits(values), 0.0);
        let initial = initial_estimate(values, self.observer.measurement().of(values[SENSOR_VOLTAGE]));
        self.publish(initial, values);
    }

    #[inline]
    fn tick(&mut self, values: &mut [f64; COUNT], sample: Sample, sink: &mut dyn LogSink) {
        if sample.is_first {
            self.begin(values, sink);
        }
        let (sensor_voltage, command) = (values[SENSOR_VOLTAGE], values[REFERENCE]);
        let estimate = self.observer.update(sensor_voltage, sample.acting_voltage);
        self.reference = self.reference_filter.advance(self.reference, command);
        values[VOLTAGE_OUTPUT] = match &self.law {
            Law::Pid(settings) => self.pid.update(settings, sensor_voltage, self.reference.position),
            Law::DisturbanceRejection(law) => {
                let wanted =
                    law.voltage(self.reference, self.observer.measurement().in_volts(estimate.state));
                saturate_between(wanted, limits(values), values[VOLTAGE_OUTPUT])
            }
        };
        values[OBSERVER_RESIDUAL] = estimate.innovation;
        values[FILTERED_REFERENCE] = self.reference.position;
        if estimate.restarted {
            values[OBSERVER_RESTARTS] = (values[OBSERVER_RESTARTS] + 1.0).min(f64::from(i32::MAX));
            log_restart(sample.time, sink);
        }
        self.publish(estimate.state, values);
    }

    fn is_consistent(&self, values: &[f64; COUNT]) -> bool {
        self.observer.settings() == observer_settings(values)
            && self.reference_filter == ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME])
            && self.law == law(values)
    }

    fn cost_of_tick(values: &[f64; COUNT]) -> f64 {
        cost_of_tick(values)
    }
}

#[cold]
fn log_restart(time: f64, sink: &mut dyn LogSink) {
    if sink.enabled(Topic::Observer) {
        sink.log(
            Topic::Observer,
            format_args!("t = {time} s: the observer diverged and is reset to the measurement"),
        );
    }
}
