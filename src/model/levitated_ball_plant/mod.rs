//! Exported model `LevitatedBallPlant`: ball and coil between two stops, and a current sensor.

mod equations;
mod table;

use super::continuous_plant::ContinuousPlant;
use equations::LevitatedBallEquations;
pub use table::DESCRIPTION;

/// The plant as a model.
pub type LevitatedBallPlant = ContinuousPlant<LevitatedBallEquations, { table::COUNT }, 3, 2>;
