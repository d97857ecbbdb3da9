//! An FMU on disk becomes a loaded one that can be instantiated.

use std::ffi::CString;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use super::archive::Archive;
use super::description::ModelDescription;
use super::error::{HostError, Result};
use super::instance::{Instance, Logging};
use super::library::LoadedLibrary;
use super::limits::Limits;
use super::loaded::{Functions, Loaded};
use super::message_log::MessageLog;
use super::{fmi2, fmi3};
use crate::fmi::FmiVersion;

/// An opened FMU: unpacked, its library loaded, its functions resolved. Cheap to clone.
///
/// The library is unloaded and the unpacked files are removed with the last `Fmu` or [`Instance`] that uses them.
#[derive(Clone)]
pub struct Fmu {
    loaded: Arc<Loaded>,
}

impl Fmu {
    /// Unpacks the FMU at `path` within the default [`Limits`], reads its description and loads its library for this
    /// platform.
    ///
    /// This runs code of the FMU: open only what you trust.
    ///
    /// # Errors
    /// As [`Fmu::open_within`].
    pub fn open(path: &Path) -> Result<Self> {
        Self::open_within(path, &Limits::default())
    }

    /// As [`Fmu::open`], for FMUs that are larger than the default limits, or that shall be smaller.
    ///
    /// # Errors
    /// Those of [`Archive::unpack_within`] and [`Archive::description`], [`HostError::NoCoSimulation`],
    /// [`HostError::NoLibrary`], [`HostError::LoadLibrary`], [`HostError::MissingFunction`] and
    /// [`HostError::VersionMismatch`].
    pub fn open_within(path: &Path, limits: &Limits) -> Result<Self> {
        let archive = Archive::unpack_within(path, limits)?;
        let description = archive.description()?;
        let interface = description
            .co_simulation
            .as_ref()
            .ok_or_else(|| HostError::NoCoSimulation { model: description.model_name.clone() })?;
        let library = LoadedLibrary::load(archive.directory(), &description, interface)?;
        let functions = match description.fmi_version {
            FmiVersion::Two => Functions::Two(fmi2::Functions::resolve(&library)?),
            FmiVersion::Three => Functions::Three(Box::new(fmi3::Functions::resolve(&library)?)),
        };
        Ok(Self { loaded: Arc::new(Loaded { functions, _library: library, archive, description }) })
    }

    /// What `modelDescription.xml` says.
    pub fn description(&self) -> &ModelDescription {
        &self.loaded.description
    }

    /// Where the FMU is unpacked.
    pub fn directory(&self) -> &Path {
        self.loaded.archive.directory()
    }

    /// A new co-simulation instance called `name`, with the token of the description.
    ///
    /// # Errors
    /// [`HostError::Instantiate`] if the FMU refuses, [`HostError::NulInText`] for a name C cannot hold.
    pub fn instantiate(&self, name: &str, logging: Logging) -> Result<Instance> {
        self.instantiate_with_token(name, &self.description().instantiation_token, logging)
    }

    /// As [`Fmu::instantiate`], with a token of your own: to test that a wrong one is refused.
    ///
    /// # Errors
    /// As [`Fmu::instantiate`].
    pub fn instantiate_with_token(&self, name: &str, token: &str, logging: Logging) -> Result<Instance> {
        let loaded = &*self.loaded;
        let resources = loaded.archive.resources();
        let resources = match loaded.functions {
            Functions::Two(_) => file_uri(&resources),
            // FMI 3.0 asks for a plain path that ends with a separator.
            Functions::Three(_) => format!("{}{}", resources.display(), std::path::MAIN_SEPARATOR),
        };
        let c_name = c_text("instance name", name)?;
        let token = c_text("instantiation token", token)?;
        let resources = c_text("resource path", &resources)?;
        let message_log = Arc::new(MessageLog::default());
        let log = logging == Logging::On;
        let component = loaded.functions.instantiate(&c_name, &token, &resources, log, &message_log);
        let Some(component) = component else {
            return Err(HostError::Instantiate {
                model: loaded.description.model_name.clone(),
                function: loaded.functions.instantiate_name(),
                instance: name.to_owned(),
                log: message_log.last_text(),
            });
        };
        Ok(Instance::new(name.to_owned(), component, message_log, Arc::clone(&self.loaded)))
    }
}

impl fmt::Debug for Fmu {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Fmu")
            .field("model_name", &self.description().model_name)
            .field("directory", &self.directory())
            .finish_non_exhaustive()
    }
}

pub(super) fn c_text(purpose: &str, text: &str) -> Result<CString> {
    CString::new(text)
        .map_err(|_| HostError::NulInText { purpose: purpose.to_owned(), text: text.to_owned() })
}

/// The URI of a directory, as FMI 2.0 wants its resource location.
fn file_uri(path: &Path) -> String {
    let text = path.display().to_string().replace('\\', "/");
    // `C:/...` of Windows needs a third slash, `/...` brings its own.
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/:".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resource_location_is_a_valid_uri() {
        assert_eq!(file_uri(Path::new("/srv/a b/resources")), "file:///srv/a%20b/resources");
        assert_eq!(file_uri(Path::new("C:\\fmu\\resources")), "file:///C:/fmu/resources");
        assert_eq!(file_uri(Path::new("/srv/é")), "file:///srv/%C3%A9");
    }
}
