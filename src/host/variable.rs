//! One variable of an FMU.

use std::fmt;
use std::sync::Arc;

/// What a value means, the same in both versions of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Real,
    Integer,
    Boolean,
    Enumeration,
    String,
    /// Binary and clock variables, which the host does not touch.
    Other,
}

/// Type through which the C interface passes a value: it selects the function, for example `fmi3GetUInt16`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    Float64,
    Float32,
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Boolean,
    String,
    /// Binary and clock variables.
    Other,
}

impl fmt::Display for Storage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, formatter)
    }
}

/// The role of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    Parameter,
    CalculatedParameter,
    StructuralParameter,
    Input,
    Output,
    Local,
    Independent,
}

/// When a variable may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    Constant,
    Fixed,
    Tunable,
    Discrete,
    Continuous,
}

/// One variable of an FMU. Texts are shared with its aliases and with all variables of its type, so that a small file
/// cannot ask for much memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    pub name: String,
    /// The number by which the C interface knows the variable; unique per storage type only in FMI 2.0.
    pub value_reference: u32,
    pub kind: Kind,
    pub storage: Storage,
    pub causality: Causality,
    pub variability: Variability,
    /// As written in the XML; the values of an array are separated by spaces.
    pub start: Option<Arc<str>>,
    /// Unit of the variable, or of its declared type.
    pub unit: Option<Arc<str>>,
    pub declared_type: Option<Arc<str>>,
    pub description: Option<String>,
    /// FMI 3.0: the variable has dimensions, and the host cannot access it.
    pub is_array: bool,
}

impl Variable {
    /// For an error about two variables of the same name.
    pub(super) fn reference_text(&self) -> String {
        format!("that of value reference {} ({})", self.value_reference, self.storage)
    }
}
