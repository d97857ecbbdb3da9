//! Operating system and processor of a shared library, and their names in the two standards.

use std::fmt;

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
    /// Reads the platform from the head of a 64-bit ELF, PE or Mach-O file; `None` for anything else.
    pub fn of_library(bytes: &[u8]) -> Option<Self> {
        use Architecture::{Aarch64, X86_64};
        if bytes.starts_with(b"\x7fELF\x02\x01") {
            let architecture = match u16_at(bytes, 18)? {
                62 => X86_64,
                183 => Aarch64,
                _ => return None,
            };
            return Some(Self { architecture, system: System::Linux });
        }
        if bytes.starts_with(&[0xcf, 0xfa, 0xed, 0xfe]) {
            let architecture = match u32_at(bytes, 4)? {
                0x0100_0007 => X86_64,
                0x0100_000c => Aarch64,
                _ => return None,
            };
            return Some(Self { architecture, system: System::Darwin });
        }
        if bytes.starts_with(b"MZ") {
            let header = u32_at(bytes, 0x3c)? as usize;
            if !bytes.get(header..)?.starts_with(b"PE\0\0") {
                return None;
            }
            let architecture = match u16_at(bytes, header + 4)? {
                0x8664 => X86_64,
                0xaa64 => Aarch64,
                _ => return None,
            };
            return Some(Self { architecture, system: System::Windows });
        }
        None
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

fn u16_at(bytes: &[u8], offset: usize) -> Option<u16> {
    Some(u16::from_le_bytes(*bytes.get(offset..)?.first_chunk()?))
}

fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(offset..)?.first_chunk()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elf(machine: u16) -> Vec<u8> {
        let mut bytes = b"\x7fELF\x02\x01".to_vec();
        bytes.resize(18, 0);
        bytes.extend(machine.to_le_bytes());
        bytes
    }

    fn pe(machine: u16) -> Vec<u8> {
        let mut bytes = b"MZ".to_vec();
        bytes.resize(0x3c, 0);
        bytes.extend(0x40u32.to_le_bytes());
        bytes.extend(b"PE\0\0");
        bytes.extend(machine.to_le_bytes());
        bytes
    }

    fn mach_o(processor: u32) -> Vec<u8> {
        [0xfeed_facfu32.to_le_bytes(), processor.to_le_bytes()].concat()
    }

    #[test]
    fn platforms_are_told_by_their_heads() {
        for (bytes, fmi2, fmi3, extension) in [
            (elf(62), "linux64", "x86_64-linux", "so"),
            (elf(183), "aarch64-linux", "aarch64-linux", "so"),
            (pe(0x8664), "win64", "x86_64-windows", "dll"),
            (pe(0xaa64), "aarch64-windows", "aarch64-windows", "dll"),
            (mach_o(0x0100_0007), "darwin64", "x86_64-darwin", "dylib"),
            (mach_o(0x0100_000c), "aarch64-darwin", "aarch64-darwin", "dylib"),
        ] {
            let platform = Platform::of_library(&bytes).unwrap();
            assert_eq!(platform.directory(FmiVersion::Two), fmi2);
            assert_eq!(platform.directory(FmiVersion::Three), fmi3);
            assert_eq!(platform.extension(), extension);
        }
    }

    #[test]
    fn anything_else_has_no_platform() {
        for bytes in [b"".as_slice(), b"MZ", b"\x7fELF\x01\x01", b"\x7fELF\x02\x01", b"#!/bin/sh\n", &elf(3)]
        {
            assert_eq!(Platform::of_library(bytes), None);
        }
    }
}
