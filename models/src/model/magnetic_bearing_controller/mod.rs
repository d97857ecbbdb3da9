//! Exported model `MagneticBearingController`: observers and control laws as a sampled-data system.

mod observer_and_law;
mod parameters;
mod table;

pub use observer_and_law::MagneticBearingController;
pub use table::DESCRIPTION;
