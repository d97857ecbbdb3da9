//! What all controllers share: values, clock, start delay, the voltage that acted and the first sample are here once; a
//! controller is its table, its observer and its law.

mod observer_and_law;
mod shell;

pub use observer_and_law::{ControllerRows, ObserverAndLaw, Sample};
pub use shell::SampledController;
