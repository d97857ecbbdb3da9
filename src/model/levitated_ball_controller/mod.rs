//! Exported model `LevitatedBallController`: sensorless observers and the feedback-linearising law as a sampled-data system.

mod observer_and_law;
mod parameters;
mod table;

use super::sampled_controller::SampledController;
use observer_and_law::BallObserverAndLaw;
pub use table::DESCRIPTION;

/// The controller as a model.
pub type LevitatedBallController = SampledController<BallObserverAndLaw, { table::COUNT }>;
