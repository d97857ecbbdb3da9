//! What is exported: per model its variable table, and how plant, observer and law are wired and sampled.
//! Knows nothing of FMI.

mod accepted_bits;
pub mod choice;
mod closed_loop;
pub mod continuous;
pub mod continuous_plant;
pub mod controller_choices;
pub mod description;
pub mod edition;
mod end_stop_events;
mod error;
mod interface;
mod levitated_ball;
mod levitated_ball_controller;
mod levitated_ball_plant;
mod log_sink;
pub mod longest_step;
mod maglev_rig;
mod maglev_rig_controller;
mod maglev_rig_plant;
mod magnetic_bearing;
mod magnetic_bearing_controller;
mod magnetic_bearing_plant;
pub mod memory;
pub mod persistence;
pub mod quantity;
mod registry;
pub mod sample_clock;
pub mod sampled;
pub mod sampled_controller;
pub mod sensor;
pub mod start_delay;
pub mod start_values;
pub mod structure;
pub mod system;
mod token;
pub mod unit_of_measure;
pub mod value;
pub mod variable;
pub mod work;

pub use crate::exchange_order::ExchangeOrder;
pub use closed_loop::ClosedLoop;
pub use continuous::{ContinuousModel, ContinuousRows, Solver};
pub use description::Description;
pub use edition::Edition;
pub use error::ModelError;
pub use interface::{LARGEST_TABLE, Model, TIME};
pub use levitated_ball_controller::LevitatedBallController;
pub use levitated_ball_plant::LevitatedBallPlant;
pub use log_sink::{LogSink, NullLogSink, Topic};
pub use maglev_rig_controller::MaglevRigController;
pub use maglev_rig_plant::MaglevRigPlant;
pub use magnetic_bearing_controller::MagneticBearingController;
pub use magnetic_bearing_plant::MagneticBearingPlant;
pub use persistence::Persistent;
#[cfg(feature = "added-models")]
pub use registry::{ADDED_MODELS, ADDED_SYSTEMS};
pub use registry::{
    LEVITATED_BALL_CONTROLLER, LEVITATED_BALL_PLANT, MAGLEV_RIG_CONTROLLER, MAGLEV_RIG_PLANT,
    MAGNETIC_BEARING_CONTROLLER, MAGNETIC_BEARING_PLANT, MODELS, ModelType, Registration, added_models,
    editions, editions_of, models,
};
pub use sampled::SampledModel;
pub use start_values::StartValues;
pub use system::System;
pub use token::Token;
