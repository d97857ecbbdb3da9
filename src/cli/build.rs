//! `maglev-fmu build`

use std::path::{Path, PathBuf};

use clap::Args;
use maglev_fmu::package::{self, GenerationTime, Library, PackageError};

use super::{report, say};

/// Pack all units for FMI 2.0 and FMI 3.0
#[derive(Debug, Args)]
pub struct Build {
    /// Directory for the packages, which go to its subdirectories fmi2 and fmi3
    #[arg(long, value_name = "DIR", default_value = "dist")]
    out: PathBuf,
    /// Shared library to pack instead of the one that was built with this program; may be given once per platform
    #[arg(long = "library", value_name = "PATH")]
    libraries: Vec<PathBuf>,
}

impl Default for Build {
    fn default() -> Self {
        Self { out: "dist".into(), libraries: Vec::new() }
    }
}

impl Build {
    /// Where the packages go.
    pub fn out(&self) -> &Path {
        &self.out
    }

    pub fn run(&self) -> Result<(), PackageError> {
        let libraries = match self.libraries.as_slice() {
            [] => vec![Library::of_this_build()?],
            paths => Library::read_all(paths)?,
        };
        let time = GenerationTime::of_this_build()?;
        for library in &libraries {
            say(format_args!("{} for {}, source as of {time}", library.path().display(), library.platform()));
        }
        package::build(&self.out, &libraries, time)?.iter().for_each(report);
        Ok(())
    }
}
