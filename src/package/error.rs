//! Why a package could not be made.

use std::path::PathBuf;

use thiserror::Error;

use super::{FmiVersion, ThirdPartyError};
use crate::fmi::function_names;
use crate::model::ModelError;
use crate::model::start_values::StartValueError;

/// Why packaging failed: the action and the path or value that it failed on.
#[derive(Debug, Error)]
pub enum PackageError {
    #[error("cannot read {}", .path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("cannot write {}", .path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("cannot compress {}", .path.display())]
    Archive { path: PathBuf, source: zip::result::ZipError },
    #[error("cannot list the crates in the shared library")]
    ThirdParty(#[from] ThirdPartyError),
    #[error("a model of the system {system} cannot start as the table of systems says")]
    SystemStart { system: &'static str, source: StartValueError },
    #[error("cannot compute the reference output of {model}")]
    ReferenceRun { model: &'static str, source: ModelError },
    #[error("model {model} is not registered and has no icon")]
    NoIcon { model: &'static str },
    #[error("cannot read the icon of {model}")]
    Icon { model: &'static str, source: resvg::usvg::Error },
    #[error("cannot draw the icon of {model}: {reason}")]
    DrawIcon { model: &'static str, reason: String },
    #[error("cannot find this program's own file, next to which the shared library lies")]
    OwnPath { source: std::io::Error },
    #[error(
        "no shared library found, looked for {}: run `cargo build --release` first or give --library PATH",
        list(.looked_at)
    )]
    NoLibrary { looked_at: Vec<PathBuf> },
    #[error("{} is no 64-bit ELF, PE or Mach-O shared library for x86_64 or aarch64", .path.display())]
    UnknownPlatform { path: PathBuf },
    #[error(
        "{} is no library of these models: it lacks {first} and, with it, {count} of the {} functions of FMI 2.0 and FMI 3.0",
        .path.display(),
        FmiVersion::ALL.into_iter().map(|version| function_names(version).len()).sum::<usize>()
    )]
    MissingFunctions { path: PathBuf, first: String, count: usize },
    #[error("{} is a library of other models: it does not know {model}", .path.display())]
    OtherModels { path: PathBuf, model: &'static str },
    #[error(
        "{} is the library of another release: it would refuse the instantiation token in the model description of \
         {model}; build it from the sources of this program",
        .path.display()
    )]
    OtherRelease { path: PathBuf, model: &'static str },
    #[error("{} and {} are both for {platform}: expected one library per platform", .first.display(), .second.display())]
    SamePlatform { first: PathBuf, second: PathBuf, platform: String },
    #[error("SOURCE_DATE_EPOCH = {value:?}: expected seconds since 1970, 0 to {}", u32::MAX)]
    SourceDateEpoch { value: String },
}

fn list(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}
