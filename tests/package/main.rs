//! Packages and the commands that write them: descriptions, archives, systems, and what is refused.

mod archive;
mod built_packages;
mod command_line;
mod descriptions;
mod documents;
mod library;
mod library_file;
mod model_description;
mod model_structure;
mod reference_runs;
mod related_files;
mod start_values;
mod system_models;
mod systems;
mod third_party;
mod variable_descriptions;
mod xml;
