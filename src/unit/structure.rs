//! Which variables the value of another one follows from: what model descriptions call dependencies.

use super::Description;

/// How a known enters the equation of an unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DependencyKind {
    /// Times a number that never changes.
    Constant,
    /// Times a number that follows from fixed parameters.
    Fixed,
    /// Times a number that changes at events and with parameters only.
    Discrete,
    /// In no particular way.
    Dependent,
}

/// What one variable follows from; by value reference, in ascending order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dependencies {
    /// Inputs, states and parameters from which the value follows at one instant, once initialisation is over.
    pub at_an_instant: Vec<(usize, DependencyKind)>,
    /// Parameters and inputs from which the value at the end of initialisation follows.
    pub initially: Vec<usize>,
}

impl Description {
    /// Dependencies per row of the table: of a plant those of its equations, computed anew at each call, of a sampled
    /// unit, whose outputs are held between ticks, those that the table tells.
    pub fn dependencies(&self) -> Vec<Dependencies> {
        match self.trace {
            Some(trace) => trace(),
            None => self.variables.iter().map(|row| self.declared(row.initially_from)).collect(),
        }
    }

    fn declared(&self, initially_from: &[&str]) -> Dependencies {
        let sources = initially_from.iter().filter_map(|name| self.find(name));
        let mut initially: Vec<usize> = sources.map(|(reference, _)| reference).collect();
        initially.sort_unstable();
        Dependencies { at_an_instant: Vec::new(), initially }
    }
}
