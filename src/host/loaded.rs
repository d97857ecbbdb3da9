//! A loaded FMU: its library, its functions and its unpacked files.

use std::ffi::CStr;
use std::sync::Arc;

use super::archive::Archive;
use super::component::Component;
use super::description::ModelDescription;
use super::library::LoadedLibrary;
use super::message_log::MessageLog;
use super::{fmi2, fmi3};

/// Everything an instance needs to stay alive. The order of the fields is the order in which they go:
/// the library before its file, which some systems do not let go earlier.
pub(super) struct Loaded {
    pub(super) functions: Functions,
    pub(super) _library: LoadedLibrary,
    pub(super) archive: Archive,
    pub(super) description: ModelDescription,
}

/// The C functions of the FMU's version of the standard.
pub(super) enum Functions {
    Two(fmi2::Functions),
    Three(Box<fmi3::Functions>),
}

impl Functions {
    /// The function that creates an instance, for error messages.
    pub(super) fn instantiate_name(&self) -> &'static str {
        match self {
            Self::Two(_) => "fmi2Instantiate",
            Self::Three(_) => "fmi3InstantiateCoSimulation",
        }
    }

    /// A new co-simulation instance, `None` if the FMU refuses. `resources` is an URI in FMI 2.0 and a path in FMI 3.0.
    pub(super) fn instantiate(
        &self,
        name: &CStr,
        token: &CStr,
        resources: &CStr,
        logging: bool,
        message_log: &Arc<MessageLog>,
    ) -> Option<Box<dyn Component>> {
        let message_log = Arc::clone(message_log);
        match self {
            Self::Two(functions) => {
                fmi2::FmiTwo::instantiate(*functions, name, token, resources, logging, message_log)
                    .map(|instance| Box::new(instance) as _)
            }
            Self::Three(functions) => {
                fmi3::FmiThree::instantiate(**functions, name, token, resources, logging, message_log)
                    .map(|instance| Box::new(instance) as _)
            }
        }
    }
}
