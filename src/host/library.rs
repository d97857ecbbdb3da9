//! The shared library inside an FMU: where it lies, how it is loaded, and its functions.

use std::env::consts::{ARCH, DLL_EXTENSION, OS};
use std::ffi::c_char;
use std::fs;
use std::path::{Path, PathBuf};

use libloading::Library;

use super::description::{CoSimulation, ModelDescription};
use super::error::{HostError, Result};
use super::message_log::text_of;
use crate::causes::with_causes;
use crate::fmi::FmiVersion;

/// The folders of `binaries` in which a library for this platform may lie, the standard's name first.
fn platform_folders(version: FmiVersion, architecture: &str, system: &str) -> Vec<String> {
    let system = if system == "macos" { "darwin" } else { system };
    let tuple = format!("{architecture}-{system}");
    match version {
        FmiVersion::Three => vec![tuple],
        FmiVersion::Two => {
            let short = match (architecture, system) {
                ("x86_64", "linux") => Some("linux64"),
                ("x86_64", "windows") => Some("win64"),
                // Universal binaries are common in this folder.
                ("x86_64" | "aarch64", "darwin") => Some("darwin64"),
                ("x86", "linux") => Some("linux32"),
                ("x86", "windows") => Some("win32"),
                // FMI 2.0 names no other platforms; packers borrow the names of FMI 3.0.
                _ => None,
            };
            short.map(str::to_owned).into_iter().chain([tuple]).collect()
        }
    }
}

/// The path of the shared library for this platform.
fn locate(root: &Path, description: &ModelDescription, interface: &CoSimulation) -> Result<PathBuf> {
    let identifier = &interface.model_identifier;
    let folders = platform_folders(description.fmi_version, ARCH, OS);
    let file = format!("{identifier}.{DLL_EXTENSION}");
    // The identifier comes from a foreign file: it must not lead out of the binaries folder.
    if !identifier.contains(['/', '\\', '\0'])
        && let Some(path) = folders
            .iter()
            .map(|folder| root.join("binaries").join(folder).join(&file))
            .find(|path| path.is_file())
    {
        return Ok(path);
    }
    let wanted = folders.iter().map(|folder| format!("binaries/{folder}/{file}")).collect::<Vec<_>>();
    Err(HostError::NoLibrary {
        model: description.model_name.clone(),
        wanted: wanted.join(" or "),
        found: present_binaries(root),
    })
}

/// The files below `binaries`, for an error message.
fn present_binaries(root: &Path) -> String {
    let entries = |directory: &Path| {
        let entries = fs::read_dir(directory).into_iter().flatten().flatten();
        let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        paths
    };
    let files = entries(&root.join("binaries")).into_iter().flat_map(|folder| entries(&folder));
    let names = files.filter_map(|path| Some(path.strip_prefix(root).ok()?.display().to_string()));
    names.collect::<Vec<_>>().join(", ")
}

/// A loaded shared library and the model it belongs to.
pub(super) struct LoadedLibrary {
    library: Library,
    model: String,
}

impl LoadedLibrary {
    /// Finds and loads the library of an unpacked FMU.
    pub(super) fn load(
        root: &Path,
        description: &ModelDescription,
        interface: &CoSimulation,
    ) -> Result<Self> {
        let path = locate(root, description, interface)?;
        let library = load(&path)
            .map_err(|error| HostError::LoadLibrary { path: path.clone(), reason: with_causes(&error) })?;
        Ok(Self { library, model: description.model_name.clone() })
    }

    /// The function called `name`.
    ///
    /// # Safety
    /// `F` must be the function pointer type that the standard gives to `name`.
    ///
    /// # Errors
    /// [`HostError::MissingFunction`] if the library does not export it.
    pub(super) unsafe fn required<F: Copy>(&self, name: &'static str) -> Result<F> {
        // SAFETY: the same contract.
        unsafe { self.optional(name) }
            .ok_or_else(|| HostError::MissingFunction { model: self.model.clone(), function: name })
    }

    /// The function called `name`, `None` if the library does not export it.
    ///
    /// # Safety
    /// `F` must be the function pointer type that the standard gives to `name`.
    pub(super) unsafe fn optional<F: Copy>(&self, name: &'static str) -> Option<F> {
        // SAFETY: by contract F is the type of that function; it is called only while the library is loaded,
        // because everything that holds a function table holds the library too.
        unsafe { self.library.get::<F>(name) }.ok().map(|symbol| *symbol)
    }

    /// Asks the library for the version it was built for: catches an XML that belongs to another library.
    pub(super) fn check_version(&self, function: &'static str, expected: &'static str) -> Result<()> {
        // SAFETY: fmi2GetVersion and fmi3GetVersion both take nothing and return a constant C string.
        let get_version: unsafe extern "C" fn() -> *const c_char = unsafe { self.required(function)? };
        // SAFETY: as above; callable before any instance exists.
        let reported = unsafe { text_of(get_version()) };
        if reported.split('.').next() == expected.split('.').next() {
            return Ok(());
        }
        Err(HostError::VersionMismatch { model: self.model.clone(), function, reported, expected })
    }
}

#[cfg(unix)]
fn load(path: &Path) -> std::result::Result<Library, libloading::Error> {
    use libloading::os::unix;
    // Bound at once: a function the library itself lacks is an error here, not a crash in the first step.
    // SAFETY: runs the library's initialisers. There is no way to use an FMU without trusting its code.
    unsafe { unix::Library::open(Some(path), unix::RTLD_NOW | unix::RTLD_LOCAL) }.map(Library::from)
}

#[cfg(windows)]
fn load(path: &Path) -> std::result::Result<Library, libloading::Error> {
    use libloading::os::windows;
    // Lets the library find the other libraries beside it.
    // SAFETY: runs the library's initialisers. There is no way to use an FMU without trusting its code.
    unsafe { windows::Library::load_with_flags(path, windows::LOAD_WITH_ALTERED_SEARCH_PATH) }
        .map(Library::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_follow_the_standards() {
        let first =
            |version, architecture, system| platform_folders(version, architecture, system)[0].clone();
        assert_eq!(first(FmiVersion::Two, "x86_64", "linux"), "linux64");
        assert_eq!(first(FmiVersion::Two, "x86_64", "windows"), "win64");
        assert_eq!(first(FmiVersion::Two, "aarch64", "macos"), "darwin64");
        assert_eq!(first(FmiVersion::Two, "aarch64", "linux"), "aarch64-linux");
        assert_eq!(first(FmiVersion::Three, "x86_64", "linux"), "x86_64-linux");
        assert_eq!(first(FmiVersion::Three, "aarch64", "macos"), "aarch64-darwin");
        assert_eq!(first(FmiVersion::Three, "x86_64", "windows"), "x86_64-windows");
    }
}
