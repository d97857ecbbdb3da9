//! Operating system and processor of a shared library, and their names in the two standards.

use std::fmt;

use object::{BinaryFormat, Object, ObjectKind};

use super::FmiVersion;

/// Processor and operating system a shared library was built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Platform {
    architecture: Architecture,
    system: System,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Architecture {
    X86_64,
    Aarch64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum System {
    Linux,
    Windows,
    Darwin,
}

impl Platform {
    /// Of a shared library in one of the three formats; `None` for anything else.
    pub(super) fn of_library<'data>(library: &impl Object<'data>, format: BinaryFormat) -> Option<Self> {
        let architecture = match library.architecture() {
            object::Architecture::X86_64 => Architecture::X86_64,
            object::Architecture::Aarch64 => Architecture::Aarch64,
            _ => return None,
        };
        let system = match format {
            BinaryFormat::Elf => System::Linux,
            BinaryFormat::Pe => System::Windows,
            BinaryFormat::MachO => System::Darwin,
            _ => return None,
        };
        let is_shared = library.kind() == ObjectKind::Dynamic;
        (is_shared && library.is_64() && library.is_little_endian()).then_some(Self { architecture, system })
    }

    /// Directory under `binaries/`. FMI 2.0 has names of its own for x86 and refers to FMI 3.0 for all others.
    pub fn directory(self, version: FmiVersion) -> String {
        match (version, self.architecture, self.system) {
            (FmiVersion::Two, Architecture::X86_64, System::Linux) => "linux64".to_owned(),
            (FmiVersion::Two, Architecture::X86_64, System::Windows) => "win64".to_owned(),
            (FmiVersion::Two, Architecture::X86_64, System::Darwin) => "darwin64".to_owned(),
            _ => self.to_string(),
        }
    }

    /// Extension of a shared library.
    pub fn extension(self) -> &'static str {
        match self.system {
            System::Linux => "so",
            System::Windows => "dll",
            System::Darwin => "dylib",
        }
    }
}

/// The platform tuple of FMI 3.0.
impl fmt::Display for Platform {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let architecture = match self.architecture {
            Architecture::X86_64 => "x86_64",
            Architecture::Aarch64 => "aarch64",
        };
        let system = match self.system {
            System::Linux => "linux",
            System::Windows => "windows",
            System::Darwin => "darwin",
        };
        write!(formatter, "{architecture}-{system}")
    }
}
