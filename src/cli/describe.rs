//! `maglev-fmu describe`

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use maglev_fmu::package;

use super::output::report;

/// Write the model descriptions, the pages in docs/models and the list of linked crates from the sources
#[derive(Debug, Args)]
pub struct Describe {
    /// Root of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

impl Describe {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        package::describe(&self.root)?.iter().try_for_each(report)?;
        if self.root.join("Cargo.toml").exists() {
            report(&package::describe_third_party(&self.root)?)?;
        }
        Ok(())
    }
}
