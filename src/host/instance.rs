//! One running model, the same for both versions of the standard.

use std::cell::Cell;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::component::{Answer, Component, Refusal};
use super::description::ModelDescription;
use super::error::{HostError, Result};
use super::loaded::Loaded;
use super::message_log::{LogMessage, MessageLog};
use super::refusal::{Subject, error_of};
use super::value::Handle;
use super::variable::Kind;
use crate::fmi::Status;

/// Whether an instance is asked to log; it may report errors in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Logging {
    Off,
    On,
}

/// What has to be known to end an instance properly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Everything but the two below.
    Idle,
    /// Between `exit_initialisation` and `terminate`.
    Stepping,
    /// Fatal was returned: no more calls, not even to free it.
    Lost,
}

/// One co-simulation instance; terminated and freed when dropped.
///
/// It may move between threads, and keeps the library and the unpacked files of its [`super::Fmu`] alive.
/// The order of calls is left to the FMU to judge: a wrong one comes back as [`HostError::Call`].
pub struct Instance {
    name: String,
    pub(super) component: Box<dyn Component>,
    pub(super) message_log: Arc<MessageLog>,
    phase: Cell<Phase>,
    /// Tells instances apart, so that a saved state cannot get into the wrong one.
    pub(super) identity: u64,
    /// A state was saved, so the model has to expect a return to it.
    pub(super) may_go_back: bool,
    // Last, hence dropped last.
    loaded: Arc<Loaded>,
}

// The host promises this to its users, whatever the fields become.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<Instance>();
};

impl Instance {
    pub(super) fn new(
        name: String,
        component: Box<dyn Component>,
        message_log: Arc<MessageLog>,
        loaded: Arc<Loaded>,
    ) -> Self {
        static NEXT_IDENTITY: AtomicU64 = AtomicU64::new(0);
        let identity = NEXT_IDENTITY.fetch_add(1, Ordering::Relaxed);
        let phase = Cell::new(Phase::Idle);
        Self { name, component, message_log, phase, identity, may_go_back: false, loaded }
    }

    /// The name given at instantiation.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What `modelDescription.xml` says.
    pub fn description(&self) -> &ModelDescription {
        &self.loaded.description
    }

    /// What the model logged so far, oldest first; only the last 10 000 messages are kept.
    pub fn log(&self) -> Vec<LogMessage> {
        self.message_log.messages()
    }

    /// Forgets the messages logged so far.
    pub fn clear_log(&self) {
        self.message_log.clear();
    }

    /// Resolves a scalar variable once, so that it can be accessed often.
    ///
    /// # Errors
    /// [`HostError::UnknownVariable`] or [`HostError::Array`].
    pub fn variable(&self, name: &str) -> Result<Handle> {
        let variable = self.description().variable(name)?;
        if variable.is_array {
            return Err(HostError::Array {
                model: self.description().model_name.clone(),
                variable: name.to_owned(),
            });
        }
        Ok(Handle {
            value_reference: variable.value_reference,
            kind: variable.kind,
            storage: variable.storage,
        })
    }

    /// Sets a numeric or boolean (0 or 1) variable, in the unit the description gives to it.
    ///
    /// # Errors
    /// [`HostError::NotRepresentable`] if the variable cannot hold the value exactly (a `Float32` rounds),
    /// [`HostError::WrongKind`] for strings, and [`HostError::Call`].
    pub fn set(&mut self, handle: Handle, value: f64) -> Result<()> {
        self.usable()?;
        let answer = self.component.set_number(handle.storage, handle.value_reference, value);
        self.explain(answer, || self.describe(handle))
    }

    /// The value of a numeric or boolean (0 or 1) variable, in the unit the description gives to it.
    ///
    /// # Errors
    /// As [`Instance::set`]; [`HostError::NotRepresentable`] for 64 bit integers that an `f64` cannot hold.
    pub fn get(&self, handle: Handle) -> Result<f64> {
        self.usable()?;
        let answer = self.component.get_number(handle.storage, handle.value_reference);
        self.explain(answer, || self.describe(handle))
    }

    /// The value of a string variable.
    ///
    /// # Errors
    /// [`HostError::WrongKind`] for other variables, and [`HostError::Call`].
    pub fn get_text(&self, handle: Handle) -> Result<String> {
        self.usable()?;
        let answer = match handle.kind {
            Kind::String => self.component.get_text(handle.value_reference),
            _ => Err(Refusal::WrongStorage),
        };
        self.explain(answer, || self.describe(handle))
    }

    /// Sets many `Float64` variables, in one call and without allocation.
    ///
    /// # Errors
    /// [`HostError::LengthMismatch`] and [`HostError::Call`].
    #[inline]
    pub fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Result<()> {
        self.usable()?;
        self.same_length(references.len(), values.len())?;
        let answer = self.component.set_reals(references, values);
        self.explain(answer, Subject::none)
    }

    /// Reads many `Float64` variables, in one call and without allocation.
    ///
    /// # Errors
    /// [`HostError::LengthMismatch`] and [`HostError::Call`].
    #[inline]
    pub fn get_reals(&self, references: &[u32], values: &mut [f64]) -> Result<()> {
        self.usable()?;
        self.same_length(references.len(), values.len())?;
        let answer = self.component.get_reals(references, values);
        self.explain(answer, Subject::none)
    }

    /// Enters and exits initialisation: afterwards the model can step from `start_time` (both times in seconds).
    ///
    /// # Errors
    /// [`HostError::Call`].
    pub fn initialise(&mut self, start_time: f64, stop_time: Option<f64>) -> Result<()> {
        self.enter_initialisation(start_time, stop_time)?;
        self.exit_initialisation()
    }

    /// Enters initialisation mode (both times in seconds); in FMI 2.0 after setting up the experiment.
    ///
    /// # Errors
    /// [`HostError::Call`].
    pub fn enter_initialisation(&mut self, start_time: f64, stop_time: Option<f64>) -> Result<()> {
        self.usable()?;
        let answer = self.component.enter_initialisation(start_time, stop_time);
        self.explain(answer, Subject::none)
    }

    /// Leaves initialisation mode.
    ///
    /// # Errors
    /// [`HostError::Call`].
    pub fn exit_initialisation(&mut self) -> Result<()> {
        self.usable()?;
        let answer = self.component.exit_initialisation();
        self.explain(answer, Subject::none)?;
        self.phase.set(Phase::Stepping);
        Ok(())
    }

    /// Steps from `time` to `time + step_size`, both in seconds.
    ///
    /// # Errors
    /// [`HostError::Call`], and [`HostError::TerminationRequested`] if the model wants the simulation to end.
    #[inline]
    pub fn step(&mut self, time: f64, step_size: f64) -> Result<()> {
        self.usable()?;
        match self.component.step(time, step_size, self.may_go_back) {
            Err(Refusal::Termination) => Err(HostError::TerminationRequested {
                instance: self.name.clone(),
                time,
                log: self.message_log.last_text(),
            }),
            answer => self.explain(answer, Subject::none),
        }
    }

    /// Ends the simulation; values can still be read.
    ///
    /// # Errors
    /// [`HostError::Call`].
    pub fn terminate(&mut self) -> Result<()> {
        self.usable()?;
        self.phase.set(Phase::Idle);
        let answer = self.component.terminate();
        self.explain(answer, Subject::none)
    }

    /// Back to where instantiation left the model.
    ///
    /// # Errors
    /// [`HostError::Call`].
    pub fn reset(&mut self) -> Result<()> {
        self.usable()?;
        self.phase.set(Phase::Idle);
        let answer = self.component.reset();
        self.explain(answer, Subject::none)
    }

    /// Turns a refusal into an error with all names; looks up the variable only then.
    #[inline]
    pub(super) fn explain<T>(&self, answer: Answer<T>, variable: impl FnOnce() -> Subject) -> Result<T> {
        answer.map_err(|refusal| self.error(refusal, variable()))
    }

    #[cold]
    fn error(&self, refusal: Refusal, subject: Subject) -> HostError {
        if matches!(refusal, Refusal::Status { status, .. } if status == Status::Fatal as i32) {
            // No more calls, not even to free the instance.
            self.phase.set(Phase::Lost);
        }
        let (instance, log) = (self.name.clone(), self.message_log.last_text());
        error_of(refusal, subject, instance, &self.description().model_name, log)
    }

    /// The variable behind a handle.
    pub(super) fn describe(&self, handle: Handle) -> Subject {
        Subject::of(handle, self.description())
    }

    pub(super) fn wrong_kind(&self, variable: &str, kind: Kind, given: &'static str) -> HostError {
        HostError::WrongKind { instance: self.name.clone(), variable: variable.to_owned(), kind, given }
    }

    #[inline]
    pub(super) fn usable(&self) -> Result<()> {
        if self.phase.get() == Phase::Lost {
            return Err(HostError::Lost { instance: self.name.clone() });
        }
        Ok(())
    }

    #[inline]
    fn same_length(&self, references: usize, values: usize) -> Result<()> {
        if references == values {
            return Ok(());
        }
        Err(HostError::LengthMismatch { instance: self.name.clone(), references, values })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        match self.phase.get() {
            Phase::Idle => self.component.free(),
            // The status has nobody left to tell, only `Fatal` matters: it forbids to free.
            Phase::Stepping => match self.terminate() {
                Err(_) if self.phase.get() == Phase::Lost => {}
                _ => self.component.free(),
            },
            Phase::Lost => {}
        }
    }
}

impl fmt::Debug for Instance {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Instance")
            .field("name", &self.name)
            .field("model_name", &self.description().model_name)
            .finish_non_exhaustive()
    }
}
