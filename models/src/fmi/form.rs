//! The forms in which a model is packaged.

use super::FmiVersion;
use crate::model::{Description, Edition};

/// Version of the standard and edition of the model: one package each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    pub version: FmiVersion,
    pub edition: Edition,
}

impl Form {
    pub const FMI2: Self = Self { version: FmiVersion::Two, edition: Edition::Plain };
    pub const FMI3: Self = Self { version: FmiVersion::Three, edition: Edition::Plain };
    /// Clocks are of FMI 3.0 only.
    pub const FMI3_CLOCKED: Self = Self { version: FmiVersion::Three, edition: Edition::Clocked };

    pub const ALL: [Self; 3] = [Self::FMI2, Self::FMI3, Self::FMI3_CLOCKED];

    /// Directory of packages and model descriptions of this form.
    pub fn directory(self) -> &'static str {
        match self.edition {
            Edition::Plain => self.version.directory(),
            Edition::Clocked => "fmi3-clocked",
        }
    }

    /// The forms in which a model is packaged.
    pub fn all_of(description: &Description) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|form| form.edition.suits(description))
    }
}

/// The plain form of a version.
impl From<FmiVersion> for Form {
    fn from(version: FmiVersion) -> Self {
        Self { version, edition: Edition::Plain }
    }
}
