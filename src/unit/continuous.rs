//! Units that move in continuous time, as an importer sees them who integrates them with a solver of his own.

use super::Description;
use super::Unit;
use super::variable::{Causality, Kind};
use serde::{Deserialize, Serialize};

/// Largest number of continuous states of a unit.
pub const MAX_STATES: usize = 4;

/// Largest number of event indicators of a unit.
pub const MAX_EVENT_INDICATORS: usize = 4;

/// Who moves a unit in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solver {
    /// The unit itself ([`Unit::advance`]): between the ends of its steps there is nothing to see, so that outputs may
    /// tell of the last step and sensors are read at its end.
    #[default]
    Unit,
    /// An importer, in continuous time: what follows from states and inputs does so at each instant.
    Importer,
}

/// A unit with continuous states x' = f(x, u, p), y = g(x, u, p), all of them rows of its table of values.
///
/// The units are autonomous: nothing depends on time but through the inputs. Only contact and the readings of a sensor
/// with a sample time are held in continuous time; they change at initialisation and at events.
pub trait ContinuousUnit: Unit {
    /// Computes derivatives, event indicators and everything else that follows at one instant from the values of
    /// states, inputs and parameters. Discrete values stay.
    fn evaluate(&mut self);

    /// Says who solves the unit; whether that is somebody else than before. What follows is computed by the next
    /// [`Unit::initialise`].
    fn set_solver(&mut self, solver: Solver) -> bool;

    /// Discrete transitions of an event at the present time, at which a sensor may be due; whether a continuous state
    /// jumped.
    fn update_discrete_states(&mut self) -> bool;

    /// Time \[s\] after the present one at which the importer has to come to an event.
    fn next_event_time(&self) -> Option<f64>;

    /// Partial derivative of an output or state derivative with respect to an input, state or parameter, by value
    /// reference, in closed form, where the unit stands.
    fn partial_derivative(&self, unknown: usize, known: usize) -> f64;

    /// The same of what initialisation computes from inputs and parameters.
    fn initial_partial_derivative(&self, unknown: usize, known: usize) -> f64;

    /// Slope \[1/s of the input's unit\] with which an input moves over a step.
    fn input_slope(&self, input: usize) -> f64;

    /// Lets an input move with a slope \[1/s of the input's unit\] during steps, until another slope is set. Its value
    /// moves along, so that it is the input's value at the end of the step.
    fn set_input_slope(&mut self, input: usize, slope: f64);

    /// Derivative of an output with respect to time, by the chain rule; 0 for an output that is held.
    fn output_slope(&self, output: usize, rows: &ContinuousRows) -> f64 {
        let along_states = rows.states().iter().zip(rows.derivatives());
        let along_states = along_states
            .map(|(state, derivative)| self.partial_derivative(output, *state) * self.values()[*derivative]);
        let inputs = self.description().variables.iter().enumerate();
        let inputs = inputs.filter(|(_, row)| row.causality == Causality::Input);
        let along_inputs =
            inputs.map(|(input, _)| self.partial_derivative(output, input) * self.input_slope(input));
        along_states.chain(along_inputs).sum()
    }
}

/// Where a unit's table holds its continuous states, their derivatives and the event indicators.
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
    use crate::unit::UNITS;
    use crate::unit::variable::Variability;

    #[test]
    fn states_derivatives_and_indicators_are_continuous_reals() {
        for unit in UNITS {
            let description = unit.description;
            assert!(description.continuous_states().count() <= MAX_STATES, "{}", description.name);
            assert!(description.event_indicators().count() <= MAX_EVENT_INDICATORS, "{}", description.name);
            assert_eq!(
                description.offers_model_exchange(),
                !description.is_sampled(),
                "{}",
                description.name
            );
            assert_eq!(description.offers_model_exchange(), (unit.create)().continuous().is_some());
            for row in description.variables {
                assert!(
                    row.derivative_of.is_none_or(|state| description.find(state).is_some()),
                    "{}",
                    row.name
                );
                for dependency in row.depends_on {
                    let known = description.find(dependency.name).expect(dependency.name);
                    let is_state = description.continuous_states().any(|(state, _)| state == known.0);
                    let is_known = matches!(known.1.causality, Causality::Input | Causality::Parameter);
                    assert!(is_state || is_known, "{} depends on {}", row.name, dependency.name);
                }
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
