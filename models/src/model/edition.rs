//! How much of a model a package shows.

use super::sampled::{CLOCKS, ClockVariable};
use super::{Description, Token};

/// What a package shows of a model. All editions are served by the same library and compute the same; the instantiation
/// token tells which one an importer has read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edition {
    /// Without the clocks of a sampled model, and thus without what needs them: the importer steps, the model ticks.
    /// Many importers misread a description with clocks, even if they use none of them.
    Plain,
    /// With clocks: the importer may handle ticks as events or schedule them. Of sampled models only.
    Clocked,
}

impl Edition {
    pub const ALL: [Self; 2] = [Self::Plain, Self::Clocked];

    /// Whether the model comes in this edition.
    pub fn suits(self, description: &Description) -> bool {
        match self {
            Self::Plain => true,
            Self::Clocked => description.is_sampled(),
        }
    }

    /// Clocks that the edition shows of a model.
    pub(super) const fn clock_table(self, is_sampled: bool) -> &'static [ClockVariable] {
        match self {
            Self::Clocked if is_sampled => &CLOCKS,
            _ => &[],
        }
    }

    /// Clocks that the edition shows, with their value references.
    pub fn clocks(
        self,
        description: &Description,
    ) -> impl Iterator<Item = (usize, &'static ClockVariable)> + use<> {
        (description.variables.len()..).zip(self.clock_table(description.is_sampled()))
    }

    /// Instantiation token of the model in this edition.
    pub fn token(self, description: &Description) -> Token {
        description.tokens[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::super::MODELS;
    use super::*;

    #[test]
    fn every_model_is_plain_and_sampled_ones_are_clocked_too() {
        for model in MODELS {
            let description = model.description;
            let editions = Edition::ALL.map(|edition| edition.suits(description));
            assert_eq!(editions, [true, description.is_sampled()], "{}", description.name);
            assert_eq!(Edition::Plain.clocks(description).count(), 0);
            assert_eq!(Edition::Clocked.clocks(description).count(), description.clocks().count());
            assert_eq!(Edition::Plain.token(description), description.token());
            let is_own = Edition::Clocked.token(description) != description.token();
            assert_eq!(is_own, description.is_sampled(), "{}", description.name);
        }
    }
}
