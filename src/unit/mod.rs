//! What is exported: per unit its variable table, and how plant, observer and law are wired and sampled.
//! Knows nothing of FMI.

mod choice;
mod closed_loop;
pub mod continuous;
pub mod continuous_plant;
mod controller_choices;
pub mod description;
pub mod edition;
mod end_stop_events;
mod levitated_ball;
mod levitated_ball_controller;
mod levitated_ball_plant;
mod longest_step;
mod maglev_rig;
mod maglev_rig_controller;
mod maglev_rig_plant;
mod magnetic_bearing;
mod magnetic_bearing_controller;
mod magnetic_bearing_plant;
pub mod memory;
pub mod persistence;

pub mod quantity;
pub mod sample_clock;
pub mod sampled;
pub mod sampled_controller;
mod sensor;
mod start_delay;
pub mod start_values;
#[cfg(feature = "tools")]
pub mod structure;
pub mod system;
mod token;
pub mod value;
pub mod variable;
pub mod work;

use core::fmt;

pub use crate::exchange_order::ExchangeOrder;
pub use closed_loop::ClosedLoop;
pub use continuous::{ContinuousRows, ContinuousUnit, Solver};
pub use description::Description;
pub use edition::Edition;
pub use levitated_ball_controller::LevitatedBallController;
pub use levitated_ball_plant::LevitatedBallPlant;
pub use maglev_rig_controller::MaglevRigController;
pub use maglev_rig_plant::MaglevRigPlant;
pub use magnetic_bearing_controller::MagneticBearingController;
pub use magnetic_bearing_plant::MagneticBearingPlant;
use memory::{OutOfMemory, try_boxed};
pub use persistence::Persistent;
pub use sampled::SampledUnit;
pub use start_values::StartValues;
pub use system::System;
use thiserror::Error;
pub use token::Token;
use value::Readable;

/// Kinds of remarks a unit makes while it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// Life cycle: initialised, terminated, reset.
    Events,
    /// The observer lost or regained convergence.
    Observer,
}

/// Where remarks go. Nothing is formatted or stored unless the topic is wanted.
pub trait Journal {
    fn wants(&self, topic: Topic) -> bool;
    fn note(&mut self, topic: Topic, message: fmt::Arguments<'_>);
}

/// A journal that wants nothing.
pub struct Silence;

impl Journal for Silence {
    fn wants(&self, _: Topic) -> bool {
        false
    }

    fn note(&mut self, _: Topic, _: fmt::Arguments<'_>) {}
}

/// Why a unit refused to run; it is left as it was before the call.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum UnitError {
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

/// An exported unit: a flat array of values, indexed by value reference, and what it takes to advance them.
///
/// Units are plain memory: no pointers, no resources; a clone continues bit for bit like the original, and so does
/// one that went through bytes ([`Persistent`]).
pub trait Unit: Persistent + Send {
    fn description(&self) -> &'static Description;

    /// Values by value reference; [`TIME`] is kept by the caller.
    fn values(&self) -> &[f64];

    /// Values to set; the caller has checked them with [`variable::Variable::check`].
    fn values_mut(&mut self) -> &mut [f64];

    /// Takes over tunable parameters that were set since the last step; initialisation does so, too.
    fn adopt_parameters(&mut self);

    /// Whether the parameters fit together. Asked when they are all set, which is at the start, when tunable ones were set
    /// since, and when they come from a file: in between an importer may be about to set another one.
    fn check_parameters(&self) -> Result<(), UnitError> {
        Ok(())
    }

    /// Computes all calculated values and the internal state from parameters and inputs at `start_time` \[s\].
    /// May be called again after a parameter changed, until the first [`Unit::advance`].
    fn initialise(&mut self, start_time: f64) -> Result<(), UnitError>;

    /// As [`Unit::initialise`], with the parameters that the unit is to run with: refused if they do not fit together.
    fn start(&mut self, start_time: f64) -> Result<(), UnitError> {
        self.check_parameters()?;
        self.initialise(start_time)
    }

    /// Lets `duration` \[s\], positive and finite, pass with the present inputs held.
    fn advance(&mut self, duration: f64, journal: &mut dyn Journal) -> Result<(), UnitError>;

    /// The unit as one that acts at ticks, if it is: exactly those are whose description says so.
    fn sampled(&mut self) -> Option<&mut dyn SampledUnit> {
        None
    }

    /// The unit as one that an importer may integrate, if it is.
    fn continuous(&mut self) -> Option<&mut dyn ContinuousUnit> {
        None
    }

    /// Whether what the unit has computed from its parameters still belongs to them, if it is initialised, and whether
    /// what nobody checks when it is used can be used. Asked of units read from bytes only, which anybody may have written;
    /// a unit answers for whatever could make it panic or compute without end.
    fn is_consistent(&self, is_initialised: bool) -> bool {
        let _ = is_initialised;
        true
    }
}

/// Largest number of rows of a table.
pub const LARGEST_TABLE: usize = 128;

/// Value reference of the simulation time, the first row of every table.
pub const TIME: usize = 0;

/// A unit that can be made from nothing but its table.
#[derive(Debug)]
pub struct UnitType {
    pub description: &'static Description,
    pub create: fn() -> Box<dyn Unit>,
    /// As `create`, for a library whose host goes on when memory runs out.
    pub try_create: fn() -> Result<Box<dyn Unit>, OutOfMemory>,
}

impl UnitType {
    const fn of<U: Unit + Default + 'static>(description: &'static Description) -> Self {
        Self {
            description,
            create: || Box::new(U::default()),
            try_create: || Ok(try_boxed("a unit", U::default())?),
        }
    }
}

/// The list of all units.
macro_rules! units {
    ($($unit:ident: $model:ty = $module:ident;)*) => {
        $(pub static $unit: UnitType = UnitType::of::<$model>(&$module::DESCRIPTION);)*

        /// All units the shared library offers.
        pub static UNITS: &[&UnitType] = &[$(&$unit),*];

        /// How to find their dependencies: apart from the units, so that a shared library can do without.
        #[cfg(feature = "tools")]
        static DEPENDENCIES: &[(&UnitType, fn() -> Vec<structure::Dependencies>)] =
            &[$((&$unit, <$model as structure::Structured>::dependencies)),*];
    };
}

units! {
    MAGNETIC_BEARING_PLANT: MagneticBearingPlant = magnetic_bearing_plant;
    MAGNETIC_BEARING_CONTROLLER: MagneticBearingController = magnetic_bearing_controller;
    LEVITATED_BALL_PLANT: LevitatedBallPlant = levitated_ball_plant;
    LEVITATED_BALL_CONTROLLER: LevitatedBallController = levitated_ball_controller;
    MAGLEV_RIG_PLANT: MaglevRigPlant = maglev_rig_plant;
    MAGLEV_RIG_CONTROLLER: MaglevRigController = maglev_rig_controller;
}

/// Every unit in every edition that suits it.
pub fn editions() -> impl Iterator<Item = (&'static UnitType, Edition)> {
    let all = UNITS.iter().flat_map(|unit| Edition::ALL.map(|edition| (*unit, edition)));
    all.filter(|(unit, edition)| edition.suits(unit.description))
}

#[cfg(test)]
mod tests {
    use super::*;
    use variable::{Causality, Kind};

    #[test]
    fn tables_are_consistent() {
        for unit in UNITS {
            let variables = unit.description.variables;
            assert!(variables.len() <= LARGEST_TABLE, "{}", unit.description.name);
            assert_eq!(variables[TIME].causality, Causality::Independent, "{}", unit.description.name);
            for (reference, variable) in variables.iter().enumerate() {
                let name = variable.name;
                assert_eq!(
                    unit.description.find(name).map(|(found, _)| found),
                    Some(reference),
                    "{name} twice"
                );
                assert!(!variable.description.is_empty(), "{name} has no description");
                assert!(variable.is_calculated() || variable.check(variable.start).is_ok(), "{name} start");
                for source in variable.initially_from {
                    assert!(unit.description.find(source).is_some(), "{name}: unknown {source}");
                }
                if matches!(variable.kind, Kind::Integer) && !variable.is_calculated() {
                    assert!(
                        variable.range.0 >= i32::MIN.into() && variable.range.1 <= i32::MAX.into(),
                        "{name}"
                    );
                }
            }
            let mut made = (unit.create)();
            assert_eq!(made.values().len(), variables.len());
            assert_eq!(made.sampled().is_some(), unit.description.is_sampled(), "{}", unit.description.name);
        }
    }

    #[test]
    fn tokens_differ() {
        let tokens: Vec<_> = editions().map(|(unit, edition)| edition.token(unit.description)).collect();
        for (index, token) in tokens.iter().enumerate() {
            assert!(!tokens[..index].contains(token), "{token:?}");
        }
    }
}
