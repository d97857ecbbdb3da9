//! System structure packages (SSP 1.0.1 and 2.0): a plant and its controller, wired, ready to run.
//!
//! Importers step both models at once and then exchange, most start their wires at zero, and few apply the parameter
//! sets that a package binds. So the start values of [`System::start_values`] are inside the packaged models, which are
//! not those that stand alone. An input is a connector only if something is connected to it, for not every importer
//! takes others. Prefixes of namespaces are those of the standard's text; not every importer
//! resolves others.

mod component;
mod connectors;
mod contents;
mod description;
mod experiment;
mod form;
mod page;
mod parameters;
mod type_definitions;

pub use contents::contents;
pub use form::SystemForm;
