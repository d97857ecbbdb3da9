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
    pub fn of(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::NotReproduced }
    }

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

impl Measurement {
    pub fn new(what: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self { what: what.into(), value, unit }
    }
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
