//! Exported model `MaglevRigPlant`: ball, coil with its driver, position sensor and end stops.

mod equations;
mod table;

pub use equations::MaglevRigPlant;
pub use table::DESCRIPTION;
