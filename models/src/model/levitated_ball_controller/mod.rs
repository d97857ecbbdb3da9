//! Exported model `LevitatedBallController`: sensorless observers and the feedback-linearising law as a sampled-data system.

mod observer_and_law;
mod parameters;
mod table;

pub use observer_and_law::LevitatedBallController;
pub use table::DESCRIPTION;
