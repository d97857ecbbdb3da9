//! `maglev-fmu describe`

use std::path::PathBuf;

use clap::Args;
use maglev_fmu::package::{self, PackageError, Readme};

use super::{report, say};

/// Write the model descriptions, the README's tables and the list of linked crates from the sources
#[derive(Debug, Args)]
pub struct Describe {
    /// Root of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

impl Describe {
    pub fn run(&self) -> Result<(), PackageError> {
        let (written, readme) = package::describe(&self.root)?;
        written.iter().for_each(report);
        if self.root.join("Cargo.toml").exists() {
            report(&package::describe_third_party(&self.root)?);
        }
        match readme {
            Readme::Written(file) => report(&file),
            Readme::Missing(path) => say(format_args!("no {}, so no tables there", path.display())),
            Readme::NoMarkers(path) => {
                say(format_args!("{} left alone: it lacks the markers for tables", path.display()));
            }
        }
        Ok(())
    }
}
