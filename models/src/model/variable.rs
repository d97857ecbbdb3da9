//! One row of a model's variable table, the single source for value access, model description and documentation.

use super::accepted_bits::AcceptedBits;
use super::quantity::{Enumeration, Quantity, RATIO, TIME};

/// FMI data type of a variable. Every value is stored as `f64`, which holds integers and enumerations exactly.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Real(&'static Quantity),
    /// 32-bit signed.
    Integer,
    Boolean,
    Enumeration(&'static Enumeration),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    Independent,
    Parameter,
    CalculatedParameter,
    Input,
    Output,
    Local,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    Fixed,
    Tunable,
    Discrete,
    Continuous,
}

/// Row of a variable table; its index in the table is its value reference.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    pub name: &'static str,
    pub description: &'static str,
    pub kind: Kind,
    pub causality: Causality,
    pub variability: Variability,
    /// Start value of a parameter or input.
    pub start: f64,
    /// Smallest and largest allowed value in the variable's unit, infinite if there is none.
    pub range: (f64, f64),
    /// What [`Variable::check`] compares values with.
    pub(super) accepted: AcceptedBits,
    /// Of a sampled model: names of the variables from which the value at the end of initialisation follows.
    pub initially_from: &'static [&'static str],
    /// Name of the continuous state whose derivative with respect to time this is.
    pub derivative_of: Option<&'static str>,
    /// Whether a change of sign is an event that an importer who integrates the model has to locate.
    pub is_event_indicator: bool,
    /// Whether this is a continuous state that may jump at an event.
    pub is_reinitialised: bool,
}

/// What a variable of this kind takes at once: nothing of an enumeration, whose items are looked at one by one.
const fn accepted(kind: &Kind, range: (f64, f64)) -> AcceptedBits {
    if matches!(kind, Kind::Enumeration(_)) { AcceptedBits::NONE } else { AcceptedBits::of(range) }
}

impl Variable {
    const fn new(name: &'static str, kind: Kind, causality: Causality, variability: Variability) -> Self {
        Self {
            name,
            description: "",
            kind,
            causality,
            variability,
            start: 0.0,
            range: (f64::NEG_INFINITY, f64::INFINITY),
            accepted: accepted(&kind, (f64::NEG_INFINITY, f64::INFINITY)),
            initially_from: &[],
            derivative_of: None,
            is_event_indicator: false,
            is_reinitialised: false,
        }
    }

    /// Simulation time.
    pub const fn time() -> Self {
        Self::new("time", Kind::Real(&TIME), Causality::Independent, Variability::Continuous)
            .describe("Simulation time")
    }

    /// Input that the importer may change before every step.
    pub const fn input(name: &'static str, quantity: &'static Quantity) -> Self {
        Self::new(name, Kind::Real(quantity), Causality::Input, Variability::Continuous)
    }

    /// Output that moves in continuous time.
    pub const fn output(name: &'static str, quantity: &'static Quantity) -> Self {
        Self::new(name, Kind::Real(quantity), Causality::Output, Variability::Continuous)
    }

    /// Output that is held between ticks or communication points.
    pub const fn held_output(name: &'static str, kind: Kind) -> Self {
        Self::new(name, kind, Causality::Output, Variability::Discrete)
    }

    /// Internal value worth plotting.
    pub const fn local(name: &'static str, kind: Kind, variability: Variability) -> Self {
        Self::new(name, kind, Causality::Local, variability)
    }

    /// Parameter that is fixed once initialisation is over.
    pub const fn parameter(name: &'static str, kind: Kind, start: f64) -> Self {
        Self::new(name, kind, Causality::Parameter, Variability::Fixed).start(start)
    }

    /// Parameter that may change between steps.
    pub const fn tunable(name: &'static str, kind: Kind, start: f64) -> Self {
        Self::new(name, kind, Causality::Parameter, Variability::Tunable).start(start)
    }

    /// Parameter computed from others at initialisation.
    pub const fn calculated(name: &'static str, kind: Kind) -> Self {
        Self::new(name, kind, Causality::CalculatedParameter, Variability::Fixed)
    }

    pub const fn start(mut self, start: f64) -> Self {
        self.start = start;
        self
    }

    pub const fn range(mut self, minimum: f64, maximum: f64) -> Self {
        // What is added makes a negative zero a positive one, which bounds are compared as.
        self.range = (minimum + 0.0, maximum + 0.0);
        self.accepted = accepted(&self.kind, self.range);
        self
    }

    pub const fn describe(mut self, description: &'static str) -> Self {
        self.description = description;
        self
    }

    pub const fn initially_from(mut self, names: &'static [&'static str]) -> Self {
        self.initially_from = names;
        self
    }

    /// Derivative with respect to time of the continuous state called `state`.
    pub const fn derivative_of(mut self, state: &'static str) -> Self {
        self.derivative_of = Some(state);
        self
    }

    /// Quantity whose change of sign is an event, about 1 in size and never 0 after an event.
    pub const fn event_indicator(name: &'static str) -> Self {
        let mut variable = Self::local(name, Kind::Real(&RATIO), Variability::Continuous);
        variable.is_event_indicator = true;
        variable
    }

    /// A continuous state that may jump at an event.
    pub const fn reinitialised(mut self) -> Self {
        self.is_reinitialised = true;
        self
    }

    /// Unit symbol, "-" for a variable that has none.
    pub fn unit(&self) -> &'static str {
        match self.kind {
            Kind::Real(quantity) => quantity.unit.name,
            Kind::Integer | Kind::Boolean | Kind::Enumeration(_) => "-",
        }
    }

    /// Whether the value is computed by the model: it has no start value and cannot be set.
    pub const fn is_calculated(&self) -> bool {
        matches!(
            self.causality,
            Causality::Independent | Causality::CalculatedParameter | Causality::Output | Causality::Local
        )
    }
}

/// Row of the variable called `name`, for the compiler.
pub const fn row_of(variables: &[Variable], name: &str) -> Option<usize> {
    let mut row = 0;
    while row < variables.len() {
        if is_same(variables[row].name, name) {
            return Some(row);
        }
        row += 1;
    }
    None
}

/// As [`row_of`], of a variable that there has to be: what computes with it does not compile otherwise.
pub const fn required_row(variables: &[Variable], name: &str) -> usize {
    match row_of(variables, name) {
        Some(row) => row,
        None => panic!("the table lacks a variable that every model of its kind has"),
    }
}

const fn is_same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut place = 0;
    while place < one.len() && place < other.len() && one[place] == other[place] {
        place += 1;
    }
    place == one.len() && place == other.len()
}

/// Builds the static table `VARIABLES` of a model and a constant per row that holds the row's index, i.e. value reference,
/// for the module and its parent.
#[macro_export]
macro_rules! variable_table {
    ($($index:ident = $variable:expr;)*) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms, reason = "rows are named like constants")]
        #[allow(dead_code, reason = "not every row is read by name")]
        enum Row { $($index,)* Count }
        $(#[allow(dead_code, reason = "not every row is read by name")]
        pub(super) const $index: usize = Row::$index as usize;)*
        pub(super) const COUNT: usize = Row::Count as usize;
        pub(super) static VARIABLES: [$crate::model::variable::Variable; COUNT] = [$($variable,)*];
    };
}
pub use variable_table;
