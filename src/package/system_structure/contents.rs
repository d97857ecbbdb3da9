//! The files of the package of a system.

use super::component::Component;
use super::description::system_structure_description;
use super::form::SystemForm;
use super::page::page;
use super::parameters::parameter_set;
use crate::model::system::System;
use crate::model::{Description, StartValues};
use crate::package::contents::{Entry, owned};
use crate::package::loop_diagram::diagram_name;
use crate::package::loop_diagram::loop_diagram;
use crate::package::{self, Form, GenerationTime, Library, PackageError, archive};

/// All files of the package of one system, sorted by path. `start_values` are those that somebody wants other than
/// the system's.
pub fn contents(
    system: &'static System,
    form: SystemForm,
    start_values: &[(&'static Description, StartValues)],
    time: GenerationTime,
    libraries: &[Library],
) -> Result<Vec<Entry<'static>>, PackageError> {
    let wanted = |description: &'static Description| {
        let own = start_values.iter().find(|(model, _)| std::ptr::eq(*model, description));
        own.map_or(StartValues::TABLE, |(_, values)| values)
    };
    let step_size = system.step_size_with(wanted(system.controller.description));
    let structure = system_structure_description(system, form, step_size, time);
    let mut entries = vec![
        Entry::document("SystemStructure.ssd".to_owned(), owned(structure)),
        Entry::document("documentation/index.html".to_owned(), owned(page(system, form, step_size, time))),
        Entry::document(
            format!("documentation/{}", diagram_name(system.name)),
            owned(loop_diagram(system, None)),
        ),
    ];
    for component in Component::all_of(system) {
        let description = component.model.description;
        let values = system
            .start_values_with(description, wanted(description))
            .map_err(|source| PackageError::SystemStart { system: system.name, source })?;
        let model = model_package(description, &values, form.of_models(), time, libraries)?;
        entries.push(Entry::document(component.model_path(), model.into()));
        let parameters = parameter_set(system, description, &values, form, time);
        entries.push(Entry::document(component.parameters_path(), owned(parameters)));
    }
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(entries)
}

/// The package of a model as it goes into a system.
fn model_package(
    description: &'static Description,
    start_values: &StartValues,
    form: Form,
    time: GenerationTime,
    libraries: &[Library],
) -> Result<Vec<u8>, PackageError> {
    let entries = package::contents(description, start_values, form, time, libraries)?;
    let path = || std::path::Path::new(description.name).with_extension("fmu");
    archive(&entries, time).map_err(|source| PackageError::Archive { path: path(), source })
}
