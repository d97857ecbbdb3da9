//! From a model's variable table to a functional mock-up unit: model description, documentation, icon, archive; from the
//! table of systems to system structure packages; and from both to the pages in `docs/models`.
//!
//! Everything here is written from the tables that the shared library is built from, never by loading the library,
//! so models for another platform can be packaged as well.

mod archive;
mod building;
pub mod capabilities;
mod contents;
mod documentation;
mod error;
mod generated_files;
mod generation_time;
mod icon;
mod library;
mod licenses;
mod loop_diagram;
mod markdown;
mod model_description;
mod model_page;
mod platform;
mod reference_run;
mod registration;
mod related_files;
mod run_figure;
mod system_structure;
mod terminal;
mod third_party;
mod variable_text;
mod xml;

pub use crate::file::WrittenFile;
pub use crate::fmi::{FmiVersion, Form};
pub use archive::archive;
pub use building::{build, build_with};
pub use capabilities::Capabilities;
pub use contents::{Entry, contents};
pub use error::PackageError;
pub use generated_files::{describe, describe_third_party, generated_files};
pub use generation_time::GenerationTime;
pub use icon::{icon_png, icon_svg};
pub use library::Library;
pub use model_description::model_description;
pub use platform::Platform;
pub use reference_run::{ReferenceRun, Table};
pub use registration::dependencies;
pub use related_files::{DIRECTORY as RELATED_FILES, INPUT as REFERENCE_INPUT, OUTPUT as REFERENCE_OUTPUT};
pub use third_party::{PATH as THIRD_PARTY_PATH, STANDARD_LIBRARY_CRATES, ThirdPartyError, third_party};

pub use system_structure::{SystemForm, contents as system_contents};
