//! Shared libraries to pack.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use object::read::NameOrOrdinal;
use object::{BinaryFormat, Object};

use super::{FmiVersion, PackageError, Platform};
use crate::file;
use crate::fmi::function_names;
use crate::model::{Edition, MODELS, Token, editions_of};

/// More than any build of the library, with all that debuggers want to know \[byte\].
const LARGEST: u64 = 256 << 20;

/// A shared library, read into memory.
#[derive(Clone, Debug)]
pub struct Library {
    path: PathBuf,
    platform: Platform,
    bytes: Vec<u8>,
}

impl Library {
    /// Reads the library at `path`, finds out what platform it is for, and makes sure that it serves these models: it
    /// exports every function of both standards, knows every model's name, and its instantiation tokens are those that
    /// the model descriptions will have.
    pub fn read(path: &Path) -> Result<Self, PackageError> {
        let bytes = file::read_at_most(path, LARGEST)
            .map_err(|source| PackageError::Read { path: path.to_owned(), source })?;
        let unknown = || PackageError::UnknownPlatform { path: path.to_owned() };
        let library = object::File::parse(bytes.as_slice()).map_err(|_| unknown())?;
        let platform = Platform::of_library(&library, library.format()).ok_or_else(unknown)?;
        let missing = missing_functions(&library);
        if let Some(first) = missing.first() {
            let first = (*first).to_owned();
            return Err(PackageError::MissingFunctions {
                path: path.to_owned(),
                first,
                count: missing.len(),
            });
        }
        let is_known = |name: &str| bytes.windows(name.len()).any(|part| part == name.as_bytes());
        if let Some(model) = MODELS.iter().map(|model| model.description.name).find(|name| !is_known(name)) {
            return Err(PackageError::OtherModels { path: path.to_owned(), model });
        }
        let tokens = texts_like_tokens(&bytes);
        let is_missing =
            |edition: &Edition, description| !tokens.contains(edition.token(description).as_str().as_bytes());
        let mut editions = editions_of(MODELS.iter().copied());
        if let Some((model, _)) = editions.find(|(model, edition)| is_missing(edition, model.description)) {
            return Err(PackageError::OtherRelease { path: path.to_owned(), model: model.description.name });
        }
        Ok(Self { path: path.to_owned(), platform, bytes })
    }

    /// Reads several libraries, at most one per platform.
    pub fn read_all(paths: &[PathBuf]) -> Result<Vec<Self>, PackageError> {
        let mut libraries: Vec<Self> = Vec::new();
        for path in paths {
            let library = Self::read(path)?;
            if let Some(first) = libraries.iter().find(|first| first.platform == library.platform) {
                return Err(PackageError::SamePlatform {
                    first: first.path.clone(),
                    second: library.path,
                    platform: library.platform.to_string(),
                });
            }
            libraries.push(library);
        }
        Ok(libraries)
    }

    /// The library that was built together with the running program.
    pub fn of_this_build() -> Result<Self, PackageError> {
        let program = env::current_exe().map_err(|source| PackageError::OwnPath { source })?;
        Self::read(&newest_library(program.parent().unwrap_or(Path::new(".")))?)
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn platform(&self) -> Platform {
        self.platform
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// Functions of both standards that the library does not export.
fn missing_functions(library: &object::File<'_>) -> Vec<&'static str> {
    // The linker of macOS puts an underscore before every name of C.
    let prefix: &[u8] = if library.format() == BinaryFormat::MachO { b"_" } else { b"" };
    let exports = library.exports().into_iter().flatten().flatten();
    let names: HashSet<Vec<u8>> = exports
        .filter_map(|export| match export.into_name() {
            NameOrOrdinal::Name(name) => name.strip_prefix(prefix).map(<[u8]>::to_vec),
            NameOrOrdinal::Ordinal(_) => None,
        })
        .collect();
    let wanted = FmiVersion::ALL.into_iter().flat_map(function_names).copied();
    wanted.filter(|name| !names.contains(name.as_bytes())).collect()
}

/// Whatever in the library has the length and the braces of an instantiation token.
fn texts_like_tokens(bytes: &[u8]) -> HashSet<&[u8]> {
    let parts = bytes.windows(Token::LENGTH);
    parts.filter(|part| part.starts_with(b"{") && part.ends_with(b"}")).collect()
}

/// The library in the program's directory, where `cargo build` and an installation put it, or in `deps` below,
/// where `cargo run` leaves it: the one that was built last, `deps` if they are equally old.
fn newest_library(directory: &Path) -> Result<PathBuf, PackageError> {
    let name =
        format!("{}{}{}", env::consts::DLL_PREFIX, maglev_models::LIBRARY_NAME, env::consts::DLL_SUFFIX);
    let looked_at = [directory.join(&name), directory.join("deps").join(&name)];
    let built_at = |path: &PathBuf| fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
    looked_at
        .iter()
        .filter_map(|path| Some((built_at(path)?, path)))
        .max_by_key(|(time, _)| *time)
        .map(|(_, path)| path.clone())
        .ok_or_else(|| PackageError::NoLibrary { looked_at: looked_at.to_vec() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
    use std::time::{Duration, SystemTime};

    #[test]
    fn the_newest_library_is_taken() {
        let directory = tempfile::tempdir().unwrap();
        let error = newest_library(directory.path()).unwrap_err().to_string();
        assert!(error.contains("deps") && error.contains("--library"), "{error}");

        let name =
            format!("{}{}{}", env::consts::DLL_PREFIX, maglev_models::LIBRARY_NAME, env::consts::DLL_SUFFIX);
        let (installed, built) = (directory.path().join(&name), directory.path().join("deps").join(&name));
        fs::create_dir(built.parent().unwrap()).unwrap();
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
        File::create(&installed).unwrap().set_modified(time).unwrap();
        assert_eq!(newest_library(directory.path()).unwrap(), installed);
        File::create(&built).unwrap().set_modified(time).unwrap();
        assert_eq!(newest_library(directory.path()).unwrap(), built);
        File::options()
            .write(true)
            .open(&installed)
            .unwrap()
            .set_modified(time + Duration::from_secs(1))
            .unwrap();
        assert_eq!(newest_library(directory.path()).unwrap(), installed);
    }
}
