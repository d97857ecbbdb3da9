//! Exported model `MaglevRigPlant`: ball, coil with its driver, position sensor and end stops.

mod equations;
mod table;

use super::continuous_plant::ContinuousPlant;
use equations::MaglevRigEquations;
pub use table::DESCRIPTION;

/// The plant as a model.
pub type MaglevRigPlant = ContinuousPlant<MaglevRigEquations, { table::COUNT }, 2, 2>;
