//! `maglev-fmu build`

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Args;
use maglev_fmu::model::{Description, StartValues};
use maglev_fmu::package::{self, GenerationTime, Library};
use maglev_fmu::parameter_file::ParameterFile;

use super::output::{report, say};

/// Pack all models for FMI 2.0 and FMI 3.0, controllers of FMI 3.0 also with clocks
#[derive(Debug, Args)]
pub struct Build {
    /// Directory for the packages, which go to its subdirectories fmi2, fmi3 and fmi3-clocked
    #[arg(long, value_name = "DIR", default_value = "dist")]
    out: PathBuf,
    /// Shared library to pack instead of the one that was built with this program; may be given once per platform
    #[arg(long = "library", value_name = "PATH")]
    libraries: Vec<PathBuf>,
    /// Parameter file whose values become the start values of its model, such as `tune` writes; once per model
    #[arg(long = "parameters", value_name = "FILE")]
    parameters: Vec<PathBuf>,
}

impl Default for Build {
    fn default() -> Self {
        Self { out: "dist".into(), libraries: Vec::new(), parameters: Vec::new() }
    }
}

impl Build {
    /// Where the packages go.
    pub fn out(&self) -> &Path {
        &self.out
    }

    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let start_values = self.start_values()?;
        let libraries = match self.libraries.as_slice() {
            [] => vec![Library::of_this_build()?],
            paths => Library::read_all(paths)?,
        };
        let time = GenerationTime::of_this_build()?;
        let written = package::build_with(&self.out, &start_values, &libraries, time)?;
        for library in &libraries {
            say(format_args!(
                "{} for {}, source as of {time}",
                library.path().display(),
                library.platform()
            ))?;
        }
        Ok(written.iter().try_for_each(report)?)
    }

    fn start_values(&self) -> Result<Vec<(&'static Description, StartValues)>, Box<dyn Error>> {
        let mut all: Vec<(&'static Description, StartValues)> = Vec::new();
        for path in &self.parameters {
            let (description, values) = ParameterFile::read(path)?
                .start_values()
                .map_err(|error| format!("{}: {error}", path.display()))?;
            if all.iter().any(|(known, _)| std::ptr::eq(*known, description)) {
                return Err(format!("{}: a second file for {}", path.display(), description.name).into());
            }
            all.push((description, values));
        }
        Ok(all)
    }
}
