//! `modelDescription.xml` of FMI 2.0 and FMI 3.0, and `terminalsAndIcons.xml`, written from a model's variable table.

mod document;
mod fmi2;
mod fmi3;
mod roles;
mod shared_elements;
mod terminals_and_icons;

pub use document::model_description;
pub(super) use roles::literal;
pub(super) use shared_elements::{base_unit, enumerations, units_of_measure};
pub(super) use terminals_and_icons::terminals_and_icons;
