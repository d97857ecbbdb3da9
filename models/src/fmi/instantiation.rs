//! Making instances: what is asked for, and why there is none.

use core::ffi::CStr;
use core::fmt;

use super::message::Message;
use super::{CallError, Callback, Form, Instance, Interface, Logger, StateError, Status};
use crate::model::memory::{OutOfMemory, try_boxed};
use crate::model::start_values::{StartValues, TokenError, read_token};
use crate::model::{Description, Edition, ModelType};
use thiserror::Error;

/// What an importer asks for.
pub(super) struct Request<'a> {
    pub function: &'static str,
    pub name: Option<&'a CStr>,
    /// Selects the model and tells its start values.
    pub token: Option<&'a CStr>,
    pub callback: Callback,
    pub logging_on: bool,
    /// The name of what was asked for if no model offers it.
    pub interface: Result<Interface, &'static str>,
}

/// Why there is no instance.
#[derive(Debug, Error)]
enum InstantiationError<'a> {
    #[error("{0} is not offered")]
    UnknownInterface(&'static str),
    #[error("{0}")]
    Token(TokenError<'a>),
    #[error(
        "{name} does not offer {asked}, only {offered}{elsewhere}",
        name = .0.name, asked = .2.name(), offered = Offered(.0, *.1), elsewhere = Elsewhere(.0, *.2)
    )]
    OtherInterface(&'static Description, Edition, Interface),
    #[error(transparent)]
    Call(#[from] CallError),
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
    #[error(transparent)]
    State(#[from] StateError),
}

#[allow(clippy::result_large_err, reason = "messages lie on the stack, for there may be no heap left")]
impl Request<'_> {
    /// What is to be said of the instance when it is about to be made, or why there will be none.
    pub(super) fn announce(&self) -> Result<Message, Message> {
        let (model, ..) = self.read().map_err(|error| self.refusal(&error))?;
        Ok(self.callback.event(format_args!("{} instantiated", model.description.name)))
    }

    /// The instance with the start values in the token, or why there is none.
    pub(super) fn make(
        &self,
        configure: impl FnOnce(&mut Instance) -> Result<(), CallError>,
    ) -> Result<Box<Instance>, Message> {
        let mut instance = self.try_make().map_err(|error| self.refusal(&error))?;
        configure(&mut instance).map_err(|error| self.refusal(&error.into()))?;
        Ok(instance)
    }

    fn try_make(&self) -> Result<Box<Instance>, InstantiationError<'_>> {
        let (model, edition, start_values, interface) = self.read()?;
        let logger = Logger::new(self.callback, self.name.unwrap_or_default(), self.logging_on)?;
        let mut made = (model.try_create)()?;
        start_values.apply(&mut *made);
        let mut instance = Instance::new(made, interface, logger)?;
        instance.edition = edition;
        Ok(try_boxed("an instance", instance)?)
    }

    /// The model, its edition and start values and the interface type that are asked for.
    fn read(&self) -> Result<(&'static ModelType, Edition, StartValues, Interface), InstantiationError<'_>> {
        let interface = self.interface.map_err(InstantiationError::UnknownInterface)?;
        let token = self.token.unwrap_or_default().to_str().unwrap_or_default();
        let (model, edition, start_values) = read_token(token).map_err(InstantiationError::Token)?;
        if interface.is_offered_by(model.description, edition) {
            Ok((model, edition, start_values, interface))
        } else {
            Err(InstantiationError::OtherInterface(model.description, edition, interface))
        }
    }

    fn refusal(&self, error: &InstantiationError<'_>) -> Message {
        self.callback.refusal(Status::Error, format_args!("{}: {error}", self.function))
    }

    /// A defect came to light.
    #[cold]
    pub(super) fn failure(&self) -> Message {
        self.callback.refusal(Status::Fatal, format_args!("{}: internal error", self.function))
    }
}

/// The interface types of an edition of a model, for an error message.
struct Offered(&'static Description, Edition);

impl fmt::Display for Offered {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let offered = Interface::ALL.iter().filter(|interface| interface.is_offered_by(self.0, self.1));
        offered.enumerate().try_for_each(|(index, interface)| {
            write!(formatter, "{}{}", if index == 0 { "" } else { ", " }, interface.name())
        })
    }
}

/// Where another package of the model offers what this one does not, for an error message; nothing if none does.
struct Elsewhere(&'static Description, Interface);

impl fmt::Display for Elsewhere {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(description, interface) = self;
        let mut forms = Form::all_of(description);
        match forms.find(|form| interface.is_offered_by(description, form.edition)) {
            Some(form) => {
                let (directory, name) = (form.directory(), description.name);
                write!(formatter, "; its package {directory}/{name}.fmu does")
            }
            None => Ok(()),
        }
    }
}
