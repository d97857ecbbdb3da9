//! Which variables the value of another one follows from: what model descriptions call dependencies.

use super::sampled_controller::{ObserverAndLaw, SampledController};
use super::variable::Variable;
pub use crate::scalar::DependencyKind;

/// What one variable follows from; by value reference, in ascending order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dependencies {
    /// Inputs, states and parameters from which the value follows at one instant, once initialisation is over.
    pub at_an_instant: Vec<(usize, DependencyKind)>,
    /// Parameters and inputs from which the value at the end of initialisation follows.
    pub initially: Vec<usize>,
}

/// A model whose dependencies can be found without an instance.
pub trait Structured {
    /// What each row of the table follows from.
    fn dependencies() -> Vec<Dependencies>;
}

/// The outputs of a controller are held between ticks: at one instant they follow from nothing.
impl<C: ObserverAndLaw<N>, const N: usize> Structured for SampledController<C, N> {
    fn dependencies() -> Vec<Dependencies> {
        let declared = |row: &Variable| {
            let sources = row.initially_from.iter().filter_map(|name| C::DESCRIPTION.find(name));
            let mut initially: Vec<usize> = sources.map(|(reference, _)| reference).collect();
            initially.sort_unstable();
            Dependencies { at_an_instant: Vec::new(), initially }
        };
        C::DESCRIPTION.variables.iter().map(declared).collect()
    }
}
