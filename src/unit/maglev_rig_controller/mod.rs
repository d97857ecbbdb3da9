//! Exported unit `MaglevRigController`: extended state observers and control laws as a sampled-data system.

mod parameters;
mod table;

use parameters::{
    Law, Measurement, check_input_gain, cost_of_tick, initial_estimate, law, limits, observer_settings,
};
pub use table::DESCRIPTION;
use table::*;

use super::sample_clock::SampleClock;
use super::sampled::SampledUnit;
use super::start_delay::StartDelay;
use super::{Description, Journal, Topic, Unit, UnitError, start_values};
use crate::controller::digital_pid::DigitalPid;
use crate::controller::saturate_between;
use crate::observer::extended_state::ExtendedState;
use crate::observer::sampled_extended_state::ExtendedStateObserver;
use crate::signal::reference_filter::{Reference, ReferenceFilter};
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// The controller as a unit.
#[derive(Clone, Serialize, Deserialize)]
pub struct MaglevRigController {
    #[serde(with = "BigArray")]
    values: [f64; COUNT],
    clock: SampleClock,
    start_delay: StartDelay,
    measurement: Measurement,
    observer: ExtendedStateObserver,
    reference_filter: ReferenceFilter,
    reference: Reference,
    law: Law,
    pid: DigitalPid,
    hears_applied_voltage: bool,
    /// Whether the first tick, at which the observer starts, is still to come.
    awaits_first_tick: bool,
}

impl MaglevRigController {
    /// The controller with the start values of its table.
    pub fn new() -> Self {
        let values = start_values(&VARIABLES);
        Self {
            clock: SampleClock::new(values[SAMPLE_TIME], 0.0),
            start_delay: StartDelay::new(0.0, values[START_DELAY], values[SAMPLE_TIME]),
            measurement: Measurement::from_values(&values),
            observer: ExtendedStateObserver::new(observer_settings(&values), ExtendedState::default()),
            reference_filter: ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME]),
            reference: Reference::default(),
            law: law(&values),
            pid: DigitalPid::default(),
            hears_applied_voltage: values[OBSERVER_VOLTAGE_SOURCE] == APPLIED,
            awaits_first_tick: true,
            values,
        }
    }

    /// Reads the inputs, runs the observer, then the law, and sets the outputs.
    #[inline]
    fn tick_at(&mut self, time: f64, journal: &mut dyn Journal) {
        if self.start_delay.covers(time) {
            return;
        }
        self.values[TICK_TIME] = time;
        if self.awaits_first_tick {
            self.begin(journal);
        }
        let values = &mut self.values;
        let (sensor_voltage, command) = (values[SENSOR_VOLTAGE], values[REFERENCE]);
        let acted = if self.hears_applied_voltage { values[VOLTAGE_APPLIED] } else { values[VOLTAGE_OUTPUT] };
        let estimate = self.observer.update(self.measurement.of(sensor_voltage), acted);
        self.reference = self.reference_filter.advance(self.reference, command);
        values[VOLTAGE_OUTPUT] = match &self.law {
            Law::Pid(settings) => self.pid.update(settings, sensor_voltage, self.reference.position),
            Law::DisturbanceRejection(law) => {
                let wanted = law.voltage(self.reference, self.measurement.in_volts(estimate.state));
                saturate_between(wanted, limits(values), values[VOLTAGE_OUTPUT])
            }
        };
        values[OBSERVER_RESIDUAL] = estimate.innovation;
        values[FILTERED_REFERENCE] = self.reference.position;
        if estimate.restarted {
            values[OBSERVER_RESTARTS] = (values[OBSERVER_RESTARTS] + 1.0).min(f64::from(i32::MAX));
            note_restart(values[TICK_TIME], journal);
        }
        self.publish(estimate.state);
    }

    /// What the first tick adds: observer and reference start from the inputs.
    #[cold]
    fn begin(&mut self, journal: &mut dyn Journal) {
        let values = &self.values;
        let measured = self.measurement.of(values[SENSOR_VOLTAGE]);
        self.observer =
            ExtendedStateObserver::new(observer_settings(values), initial_estimate(values, measured));
        self.reference = Reference::at_rest(values[REFERENCE]);
        self.awaits_first_tick = false;
        if let Law::DisturbanceRejection(law) = self.law {
            let assumed = self.measurement.input_gain_in_volts(values[OBSERVER_INPUT_GAIN]);
            if (assumed / law.input_gain - 1.0).abs() > 0.01 && journal.wants(Topic::Observer) {
                journal.note(
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
    fn publish(&mut self, estimate: ExtendedState) {
        let values = &mut self.values;
        let metres = self.measurement.in_metres(estimate);
        values[ESTIMATE_POSITION] = estimate.position;
        values[ESTIMATE_VELOCITY] = estimate.velocity;
        values[ESTIMATE_EXTENDED] = estimate.extended;
        values[SI_POSITION] = metres.position;
        values[SI_VELOCITY] = metres.velocity;
        values[SI_EXTENDED] = metres.extended;
    }
}

#[cold]
fn note_restart(time: f64, journal: &mut dyn Journal) {
    if journal.wants(Topic::Observer) {
        journal.note(
            Topic::Observer,
            format_args!("t = {time} s: the observer diverged and starts anew from the measurement"),
        );
    }
}

impl Default for MaglevRigController {
    fn default() -> Self {
        Self::new()
    }
}

impl Unit for MaglevRigController {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn adopt_parameters(&mut self) {
        let values = &self.values;
        self.observer.adopt(observer_settings(values));
        self.measurement = Measurement::from_values(values);
        self.reference_filter = ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME]);
        let law = law(values);
        if core::mem::discriminant(&law) != core::mem::discriminant(&self.law) {
            // What the PID remembers of the time before another law took over means nothing now.
            self.pid = DigitalPid::default();
        }
        self.law = law;
        self.hears_applied_voltage = values[OBSERVER_VOLTAGE_SOURCE] == APPLIED;
    }

    fn check_parameters(&self) -> Result<(), UnitError> {
        check_input_gain(&self.values)
    }

    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError> {
        self.adopt_parameters();
        let values = &mut self.values;
        self.clock = SampleClock::starting(values[SAMPLE_TIME], start_time)?;
        self.start_delay = StartDelay::new(start_time, values[START_DELAY], values[SAMPLE_TIME]);
        self.pid = DigitalPid::default();
        self.reference = Reference::at_rest(values[REFERENCE]);
        self.awaits_first_tick = true;
        values[TIME] = start_time;
        values[TICK_TIME] = start_time;
        values[OBSERVER_RESIDUAL] = 0.0;
        values[OBSERVER_RESTARTS] = 0.0;
        values[FILTERED_REFERENCE] = values[REFERENCE];
        values[VOLTAGE_OUTPUT] = saturate_between(values[CONTROLLER_OPERATING_VOLTAGE], limits(values), 0.0);
        let initial = initial_estimate(values, self.measurement.of(values[SENSOR_VOLTAGE]));
        self.publish(initial);
        Ok(())
    }

    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError> {
        self.require_acceptable_step(duration)?;
        for k in self.clock.advance(duration) {
            self.tick_at(self.clock.time_of(k), journal);
        }
        Ok(())
    }

    fn sampled(&mut self) -> Option<&mut dyn SampledUnit> {
        Some(self)
    }

    fn is_consistent(&self) -> bool {
        let values = &self.values;
        self.clock.may_stand_where_it_does(values[SAMPLE_TIME])
            && self.observer.settings() == observer_settings(values)
            && self.measurement == Measurement::from_values(values)
            && self.reference_filter == ReferenceFilter::new(values[REFERENCE_FILTER], values[SAMPLE_TIME])
            && self.law == law(values)
    }
}

impl SampledUnit for MaglevRigController {
    fn clock(&self) -> &SampleClock {
        &self.clock
    }

    fn clock_mut(&mut self) -> &mut SampleClock {
        &mut self.clock
    }

    fn tick(&mut self, time: f64, journal: &mut dyn Journal) {
        self.tick_at(time, journal);
    }

    fn longest_step(&self) -> f64 {
        self.values[LONGEST_STEP]
    }

    fn cost_of_tick(&self) -> f64 {
        cost_of_tick(&self.values)
    }
}
