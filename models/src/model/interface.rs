//! What every exported model can do.

use super::{ContinuousModel, Description, LogSink, ModelError, Persistent, SampledModel};

/// Largest number of rows of a table.
pub const LARGEST_TABLE: usize = 128;

/// Value reference of the simulation time, the first row of every table.
pub const TIME: usize = 0;

/// An exported model: a flat array of values, indexed by value reference, and what it takes to advance them.
///
/// Models are plain memory: no pointers, no resources; a clone continues bit for bit like the original, and so does
/// one that went through bytes ([`Persistent`]).
pub trait Model: Persistent + Send {
    fn description(&self) -> &'static Description;

    /// Values by value reference; [`TIME`] is kept by the caller.
    fn values(&self) -> &[f64];

    /// Values to set; the caller has checked them with [`super::variable::Variable::check`].
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
