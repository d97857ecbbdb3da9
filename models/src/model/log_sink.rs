//! Where models put their remarks.

use core::fmt;

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
