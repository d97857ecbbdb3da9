//! A refusal of an FMU becomes an error that says who refused what.

use crate::fmi::Status;

use super::component::{Answer, Refusal};
use super::description::{Kind, Variable};
use super::error::{HostError, ReportedStatus, Result};
use super::instance::Instance;
use super::value::Handle;

/// The variable an error message is about.
pub(super) struct Subject {
    name: String,
    kind: Kind,
}

impl Subject {
    /// For calls that concern no single variable: their refusals do not mention one.
    pub(super) fn none() -> Self {
        Self { name: String::new(), kind: Kind::Other }
    }
}

impl Instance {
    /// Turns a refusal into an error with all names; looks up the variable only then.
    #[inline]
    pub(super) fn explain<T>(&self, answer: Answer<T>, variable: impl FnOnce() -> Subject) -> Result<T> {
        answer.map_err(|refusal| self.error(refusal, variable()))
    }

    #[cold]
    fn error(&self, refusal: Refusal, Subject { name, kind }: Subject) -> HostError {
        let instance = self.name().to_owned();
        match refusal {
            Refusal::Status { function, status } => {
                if status == Status::Fatal as i32 {
                    self.give_up();
                }
                let log = self.journal.last_text();
                HostError::Call { function, instance, status: ReportedStatus(status), log }
            }
            Refusal::Missing { function } => {
                HostError::MissingFunction { model: self.description().model_name.clone(), function }
            }
            Refusal::NotExact { value, target } => {
                HostError::NotRepresentable { instance, variable: name, value, target }
            }
            Refusal::WrongStorage => {
                let given = if kind == Kind::String { "number" } else { "text" };
                self.wrong_kind(&name, kind, if kind == Kind::Other { "value" } else { given })
            }
            Refusal::Termination => {
                HostError::TerminationRequested { instance, time: f64::NAN, log: self.journal.last_text() }
            }
        }
    }

    /// The variable behind a handle.
    pub(super) fn describe(&self, handle: Handle) -> Subject {
        let same = |variable: &&Variable| {
            variable.value_reference == handle.value_reference && variable.storage == handle.storage
        };
        let name = match self.description().variables.iter().find(same) {
            Some(variable) => variable.name.clone(),
            None => format!("value reference {}", handle.value_reference),
        };
        Subject { name, kind: handle.kind }
    }

    pub(super) fn wrong_kind(&self, variable: &str, kind: Kind, given: &'static str) -> HostError {
        HostError::WrongKind { instance: self.name().to_owned(), variable: variable.to_owned(), kind, given }
    }
}
