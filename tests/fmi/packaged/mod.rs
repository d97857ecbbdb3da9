//! The units of this build, packaged and opened by the host.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use maglev_fmu::host::{Fmu, Instance, Logging};
use maglev_fmu::package::{Form, GenerationTime, Library, build};

/// An FMU; a version stands for its plain form.
pub fn open(form: impl Into<Form>, unit: &str) -> Fmu {
    let path = packages().join(form.into().directory()).join(unit).with_extension("fmu");
    Fmu::open(&path).unwrap()
}

/// An instance with parameters, logging on, to be initialised.
pub fn instantiate(form: impl Into<Form>, unit: &str, parameters: &[(&str, f64)]) -> Instance {
    let mut instance = open(form, unit).instantiate(unit, Logging::On).unwrap();
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
        let libraries = [Library::of_this_build().unwrap()];
        build(&directory, &libraries, GenerationTime::from_epoch_seconds(1_234_567_890)).unwrap();
        directory
    })
}
