//! `maglev-fmu describe`

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use maglev_fmu::package::{self, Readme};

use super::output::{report, say};

/// Write the model descriptions, the README's tables and the list of linked crates from the sources
#[derive(Debug, Args)]
pub struct Describe {
    /// Root of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

impl Describe {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let (written, readme) = package::describe(&self.root)?;
        written.iter().try_for_each(report)?;
        if self.root.join("Cargo.toml").exists() {
            report(&package::describe_third_party(&self.root)?)?;
        }
        Ok(match readme {
            Readme::Written(file) => report(&file),
            Readme::Missing(path) => say(format_args!("no {}, so no tables there", path.display())),
            Readme::NoMarkers(path) => {
                say(format_args!("{} left alone: it lacks the markers for tables", path.display()))
            }
        }?)
    }
}
