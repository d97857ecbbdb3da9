//! What can go wrong between a file on disk and a stepped model.

use std::fmt;
use std::path::PathBuf;

use crate::causes::printable;
use crate::fmi::Status;

use super::variable::{Kind, Storage};

/// Result of every fallible operation of the host.
pub type Result<T> = std::result::Result<T, HostError>;

/// A failed operation of the host: the action, the offending value, and what the FMU itself had to say.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The file is absent, unreadable or not a zip archive.
    #[error("cannot open the FMU {}: {reason}", path.display())]
    OpenArchive { path: PathBuf, reason: String },
    /// An entry of the archive could not be written to the temporary directory.
    #[error("cannot unpack `{}` of the FMU {}: {reason}", entry.escape_debug(), path.display())]
    Unpack { path: PathBuf, entry: String, reason: String },
    /// An entry's name points out of the directory the archive is unpacked to.
    #[error(
        "refused to unpack the FMU {}: its entry `{}` would leave the target directory",
        path.display(),
        entry.escape_debug()
    )]
    EntryEscapes { path: PathBuf, entry: String },
    /// An entry is a link, or takes the place of another one.
    #[error("refused to unpack the FMU {}: its entry `{}` {reason}", path.display(), entry.escape_debug())]
    Entry { path: PathBuf, entry: String, reason: &'static str },
    /// The FMU is larger than one of the [`super::Limits`].
    #[error("{subject}: {value}, but `Limits::{name}` = {limit}; raise it if you trust the file")]
    OverLimit { subject: String, value: String, limit: u64, name: &'static str },
    /// `modelDescription.xml` is not well-formed, or lacks something required.
    #[error("cannot read modelDescription.xml: {reason}")]
    Description { reason: String },
    /// An attribute of `modelDescription.xml` holds a value of the wrong type.
    #[error(
        "cannot read modelDescription.xml: {attribute}=\"{text}\" of {element} is not {expected}",
        element = printable(element), text = printable(text)
    )]
    Attribute { element: String, attribute: &'static str, text: String, expected: &'static str },
    /// `modelDescription.xml` gives a name, or a value reference of FMI 3.0, to two variables.
    #[error(
        "cannot read modelDescription.xml: {what} is given to two variables, {first} and {second}",
        what = printable(what), first = printable(first), second = printable(second)
    )]
    Duplicate { what: String, first: String, second: String },
    /// Neither FMI 2 nor FMI 3.
    #[error("fmiVersion \"{version}\" is not supported, only 2.0 and 3.0 are", version = printable(version))]
    UnsupportedVersion { version: String },
    /// The FMU is for model exchange or scheduled execution only.
    #[error("model `{model}` offers no co-simulation interface", model = printable(model))]
    NoCoSimulation { model: String },
    /// No shared library for the platform this program runs on.
    #[error(
        "model `{model}` has no shared library for this platform: looked for {wanted}, the FMU has {}",
        if found.is_empty() { "no binaries at all".to_owned() } else { printable(found) },
        model = printable(model)
    )]
    NoLibrary { model: String, wanted: String, found: String },
    /// The operating system refused the shared library.
    #[error("cannot load the shared library {}: {reason}", path.display())]
    LoadLibrary { path: PathBuf, reason: String },
    /// The shared library does not export a function that is needed.
    #[error(
        "the shared library of `{model}` does not export the function {function}", model = printable(model)
    )]
    MissingFunction { model: String, function: &'static str },
    /// The shared library was built for another version of the standard than its XML says.
    #[error(
        "{function} of `{model}` returned \"{reported}\", but its fmiVersion is {expected}",
        model = printable(model), reported = printable(reported)
    )]
    VersionMismatch { model: String, function: &'static str, reported: String, expected: &'static str },
    /// The FMU returned no instance.
    #[error(
        "{function} of `{model}` returned no instance for `{instance}`{}", Said(log), model = printable(model)
    )]
    Instantiate { model: String, function: &'static str, instance: String, log: Option<String> },
    /// A function returned something worse than a warning.
    #[error("{function} of instance `{instance}` returned {status}{}", Said(log))]
    Call { function: &'static str, instance: String, status: ReportedStatus, log: Option<String> },
    /// The instance returned `Fatal` before: the standard forbids any further call.
    #[error("instance `{instance}` reported a fatal error before and may not be called again")]
    Lost { instance: String },
    /// The model asked its importer to end the simulation.
    #[error("instance `{instance}` asked to terminate the simulation in the step from {time} s{}", Said(log))]
    TerminationRequested { instance: String, time: f64, log: Option<String> },
    /// There is no variable of that name.
    #[error(
        "model `{model}` has no variable `{variable}`{}",
        Suggestion(similar), model = printable(model), variable = printable(variable)
    )]
    UnknownVariable { model: String, variable: String, similar: Option<String> },
    /// The variable is an array; the host handles scalars.
    #[error(
        "variable `{variable}` of `{model}` is an array, only scalars are supported",
        model = printable(model), variable = printable(variable)
    )]
    Array { model: String, variable: String },
    /// The variable does not take values of that kind.
    #[error(
        "variable `{variable}` of instance `{instance}` is of kind {kind:?} and takes no {given}",
        variable = printable(variable)
    )]
    WrongKind { instance: String, variable: String, kind: Kind, given: &'static str },
    /// The number cannot be passed exactly: not whole, out of range, or beyond 2^53.
    #[error(
        "{value} of variable `{variable}` of instance `{instance}` has no exact counterpart in {target}",
        variable = printable(variable)
    )]
    NotRepresentable { instance: String, variable: String, value: f64, target: Storage },
    /// The enumeration has no item of that name.
    #[error(
        "variable `{variable}` of instance `{instance}` has no item `{item}`, only {known}",
        variable = printable(variable), known = printable(known)
    )]
    UnknownItem { instance: String, variable: String, item: String, known: String },
    /// A text for C may not contain a NUL character.
    #[error("the text {text:?} for `{purpose}` contains a NUL character")]
    NulInText { purpose: String, text: String },
    /// Batch access needs one value per value reference.
    #[error("batch access to instance `{instance}` with {references} value references and {values} values")]
    LengthMismatch { instance: String, references: usize, values: usize },
    /// A saved state can be used with the instance it came from only.
    #[error("the saved state was taken from another instance than `{instance}`")]
    ForeignState { instance: String },
    /// Only what a wire carries can be offset on the way.
    #[error("no wire leads to `{variable}` of `{model}`", variable = printable(variable))]
    NoWire { model: String, variable: String },
    /// A master knows a `controller` and a `plant`, nothing else.
    #[error(
        "cannot record `{variable}` of `{model}`: the models of the loop are `controller` and `plant`",
        variable = printable(variable)
    )]
    UnknownModel { model: String, variable: String },
    /// A run can append only to a trace with the columns that the loop records.
    #[error("the trace has the columns [{trace}], the loop records [{recorded}]")]
    ForeignTrace { trace: String, recorded: String },
    /// A communication step has to be finite and positive.
    #[error("communication step size {step_size} s is not a positive number")]
    StepSize { step_size: f64 },
    /// The loop was run before [`super::ControlLoop::initialise`].
    #[error("the loop of `{controller}` and `{plant}` was run before it was initialised")]
    LoopNotInitialised { controller: String, plant: String },
}

/// The number a function of a foreign library returned where the standard demands a status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReportedStatus(pub i32);

impl ReportedStatus {
    /// The status of the standard, `None` if the number is not one of them.
    pub fn known(self) -> Option<Status> {
        Status::from_raw(self.0)
    }
}

impl fmt::Display for ReportedStatus {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.known() {
            Some(status) => formatter.write_str(status.name()),
            None => write!(formatter, "the unknown status {}", self.0),
        }
    }
}

/// Appends the last log message, if there is one.
struct Said<'a>(&'a Option<String>);

impl fmt::Display for Said<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(text) => write!(formatter, "; its last log message: {}", printable(text)),
            None => formatter.write_str(" and logged nothing"),
        }
    }
}

/// Appends a name that differs in case or by a typing error.
struct Suggestion<'a>(&'a Option<String>);

impl fmt::Display for Suggestion<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(name) => write!(formatter, ", did you mean `{}`?", printable(name)),
            None => Ok(()),
        }
    }
}
