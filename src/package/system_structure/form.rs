//! The forms in which a system is packaged.

use crate::model::variable::Kind;
use crate::package::Form;

/// What a system is packaged for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemForm {
    /// SSP 1.0 without connectors of the system, since some importers refuse connections to and from it; what the loop
    /// leaves open keeps its start value unless an importer sets it by itself.
    Closed,
    /// SSP 1.0 with connectors of the system.
    Driven,
    /// SSP 2.0 with connectors of the system, and with models for FMI 3.0, which SSP 1.0 does not know.
    Two,
}

impl SystemForm {
    pub const ALL: [Self; 3] = [Self::Closed, Self::Driven, Self::Two];

    /// Directory of the packages, below that of all packages.
    pub fn directory(self) -> &'static str {
        match self {
            Self::Closed => "",
            Self::Driven => "driven",
            Self::Two => "ssp2",
        }
    }

    /// The attribute `version`.
    pub fn version(self) -> &'static str {
        match self {
            Self::Closed | Self::Driven => "1.0",
            Self::Two => "2.0",
        }
    }

    /// The form in which the models of the system are packaged.
    pub fn of_models(self) -> Form {
        match self {
            Self::Closed | Self::Driven => Form::FMI2,
            Self::Two => Form::FMI3,
        }
    }

    /// Name of the data type of a variable. Enumerations have none: not every importer takes them.
    pub fn data_type(self, kind: Kind) -> Option<&'static str> {
        match (kind, self) {
            (Kind::Real(_), Self::Closed | Self::Driven) => Some("Real"),
            (Kind::Real(_), Self::Two) => Some("Float64"),
            (Kind::Integer, Self::Closed | Self::Driven) => Some("Integer"),
            (Kind::Integer, Self::Two) => Some("Int32"),
            (Kind::Boolean, _) => Some("Boolean"),
            (Kind::Enumeration(_), _) => None,
        }
    }

    /// Whether the system itself has connectors.
    pub fn has_system_connectors(self) -> bool {
        self != Self::Closed
    }
}
