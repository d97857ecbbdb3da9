//! Models that move in continuous time, as an importer sees them who integrates them with a solver of his own.

use super::Description;
use super::LARGEST_TABLE;
use super::Model;
use super::variable::{Causality, Kind};
use serde::{Deserialize, Serialize};

/// Largest number of continuous states of a model.
pub const MAX_STATES: usize = 4;

/// Largest number of event indicators of a model.
pub const MAX_EVENT_INDICATORS: usize = 4;

/// Who moves a model in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solver {
    /// The model itself ([`Model::advance`]): between the ends of its steps there is nothing to see, so that outputs may
    /// tell of the last step and sensors are read at its end.
    #[default]
    Model,
    /// An importer, in continuous time: what follows from states and inputs does so at each instant.
    Importer,
}

/// A model with continuous states x' = f(x, u, p), y = g(x, u, p), all of them rows of its table of values.
///
/// The models are autonomous: nothing depends on time but through the inputs. Only contact and the readings of a sensor
/// with a sample time are held in continuous time; they change at initialisation and at events.
pub trait ContinuousModel: Model {
    /// Computes derivatives, event indicators and everything else that follows at one instant from the values of
    /// states, inputs and parameters. Discrete values stay.
    fn evaluate(&mut self);

    /// Says who solves the model; whether that is somebody else than before. What follows is computed by the next
    /// [`Model::initialise`].
    fn set_solver(&mut self, solver: Solver) -> bool;

    /// Discrete transitions of an event at the present time, at which a sensor may be due; whether a continuous state
    /// jumped.
    fn update_discrete_states(&mut self) -> bool;

    /// Time \[s\] after the present one at which the importer has to come to an event.
    fn next_event_time(&self) -> Option<f64>;

    /// How fast each value changes where the model stands when knowns, by value reference, change as fast as `seed` says:
    /// inputs, parameters and, once it runs, states.
    fn tangents(&self, stage: Stage, seed: &mut dyn Iterator<Item = (usize, f64)>) -> Tangents;

    /// Slope \[1/s of the input's unit\] with which an input moves over a step.
    fn input_slope(&self, input: usize) -> f64;

    /// Lets an input move with a slope \[1/s of the input's unit\] during steps, until another slope is set. Its value
    /// moves along, so that it is the input's value at the end of the step.
    fn set_input_slope(&mut self, input: usize, slope: f64);

    /// Derivatives of all outputs with respect to time; 0 for those that are held.
    fn output_slopes(&self, rows: &ContinuousRows) -> Tangents {
        let states = rows.states().iter().zip(rows.derivatives());
        let states = states.map(|(state, derivative)| (*state, self.values()[*derivative]));
        let inputs = self.description().variables.iter().enumerate();
        let inputs = inputs.filter(|(_, row)| row.causality == Causality::Input);
        let inputs = inputs.map(|(input, _)| (input, self.input_slope(input)));
        self.tangents(Stage::Running, &mut states.chain(inputs))
    }
}

/// Which equations derivatives are those of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// What initialisation computes from inputs and parameters.
    Initialisation,
    /// What follows at one instant from inputs, states and parameters.
    Running,
}

/// Rates of change by value reference.
#[derive(Clone, Copy, Debug)]
pub struct Tangents([f64; LARGEST_TABLE]);

impl Tangents {
    pub(super) fn of(rates: impl Iterator<Item = f64>) -> Self {
        let mut tangents = Self([0.0; LARGEST_TABLE]);
        for (tangent, rate) in tangents.0.iter_mut().zip(rates) {
            *tangent = rate;
        }
        tangents
    }

    /// That of a value of the model's table.
    pub fn of_value(&self, reference: usize) -> f64 {
        self.0.get(reference).copied().unwrap_or(0.0)
    }
}

/// Where a model's table holds its continuous states, their derivatives and the event indicators.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContinuousRows {
    state_count: usize,
    states: [usize; MAX_STATES],
    derivatives: [usize; MAX_STATES],
    event_indicator_count: usize,
    event_indicators: [usize; MAX_EVENT_INDICATORS],
}

impl ContinuousRows {
    pub fn of(description: &Description) -> Self {
        let mut rows = Self::default();
        for (index, (state, derivative)) in description.continuous_states().take(MAX_STATES).enumerate() {
            rows.states[index] = state;
            rows.derivatives[index] = derivative;
            rows.state_count = index + 1;
        }
        for (index, indicator) in description.event_indicators().take(MAX_EVENT_INDICATORS).enumerate() {
            rows.event_indicators[index] = indicator;
            rows.event_indicator_count = index + 1;
        }
        rows
    }

    pub fn states(&self) -> &[usize] {
        &self.states[..self.state_count]
    }

    pub fn derivatives(&self) -> &[usize] {
        &self.derivatives[..self.state_count]
    }

    pub fn event_indicators(&self) -> &[usize] {
        &self.event_indicators[..self.event_indicator_count]
    }
}

/// Size that tells a solver how small an error in the variable `reference` has to be: the quantity's nominal value.
pub fn nominal(description: &Description, reference: usize) -> f64 {
    match description.variables[reference].kind {
        Kind::Real(quantity) => quantity.nominal,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::MODELS;
    use crate::model::variable::Variability;

    #[test]
    fn states_derivatives_and_indicators_are_continuous_reals() {
        for model in MODELS {
            let description = model.description;
            assert!(description.continuous_states().count() <= MAX_STATES, "{}", description.name);
            assert!(description.event_indicators().count() <= MAX_EVENT_INDICATORS, "{}", description.name);
            assert_eq!(
                description.offers_model_exchange(),
                !description.is_sampled(),
                "{}",
                description.name
            );
            assert_eq!(description.offers_model_exchange(), (model.create)().continuous().is_some());
            for row in description.variables {
                assert!(
                    row.derivative_of.is_none_or(|state| description.find(state).is_some()),
                    "{}",
                    row.name
                );
            }
            for (state, derivative) in description.continuous_states() {
                for reference in [state, derivative] {
                    let row = &description.variables[reference];
                    assert_eq!(row.variability, Variability::Continuous, "{}", row.name);
                    assert!(matches!(row.kind, Kind::Real(_)), "{}", row.name);
                    assert!(nominal(description, reference) > 0.0, "{}", row.name);
                }
            }
        }
    }
}
