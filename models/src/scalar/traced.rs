//! What a result depends on, and how: numbers that remember the variables they were computed from.

use super::Scalar;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Variables that a traced number can remember.
pub const MOST_VARIABLES: usize = 128;

/// How a variable enters the equation of another one: the kinds of dependencies of both standards.
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

/// When a number can change, from never to always.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variation {
    Never,
    /// Until initialisation is over.
    Fixed,
    /// At events, too.
    Discrete,
    Continuous,
}

impl Variation {
    /// How a number enters that is multiplied by one that varies like this.
    fn as_factor(self) -> DependencyKind {
        match self {
            Self::Never => DependencyKind::Constant,
            Self::Fixed => DependencyKind::Fixed,
            Self::Discrete => DependencyKind::Discrete,
            Self::Continuous => DependencyKind::Dependent,
        }
    }
}

/// A number with all variables of a table that it was computed from.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    value: f64,
    variation: Variation,
    /// Per row of the table: how that variable enters and the derivative by it.
    entries: [Option<(DependencyKind, f64)>; MOST_VARIABLES],
}

impl Traced {
    /// The variable in `row`, which has `value` and can change as `variation` says.
    pub fn variable(row: usize, value: f64, variation: Variation) -> Self {
        let mut variable = Self { variation, ..Self::from(value) };
        variable.entries[row] = Some((DependencyKind::Constant, 1.0));
        variable
    }

    pub fn value(&self) -> f64 {
        self.value
    }

    /// The variables that this number depends on: row, how each enters, derivative.
    pub fn dependencies(&self) -> impl Iterator<Item = (usize, DependencyKind, f64)> {
        let rows = self.entries.iter().enumerate();
        rows.filter_map(|(row, entry)| entry.map(|(kind, slope)| (row, kind, slope)))
    }

    /// This number, which depends in no particular way on whatever `cause` depends on, too.
    pub fn caused_by(self, cause: Self) -> Self {
        self.combined(cause.bent(0.0), self.value)
    }

    fn is_literally_zero(&self) -> bool {
        self.variation == Variation::Never && self.value == 0.0
    }

    /// The same dependencies where each enters times a number that varies as `factor` does, and has this `size`.
    fn times(mut self, factor: Variation, size: f64) -> Self {
        for (kind, slope) in self.entries.iter_mut().flatten() {
            *kind = (*kind).max(factor.as_factor());
            *slope *= size;
        }
        self.variation = self.variation.max(factor);
        self
    }

    /// The same dependencies, none of which enters in a particular way.
    fn bent(self, slope: f64) -> Self {
        Self { variation: self.variation, ..self.times(Variation::Continuous, slope) }
    }

    /// A number with this `value` and the dependencies of both.
    fn combined(mut self, other: Self, value: f64) -> Self {
        for (own, others) in self.entries.iter_mut().zip(other.entries) {
            *own = match (*own, others) {
                (Some((first, one)), Some((second, two))) => Some((first.max(second), one + two)),
                (entry, None) | (None, entry) => entry,
            };
        }
        Self { value, variation: self.variation.max(other.variation), ..self }
    }
}

impl From<f64> for Traced {
    fn from(value: f64) -> Self {
        Self { value, variation: Variation::Never, entries: [None; MOST_VARIABLES] }
    }
}

impl Add for Traced {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.combined(other, self.value + other.value)
    }
}

impl Sub for Traced {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Traced {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        if self.is_literally_zero() || other.is_literally_zero() {
            return Self::from(0.0);
        }
        let first = self.times(other.variation, other.value);
        first.combined(other.times(self.variation, self.value), self.value * other.value)
    }
}

impl Div for Traced {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if self.is_literally_zero() {
            return self;
        }
        let value = self.value / other.value;
        let numerator = self.times(other.variation, 1.0 / other.value);
        let varies = self.variation.max(other.variation);
        numerator.combined(other.times(varies, -value / other.value), value)
    }
}

impl Neg for Traced {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, ..self.times(Variation::Never, -1.0) }
    }
}

impl Scalar for Traced {
    /// Depends on the whole choice.
    fn if_at_most(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let chosen = if self.value <= bound.value { then } else { otherwise };
        let [condition, bound] = [self, bound].map(|side| side.bent(0.0));
        let branches = then.bent(1.0).combined(otherwise.bent(1.0), 0.0);
        branches.combined(condition, 0.0).combined(bound, chosen.value)
    }

    fn abs(self) -> Self {
        Self { value: self.value.abs(), ..self.bent(1.0) }
    }

    fn rint(self) -> Self {
        Self { value: libm::rint(self.value), ..self.bent(1.0) }
    }

    fn is_zero(self) -> bool {
        self.is_literally_zero()
    }

    /// What cannot be told from the dependencies is taken to be the usual case.
    fn is_finite(self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use DependencyKind::{Constant, Dependent, Discrete, Fixed};

    /// Kinds by row of what depends on an input x (row 0), a tunable parameter q (1) and a fixed one p (2).
    fn kinds(f: impl Fn(Traced, Traced, Traced) -> Traced) -> Vec<(usize, DependencyKind)> {
        let x = Traced::variable(0, 0.7, Variation::Continuous);
        let q = Traced::variable(1, 0.3, Variation::Discrete);
        let p = Traced::variable(2, 2.0, Variation::Fixed);
        f(x, q, p).dependencies().map(|(row, kind, _)| (row, kind)).collect()
    }

    #[test]
    fn kinds_tell_what_a_factor_follows_from() {
        assert_eq!(kinds(|x, _, _| -x - Traced::from(2.0) * x), [(0, Constant)]);
        assert_eq!(kinds(|x, _, p| x / p), [(0, Fixed), (2, Dependent)]);
        assert_eq!(kinds(|x, q, _| q * x), [(0, Discrete), (1, Dependent)]);
        assert_eq!(kinds(|x, q, p| x + q * p), [(0, Constant), (1, Fixed), (2, Discrete)]);
        assert_eq!(kinds(|x, _, _| x * x), [(0, Dependent)]);
        assert_eq!(kinds(|_, _, p| p / p), [(2, Fixed)]);
    }

    #[test]
    fn both_sides_of_a_choice_count() {
        assert_eq!(kinds(|x, q, _| x.max(q)), [(0, Dependent), (1, Dependent)]);
        assert_eq!(
            kinds(|x, q, p| q.if_at_most(p, x, Traced::from(1.0))),
            [(0, Dependent), (1, Dependent), (2, Dependent)]
        );
        assert_eq!(kinds(|x, _, p| (x * p).abs()), [(0, Dependent), (2, Dependent)]);
    }

    #[test]
    fn a_factor_of_zero_takes_dependencies_away() {
        assert_eq!(kinds(|x, q, _| Traced::from(0.0) * x + q), [(1, Constant)]);
        assert_eq!(kinds(|x, _, _| Traced::from(0.0) / x), []);
    }

    #[test]
    fn slopes_are_derivatives() {
        let x = Traced::variable(0, 0.7, Variation::Continuous);
        let p = Traced::variable(1, 2.0, Variation::Fixed);
        let result = (x * x / p - p).clamp(Traced::from(-9.0), Traced::from(9.0));
        let slopes: Vec<f64> = (x * x / p - p).dependencies().map(|(_, _, slope)| slope).collect();
        assert!(
            (slopes[0] - 0.7).abs() < 1e-15 && (slopes[1] + 0.49 / 4.0 + 1.0).abs() < 1e-15,
            "{slopes:?}"
        );
        assert_eq!(result.value(), 0.7 * 0.7 / 2.0 - 2.0);
    }
}
