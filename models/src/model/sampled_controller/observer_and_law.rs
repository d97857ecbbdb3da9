//! What a controller says of itself.

use crate::model::sampled::SAMPLE_TIME;
use crate::model::variable::{Variable, required_row};
use crate::model::{Description, LogSink, ModelError, longest_step, start_delay};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Rows that every controller has, by their names in its table.
#[derive(Clone, Copy, Debug)]
pub struct ControllerRows {
    pub sample_time: usize,
    pub start_delay: usize,
    pub longest_step: usize,
    /// Time of the last tick.
    pub tick_time: usize,
    /// The voltage that the law asks for.
    pub voltage: usize,
    /// The voltage that acted, as the plant tells it.
    pub voltage_applied: usize,
    /// Which of the two the observer is told, a [`crate::model::controller_choices::VoltageSource`].
    pub voltage_source: usize,
}

impl ControllerRows {
    /// Found by the compiler.
    pub const fn of(variables: &[Variable]) -> Self {
        Self {
            sample_time: required_row(variables, SAMPLE_TIME),
            start_delay: required_row(variables, start_delay::NAME),
            longest_step: required_row(variables, longest_step::NAME),
            tick_time: required_row(variables, "tick_time"),
            voltage: required_row(variables, "voltage"),
            voltage_applied: required_row(variables, "voltage_applied"),
            voltage_source: required_row(variables, "observer.voltage_source"),
        }
    }
}

/// A tick.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// \[s\]
    pub time: f64,
    /// The first one since initialisation, or since the end of the start delay.
    pub is_first: bool,
    /// Voltage that has acted since the tick before \[V\], as the observer is told.
    pub acting_voltage: f64,
}

/// An observer and a law, of a controller with `N` variables: what they remember from tick to tick.
pub trait ObserverAndLaw<const N: usize>: Clone + Send + Serialize + DeserializeOwned + 'static {
    const DESCRIPTION: &'static Description;

    /// With parameters `values`, before the first tick.
    fn new(values: &[f64; N]) -> Self;

    /// Whether the parameters fit together.
    fn check_parameters(values: &[f64; N]) -> Result<(), ModelError> {
        let _ = values;
        Ok(())
    }

    /// Takes over tunable parameters; what is remembered stays.
    fn apply_tunable_parameters(&mut self, values: &[f64; N]);

    /// Begins anew with these parameters and inputs, and sets all outputs.
    fn initialise(&mut self, values: &mut [f64; N]);

    /// Reads the inputs, runs the observer, then the law, and sets the outputs.
    fn tick(&mut self, values: &mut [f64; N], sample: Sample, sink: &mut dyn LogSink);

    /// Whether this can have been made with these parameters.
    fn is_consistent(&self, values: &[f64; N]) -> bool;

    /// What a tick costs at most \[s\], see [`crate::model::work`].
    fn cost_of_tick(values: &[f64; N]) -> f64;
}
