//! What all plants share: values, sensor, slopes of inputs, contact, events, derivatives and dependencies are here once; a
//! plant is its table and its equations.

mod differentiation;
mod equations;
mod evaluation;
mod shell;
mod tracing;

pub use equations::{Motion, PlantEquations, ProcessNoise, SensorRows};
pub use shell::ContinuousPlant;
