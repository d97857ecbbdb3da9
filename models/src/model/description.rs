//! What a model tells the world about itself.

use super::sampled::SAMPLE_TIME;
use super::variable::{Variable, row_of};
use super::{Edition, Token};

/// Static description of an exported model.
#[derive(Debug)]
pub struct Description {
    /// Model name, model identifier and file name: a C identifier.
    pub name: &'static str,
    pub summary: &'static str,
    pub variables: &'static [Variable],
    /// Suggested communication step \[s\].
    pub step_size: f64,
    /// Suggested end of a simulation \[s\].
    pub stop_time: f64,
    /// By [`Edition`], in the order of [`Edition::ALL`].
    pub(super) tokens: [Token; Edition::ALL.len()],
}

impl Description {
    /// A model with these variables, of which nothing else is told yet.
    pub const fn new(name: &'static str, variables: &'static [Variable]) -> Self {
        let is_sampled = is_sampled(variables);
        let tokens = [
            Token::of(name, variables, Edition::Plain.clock_table(is_sampled)),
            Token::of(name, variables, Edition::Clocked.clock_table(is_sampled)),
        ];
        Self { name, summary: "", variables, step_size: 0.0, stop_time: 0.0, tokens }
    }

    pub const fn summary(mut self, summary: &'static str) -> Self {
        self.summary = summary;
        self
    }

    /// Suggests a simulation: communication step and end \[s\].
    pub const fn experiment(mut self, step_size: f64, stop_time: f64) -> Self {
        self.step_size = step_size;
        self.stop_time = stop_time;
        self
    }

    /// The variable called `name` and its value reference.
    pub fn find(&self, name: &str) -> Option<(usize, &'static Variable)> {
        self.variables.iter().enumerate().find(|(_, variable)| variable.name == name)
    }

    /// Whether the model acts at ticks only, as the controllers do, and not in continuous time.
    pub fn is_sampled(&self) -> bool {
        is_sampled(self.variables)
    }

    /// Continuous states with their derivatives, as value references, in the order of the derivatives' rows.
    pub fn continuous_states(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = self.variables.iter().enumerate();
        rows.filter_map(|(derivative, row)| Some((self.find(row.derivative_of?)?.0, derivative)))
    }

    /// Value references of the event indicators.
    pub fn event_indicators(&self) -> impl Iterator<Item = usize> {
        let rows = self.variables.iter().enumerate();
        rows.filter(|(_, row)| row.is_event_indicator).map(|(reference, _)| reference)
    }

    /// Whether an importer may integrate the model itself.
    pub fn offers_model_exchange(&self) -> bool {
        self.variables.iter().any(|row| row.derivative_of.is_some())
    }

    /// Instantiation token of the model's plain edition, which is the model's own.
    pub fn token(&self) -> Token {
        Edition::Plain.token(self)
    }
}

const fn is_sampled(variables: &[Variable]) -> bool {
    row_of(variables, SAMPLE_TIME).is_some()
}
