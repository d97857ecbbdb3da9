//! Exported model `LevitatedBallPlant`: ball and coil between two stops, and a current sensor.

mod equations;
mod table;

pub use equations::LevitatedBallPlant;
pub use table::DESCRIPTION;
