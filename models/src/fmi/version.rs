//! The two versions of the standard.

use std::fmt;

/// Version of the Functional Mock-up Interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0, text of 2.0.5.
    Two,
    /// FMI 3.0, text of 3.0.2.
    Three,
}

impl FmiVersion {
    pub const ALL: [Self; 2] = [Self::Two, Self::Three];

    /// Directory of packages and model descriptions of this version.
    pub fn directory(self) -> &'static str {
        match self {
            Self::Two => "fmi2",
            Self::Three => "fmi3",
        }
    }

    /// The attribute `fmiVersion`. Bug-fix releases of the standards do not show in it.
    pub fn text(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }
}

impl fmt::Display for FmiVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.text())
    }
}
