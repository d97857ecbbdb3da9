//! Why a call was refused. The instance is as it was before the call.

use super::log_categories::{CategoryList, CategoryName};
use super::{StateError, Status};
use crate::model::ModelError;
use crate::model::value::ValueError;
use thiserror::Error;

/// Refusal of a call; the boundary logs it after the function's name and returns [`CallError::status`].
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum CallError {
    #[error("not allowed in the phase \"{0}\"")]
    WrongPhase(&'static str),
    #[error(
        "ended by its callback, which has reset the instance or restored a state: it is now in the phase \"{0}\""
    )]
    LeftByCallback(&'static str),
    #[error("the argument {0} is a null pointer")]
    NullPointer(&'static str),
    #[error("{argument} = {got}: expected {expected}, one value per value reference")]
    WrongLength { argument: &'static str, got: usize, expected: usize },
    #[error("{argument} = {got}: expected {expected}")]
    WrongCount { argument: &'static str, got: usize, expected: usize },
    #[error("value reference {reference} is unknown: expected 0 to {largest}")]
    UnknownReference { reference: u32, largest: usize },
    #[error("{name} (value reference {reference}) is {is}, not {asked}")]
    WrongType { name: &'static str, reference: u32, is: &'static str, asked: &'static str },
    #[error("{name} is {why} and cannot be set in the phase \"{phase}\"")]
    NotSettable { name: &'static str, why: &'static str, phase: &'static str },
    #[error("{name} is a clock that the model itself activates: expected one that the importer activates")]
    NoInputClock { name: &'static str },
    #[error(transparent)]
    Value(#[from] ValueError),
    #[error("{argument} = {value} s: expected {expected}")]
    WrongTime { argument: &'static str, value: f64, expected: &'static str },
    #[error("currentCommunicationPoint = {got} s does not follow the last one: expected {expected} s")]
    TimeDoesNotFollow { got: f64, expected: f64 },
    #[error("{argument} = {time} s is past the stop time: expected at most {stop_time} s")]
    PastStopTime { argument: &'static str, time: f64, stop_time: f64 },
    #[error(
        "time = {got} s goes back beyond the last event or the completed step before the last: expected at least {earliest} s"
    )]
    TimeGoesBack { got: f64, earliest: f64 },
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error("{name} (value reference {reference}) is a variable, not a clock")]
    NoClock { name: &'static str, reference: u32 },
    #[error("{name} (value reference {reference}) is a clock, not {asked}")]
    IsClock { name: &'static str, reference: u32, asked: &'static str },
    #[error(
        "no tick is due at t = {now} s: expected t = {next} s, the next multiple of sample_time = {period} s"
    )]
    NoTick { now: f64, next: f64, period: f64 },
    #[error("a clock that was activated stays active until the end of the event iteration")]
    ClockStaysActive,
    #[error("activationTime = {got} s: expected a finite time after {last} s")]
    ActivationTime { got: f64, last: f64 },
    #[error(
        "{name} = {value} s is no exact ratio of 64-bit integers: expected a number of seconds such as 0.001"
    )]
    NoFraction { name: &'static str, value: f64 },
    #[error(transparent)]
    State(#[from] StateError),
    #[error("not a function of {0}, for which the instance was made")]
    WrongInterface(&'static str),
    #[error("{name} cannot be computed here: {value} {unit}")]
    NotComputable { name: &'static str, value: f64, unit: &'static str },
    #[error("{what} {name} cannot be computed here: {value}")]
    NoDerivative { what: &'static str, name: &'static str, value: f64 },
    #[error("{name} (value reference {reference}) is {is}: expected {expected}")]
    WrongRole { name: &'static str, reference: u32, is: &'static str, expected: &'static str },
    #[error("order {order} of the derivative of {name}: expected 1")]
    WrongOrder { name: &'static str, order: i32 },
    #[error("continuous state {0}")]
    StateRejected(ValueError),
    #[error("the category {0} is not declared in the model description: expected one of {categories}", categories = CategoryList)]
    UnknownCategory(CategoryName),
    #[error("not offered by this model: {0}")]
    NotOffered(&'static str),
    #[error("this function does not report the fmi2StatusKind {0}")]
    NoSuchStatus(i32),
}

impl CallError {
    /// What the refused function returns.
    pub fn status(&self) -> Status {
        match self {
            // "If a status is required which cannot be retrieved by the slave it returns fmi2Discard", FMI 2.0.5,
            // section 4.2.3.
            Self::NoSuchStatus(_) => Status::Discard,
            // The solver may try a shorter step: FMI 3.0.2, section 3.2.1 (fmi3SetContinuousStates and the getters).
            Self::StateRejected(_) | Self::NotComputable { .. } | Self::NoDerivative { .. } => {
                Status::Discard
            }
            _ => Status::Error,
        }
    }
}
