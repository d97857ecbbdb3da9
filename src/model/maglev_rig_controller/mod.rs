//! Exported model `MaglevRigController`: extended state observers and control laws as a sampled-data system.

mod observer_and_law;
mod parameters;
mod table;

use super::sampled_controller::SampledController;
use observer_and_law::RigObserverAndLaw;
pub use table::DESCRIPTION;

/// The controller as a model.
pub type MaglevRigController = SampledController<RigObserverAndLaw, { table::COUNT }>;
