//! Exported model `MagneticBearingPlant`: the bearing, a position sensor and, for studies, process noise.

mod equations;
mod table;

pub use equations::MagneticBearingPlant;
pub use table::DESCRIPTION;
