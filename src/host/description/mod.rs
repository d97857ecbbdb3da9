//! `modelDescription.xml` of FMI 2.0 and FMI 3.0 in one form.

mod attributes;
mod document;
mod elements;
mod fmi2;
mod fmi3;
mod model_description;
mod parsing;

pub use model_description::{CoSimulation, DefaultExperiment, EnumerationItem, ModelDescription};
