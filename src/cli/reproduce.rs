//! `maglev-fmu reproduce`

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use maglev_fmu::package::{self, GenerationTime, Library};
use maglev_fmu::study::report::quantity;
use maglev_fmu::study::{EXPERIMENTS, Experiment, Findings, output};

use super::output::{OutputError, say};

/// Where results go unless told otherwise.
pub const RESULTS: &str = "results";

/// Build the models, run the papers' experiments through them and judge the papers' claims
#[derive(Debug, Args)]
pub struct Reproduce {
    /// Experiments to run, all if none is named
    #[arg(value_name = "NAME", value_parser = experiment)]
    names: Vec<&'static str>,
    /// Directory for figures, data, claims.json and report.html
    #[arg(long, value_name = "DIR", default_value = RESULTS)]
    out: PathBuf,
}

fn experiment(name: &str) -> Result<&'static str, String> {
    EXPERIMENTS.iter().map(|experiment| experiment.name).find(|known| *known == name).ok_or_else(|| {
        let known: Vec<&str> = EXPERIMENTS.iter().map(|experiment| experiment.name).collect();
        format!("no such experiment, expected one of: {}", known.join(", "))
    })
}

impl Reproduce {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        // Its own copy of the packages: what is judged is this build, wherever the user keeps others.
        let packages = tempfile::tempdir()?;
        package::build(packages.path(), &[Library::of_this_build()?], GenerationTime::of_this_build()?)?;
        let chosen = EXPERIMENTS
            .iter()
            .filter(|experiment| self.names.is_empty() || self.names.contains(&experiment.name));
        reproduce(chosen, packages.path(), &self.out)
    }
}

/// Runs experiments on the packages in `packages`, writes the results to `out` and prints the verdicts.
pub fn reproduce<'a>(
    experiments: impl Iterator<Item = &'a Experiment>,
    packages: &Path,
    out: &Path,
) -> Result<(), Box<dyn Error>> {
    let bar = ProgressBar::new(1000);
    bar.set_style(ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}")?);
    let mut findings = Vec::new();
    for experiment in experiments {
        let progress = |share: f64, action: &str| {
            bar.set_position((1000.0 * share) as u64);
            bar.set_message(action.to_owned());
        };
        findings.push((experiment.run)(packages, &progress)?);
    }
    bar.set_message("drawing");
    let report = output::write(out, &findings)?;
    bar.finish_and_clear();
    findings.iter().try_for_each(print_verdicts)?;
    Ok(say(format_args!("\nReport with figures: {}", report.display()))?)
}

/// One line per claim: verdict, decisive number, statement.
fn print_verdicts(findings: &Findings) -> Result<(), OutputError> {
    say(format_args!("\n{}\n", findings.title))?;
    for claim in &findings.claims {
        say(format_args!("{:<16} {}", claim.verdict.text(), claim.statement))?;
        if let Some(decisive) = claim.measured.first() {
            say(format_args!("{:<16}   {}: {}", "", decisive.what, quantity(decisive.value, decisive.unit)))?;
        }
    }
    Ok(())
}
