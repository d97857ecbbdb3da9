//! The units of this build, packaged and opened by the host.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use maglev_fmu::host::{Fmu, Instance, Logging};
use maglev_fmu::package::{FmiVersion, GenerationTime, Library, build};

/// An FMU of the magnetic bearing.
pub fn open(version: FmiVersion, unit: &str) -> Fmu {
    let path = packages().join(version.directory()).join(unit).with_extension("fmu");
    Fmu::open(&path).unwrap()
}

/// An instance with parameters, logging on, to be initialised.
pub fn instantiate(version: FmiVersion, unit: &str, parameters: &[(&str, f64)]) -> Instance {
    let mut instance = open(version, unit).instantiate(unit, Logging::On).unwrap();
    for (name, value) in parameters {
        let handle = instance.variable(name).unwrap();
        instance.set(handle, *value).unwrap();
    }
    instance
}

/// Where the packages are; built once per test program.
fn packages() -> &'static Path {
    static PACKAGES: OnceLock<PathBuf> = OnceLock::new();
    PACKAGES.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
        std::fs::create_dir_all(&directory).unwrap();
        let library = Library::of_this_build().unwrap();
        let slim = directory.join(library.path().file_name().unwrap());
        std::fs::write(&slim, without_debug_sections(library.bytes())).unwrap();
        let libraries = [Library::read(&slim).unwrap()];
        build(&directory, &libraries, GenerationTime::from_epoch_seconds(1_234_567_890)).unwrap();
        directory
    })
}

/// What an ELF library of 64 bits needs to be loaded. The rest, sixty megabytes of debug information, would take long
/// to pack. Other formats stay as they are.
fn without_debug_sections(library: &[u8]) -> Vec<u8> {
    let mut bytes = library.to_vec();
    if !bytes.starts_with(b"\x7fELF\x02\x01") {
        return bytes;
    }
    let long = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let program_headers = long(32);
    let count = usize::from(u16::from_le_bytes([bytes[56], bytes[57]]));
    // File offset and size of each segment.
    let ends = (0..count).map(|index| program_headers + 56 * index).map(|at| long(at + 8) + long(at + 32));
    let end = ends.max().unwrap();
    bytes.truncate(end);
    // No section headers: their offset, number and name table.
    bytes[40..48].fill(0);
    bytes[60..64].fill(0);
    bytes
}
