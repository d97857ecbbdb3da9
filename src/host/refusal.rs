//! A refusal of an FMU becomes an error that says who refused what.

use super::component::Refusal;
use super::description::ModelDescription;
use super::error::{HostError, ReportedStatus};
use super::value::Handle;
use super::variable::{Kind, Variable};

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

    /// The variable behind a handle.
    pub(super) fn of(handle: Handle, description: &ModelDescription) -> Self {
        let same = |variable: &&Variable| {
            variable.value_reference == handle.value_reference && variable.storage == handle.storage
        };
        let name = match description.variables.iter().find(same) {
            Some(variable) => variable.name.clone(),
            None => format!("value reference {}", handle.value_reference),
        };
        Self { name, kind: handle.kind }
    }
}

/// The error for a `refusal` by the instance called `instance` of the model called `model`, whose last message is `log`.
#[cold]
pub(super) fn error_of(
    refusal: Refusal,
    Subject { name, kind }: Subject,
    instance: String,
    model: &str,
    log: Option<String>,
) -> HostError {
    match refusal {
        Refusal::Status { function, status } => {
            HostError::Call { function, instance, status: ReportedStatus(status), log }
        }
        Refusal::Missing { function } => HostError::MissingFunction { model: model.to_owned(), function },
        Refusal::NotExact { value, target } => {
            HostError::NotRepresentable { instance, variable: name, value, target }
        }
        Refusal::WrongStorage => {
            let given = if kind == Kind::String { "number" } else { "text" };
            let given = if kind == Kind::Other { "value" } else { given };
            HostError::WrongKind { instance, variable: name, kind, given }
        }
        Refusal::Termination => HostError::TerminationRequested { instance, time: f64::NAN, log },
    }
}
