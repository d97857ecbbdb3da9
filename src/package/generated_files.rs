//! Files of the repository that are generated: model descriptions and pages in `docs/models` from the variable tables, and
//! the list of linked crates from the tree of dependencies.

use std::fs;
use std::path::{Path, PathBuf};

use super::building::write;
use super::model_page::{model_index, model_page};
use super::{Form, PackageError, THIRD_PARTY_PATH, WrittenFile, model_description, third_party};
use crate::model::{MODELS, StartValues};

/// Path below the repository's root and text of each file that is generated from the variable tables.
pub fn generated_files() -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for model in MODELS {
        let description = model.description;
        for form in Form::all_of(description) {
            let folder = Path::new("modelDescription").join(form.directory());
            let text = model_description(description, StartValues::TABLE, form, None);
            files.push((folder.join(description.name).with_extension("xml"), text));
        }
    }
    let folder = Path::new("docs").join("models");
    for model in MODELS {
        let path = folder.join(model.description.name).with_extension("md");
        files.push((path, model_page(model.description)));
    }
    files.push((folder.join("README.md"), model_index()));
    files
}

/// Writes all [`generated_files`] below `root`.
pub fn describe(root: &Path) -> Result<Vec<WrittenFile>, PackageError> {
    let mut written = Vec::new();
    for (path, text) in generated_files() {
        let path = root.join(path);
        if let Some(directory) = path.parent() {
            fs::create_dir_all(directory)
                .map_err(|source| PackageError::Write { path: directory.to_owned(), source })?;
        }
        written.push(write(path, text.as_bytes())?);
    }
    Ok(written)
}

/// Writes the list of the crates in the shared library below `root`, which holds the project's sources.
pub fn describe_third_party(root: &Path) -> Result<WrittenFile, PackageError> {
    write(root.join(THIRD_PARTY_PATH), third_party(root)?.as_bytes())
}
