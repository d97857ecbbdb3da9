//! Exported model `MagneticBearingPlant`: the bearing, a position sensor and, for studies, process noise.

mod equations;
mod table;

use super::continuous_plant::ContinuousPlant;
use equations::MagneticBearingEquations;
pub use table::DESCRIPTION;

/// The plant as a model.
pub type MagneticBearingPlant = ContinuousPlant<MagneticBearingEquations, { table::COUNT }, 3, 1>;
