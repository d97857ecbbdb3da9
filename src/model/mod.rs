//! What is exported: per model its variable table, and how plant, observer and law are wired and sampled.
//! Knows nothing of FMI.

pub mod choice;
mod closed_loop;
pub mod continuous;
pub mod continuous_plant;
pub mod controller_choices;
pub mod description;
pub mod edition;
mod end_stop_events;
mod levitated_ball;
mod levitated_ball_controller;
mod levitated_ball_plant;
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
#[macro_use]
mod registry;
pub mod sample_clock;
pub mod sampled;
pub mod sampled_controller;
pub mod sensor;
pub mod start_delay;
pub mod start_values;
#[cfg(feature = "tools")]
pub mod structure;
pub mod system;
mod token;
pub mod unit_of_measure;
pub mod value;
pub mod variable;
pub mod work;

use core::fmt;

pub use crate::exchange_order::ExchangeOrder;
pub use closed_loop::ClosedLoop;
pub use continuous::{ContinuousModel, ContinuousRows, Solver};
pub use description::Description;
pub use edition::Edition;
pub use levitated_ball_controller::LevitatedBallController;
pub use levitated_ball_plant::LevitatedBallPlant;
pub use maglev_rig_controller::MaglevRigController;
pub use maglev_rig_plant::MaglevRigPlant;
pub use magnetic_bearing_controller::MagneticBearingController;
pub use magnetic_bearing_plant::MagneticBearingPlant;
pub use persistence::Persistent;
#[cfg(feature = "tools")]
pub use registry::Registration;
#[cfg(feature = "added-models")]
pub use registry::{ADDED_MODELS, ADDED_SYSTEMS};
pub use registry::{ModelType, editions, editions_of, models};
pub use sampled::SampledModel;
pub use start_values::StartValues;
pub use system::System;
use thiserror::Error;
pub use token::Token;
use value::Readable;

/// Kinds of remarks a model makes while it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// Life cycle: initialised, terminated, reset.
    Events,
    /// The observer lost or regained convergence.
    Observer,
}

/// Where remarks go. Nothing is formatted or stored unless the topic is wanted.
pub trait LogSink {
    fn enabled(&self, topic: Topic) -> bool;
    fn log(&mut self, topic: Topic, message: fmt::Arguments<'_>);
}

/// Discards everything.
pub struct NullLogSink;

impl LogSink for NullLogSink {
    fn enabled(&self, _: Topic) -> bool {
        false
    }

    fn log(&mut self, _: Topic, _: fmt::Arguments<'_>) {}
}

/// Why a model refused to run; it is left as it was before the call.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ModelError {
    #[error("an input with a slope leaves its range within the step: {0}")]
    InputLeavesRange(value::ValueError),
    #[error("{name} would become {value} {unit} within the step: expected a finite number")]
    Diverged { name: &'static str, value: f64, unit: &'static str },
    #[error(
        "a step of {duration} s: expected at most {limit} s, about a second of computing with these parameters",
        duration = Readable(*duration), limit = Readable(*limit)
    )]
    StepTooLong { duration: f64, limit: f64 },
    #[error(
        "a step of {duration} s: expected at most longest_step = {limit} s",
        duration = Readable(*duration), limit = Readable(*limit)
    )]
    BeyondLongestStep { duration: f64, limit: f64 },
    #[error(
        "{first} and {second} are both {value} {unit}: expected numbers that differ by a millionth or more",
        value = Readable(*value)
    )]
    Equal { first: &'static str, second: &'static str, value: f64, unit: &'static str },
    #[error(
        "startTime = {start_time} s: expected {limit} s at most, either side of 0, to count ticks every {period} s",
        start_time = Readable(*start_time), limit = Readable(*limit)
    )]
    StartOutOfReach { start_time: f64, period: f64, limit: f64 },
    #[error("{name} = {value} {unit}: expected {expected}", value = Readable(*value))]
    Unusable { name: &'static str, value: f64, unit: &'static str, expected: &'static str },
}

impl ModelError {
    /// The longest step that is accepted \[s\], if a step was refused for its length.
    pub fn longest_step(&self) -> Option<f64> {
        match self {
            Self::StepTooLong { limit, .. } | Self::BeyondLongestStep { limit, .. } => Some(*limit),
            _ => None,
        }
    }
}

/// An exported model: a flat array of values, indexed by value reference, and what it takes to advance them.
///
/// Models are plain memory: no pointers, no resources; a clone continues bit for bit like the original, and so does
/// one that went through bytes ([`Persistent`]).
pub trait Model: Persistent + Send {
    fn description(&self) -> &'static Description;

    /// Values by value reference; [`TIME`] is kept by the caller.
    fn values(&self) -> &[f64];

    /// Values to set; the caller has checked them with [`variable::Variable::check`].
    fn values_mut(&mut self) -> &mut [f64];

    /// Takes over tunable parameters that were set since the last step; initialisation does so, too.
    fn apply_tunable_parameters(&mut self);

    /// Whether the parameters fit together. Asked when they are all set, which is at the start, when tunable ones were set
    /// since, and when they come from a file: in between an importer may be about to set another one.
    fn check_parameters(&self) -> Result<(), ModelError> {
        Ok(())
    }

    /// Computes all calculated values and the internal state from parameters and inputs at `start_time` \[s\].
    /// May be called again after a parameter changed, until the first [`Model::advance`].
    fn initialise(&mut self, start_time: f64) -> Result<(), ModelError>;

    /// As [`Model::initialise`], with the parameters that the model is to run with: refused if they do not fit together.
    fn start(&mut self, start_time: f64) -> Result<(), ModelError> {
        self.check_parameters()?;
        self.initialise(start_time)
    }

    /// Whether [`Model::advance`] would refuse a step over `duration` \[s\] for its length.
    fn check_step(&self, duration: f64) -> Result<(), ModelError>;

    /// Lets `duration` \[s\], positive and finite, pass with the present inputs held.
    fn advance(&mut self, duration: f64, sink: &mut dyn LogSink) -> Result<(), ModelError>;

    /// The model as one that acts at ticks, if it is: exactly those are whose description says so.
    fn sampled(&mut self) -> Option<&mut dyn SampledModel> {
        None
    }

    /// The model as one that an importer may integrate, if it is.
    fn continuous(&mut self) -> Option<&mut dyn ContinuousModel> {
        None
    }

    /// Whether what the model has computed from its parameters still belongs to them, if it is initialised, and whether
    /// what nobody checks when it is used can be used. Asked of models read from bytes only, which anybody may have written;
    /// a model answers for whatever could make it panic or compute without end.
    fn is_consistent(&self, is_initialised: bool) -> bool {
        let _ = is_initialised;
        true
    }
}

/// Largest number of rows of a table.
pub const LARGEST_TABLE: usize = 128;

/// Value reference of the simulation time, the first row of every table.
pub const TIME: usize = 0;

models! {
    MAGNETIC_BEARING_PLANT: MagneticBearingPlant = magnetic_bearing_plant;
    MAGNETIC_BEARING_CONTROLLER: MagneticBearingController = magnetic_bearing_controller;
    LEVITATED_BALL_PLANT: LevitatedBallPlant = levitated_ball_plant;
    LEVITATED_BALL_CONTROLLER: LevitatedBallController = levitated_ball_controller;
    MAGLEV_RIG_PLANT: MaglevRigPlant = maglev_rig_plant;
    MAGLEV_RIG_CONTROLLER: MaglevRigController = maglev_rig_controller;
}
