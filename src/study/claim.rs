//! A statement of a paper, what was measured about it, and the verdict that follows.

use serde::Serialize;

/// Whether a statement holds here. Always computed from the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    Reproduced,
    NotReproduced,
    CannotBeJudged,
}

impl Verdict {
    pub fn text(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::CannotBeJudged => "cannot be judged",
        }
    }
}

/// A measured number with its unit.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    pub what: String,
    pub value: f64,
    pub unit: &'static str,
}

/// A claim and its verdict.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    /// Identifier that scripts can rely on.
    pub id: &'static str,
    /// What the paper says, in our words.
    pub statement: String,
    /// Where it says so.
    pub source: &'static str,
    pub verdict: Verdict,
    /// The numbers behind the verdict, the decisive one first.
    pub measured: Vec<Measurement>,
    /// How the numbers were computed and when the claim counts as reproduced.
    pub criterion: String,
}

impl Claim {
    /// Something that `source` says; not judged so far.
    pub fn new(id: &'static str, source: &'static str) -> Self {
        let (statement, criterion) = (String::new(), String::new());
        Self { id, statement, source, verdict: Verdict::CannotBeJudged, measured: Vec::new(), criterion }
    }

    /// What it says, in our words.
    pub fn stating(mut self, statement: impl Into<String>) -> Self {
        self.statement = statement.into();
        self
    }

    /// Adds a number in `unit`.
    pub fn measured(mut self, what: impl Into<String>, value: f64, unit: &'static str) -> Self {
        self.measured.push(Measurement { what: what.into(), value, unit });
        self
    }

    /// Adds a number for each of several cases.
    pub fn measured_each<W: Into<String>>(
        self,
        numbers: impl IntoIterator<Item = (W, f64)>,
        unit: &'static str,
    ) -> Self {
        numbers.into_iter().fold(self, |claim, (what, value)| claim.measured(what, value, unit))
    }

    /// Reproduced if it `holds` by the criterion.
    pub fn judged(mut self, holds: bool, criterion: impl Into<String>) -> Self {
        self.verdict = if holds { Verdict::Reproduced } else { Verdict::NotReproduced };
        self.criterion = criterion.into();
        self
    }

    /// Cannot be judged, for the reason given.
    pub fn not_judged(mut self, reason: impl Into<String>) -> Self {
        self.criterion = reason.into();
        self
    }
}
