//! The models of this build, packaged and opened by the host.

use std::fs::{self, OpenOptions};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use maglev_fmu::host::{Fmu, Instance, Logging};
use maglev_fmu::package::{Form, GenerationTime, Library, build};

/// An FMU; a version stands for its plain form.
pub fn open(form: impl Into<Form>, model: &str) -> Fmu {
    let path = directory().join(form.into().directory()).join(model).with_extension("fmu");
    Fmu::open(&path).unwrap()
}

/// An instance with parameters, logging on, to be initialised.
pub fn instantiate(form: impl Into<Form>, model: &str, parameters: &[(&str, f64)]) -> Instance {
    let mut instance = open(form, model).instantiate(model, Logging::On).unwrap();
    for (name, value) in parameters {
        let handle = instance.variable(name).unwrap();
        instance.set(handle, *value).unwrap();
    }
    instance
}

/// Where all packages are. They are built once per library, whichever test program needs them first.
pub fn directory() -> &'static Path {
    static DIRECTORY: LazyLock<PathBuf> = LazyLock::new(|| {
        let library = Library::of_this_build().unwrap();
        let directory = library.path().with_file_name("packages");
        fs::create_dir_all(&directory).unwrap();
        // The compiler writes the shared library together with the code that packs it: as long as its file is the same, so
        // are the packages.
        let built_at = fs::metadata(library.path()).unwrap().modified().unwrap();
        let wanted = format!("{built_at:?}");
        let stamp = directory.join("packed_library");
        let mut stamp =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(stamp).unwrap();
        // Test programs that run at the same time wait here; the lock ends with the file.
        stamp.lock().unwrap();
        let mut packed = String::new();
        stamp.read_to_string(&mut packed).unwrap();
        if packed != wanted {
            stamp.set_len(0).unwrap();
            stamp.rewind().unwrap();
            build(&directory, &[library], GenerationTime::from_epoch_seconds(1_234_567_890)).unwrap();
            stamp.write_all(wanted.as_bytes()).unwrap();
        }
        directory
    });
    &DIRECTORY
}
