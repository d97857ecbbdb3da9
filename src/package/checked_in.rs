//! Files in the repository that are written from the variable tables, model descriptions and tables in the README, and
//! from the tree of dependencies.

use std::fs;
use std::path::{Path, PathBuf};

use super::{
    Form, PackageError, THIRD_PARTY_PATH, WrittenFile, model_description, replace_file, third_party,
    variable_text,
};
use crate::unit::variable::{Kind, Variable};
use crate::unit::{Description, StartValues, UNITS};

const BEGIN: &str = "<!-- variables:begin -->";
const END: &str = "<!-- variables:end -->";

/// What became of the README.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Readme {
    Written(WrittenFile),
    Missing(PathBuf),
    /// The file lacks the two comments between which the tables belong.
    NoMarkers(PathBuf),
}

/// Path below the repository's root and text of each checked-in model description.
pub fn checked_in_files() -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for unit in UNITS {
        let description = unit.description;
        for form in Form::all_of(description) {
            let folder = Path::new("modelDescription").join(form.directory());
            let text = model_description(description, StartValues::TABLE, form, None);
            files.push((folder.join(description.name).with_extension("xml"), text));
        }
    }
    files
}

/// Writes all checked-in model descriptions and the README's tables below `root`.
pub fn describe(root: &Path) -> Result<(Vec<WrittenFile>, Readme), PackageError> {
    let mut written = Vec::new();
    for (path, text) in checked_in_files() {
        let path = root.join(path);
        if let Some(directory) = path.parent() {
            fs::create_dir_all(directory)
                .map_err(|source| PackageError::Write { path: directory.to_owned(), source })?;
        }
        written.push(write(path, &text)?);
    }
    let path = root.join("README.md");
    if !path.exists() {
        return Ok((written, Readme::Missing(path)));
    }
    let old =
        fs::read_to_string(&path).map_err(|source| PackageError::Read { path: path.clone(), source })?;
    let readme = match readme_with_tables(&old) {
        Some(new) => Readme::Written(write(path, &new)?),
        None => Readme::NoMarkers(path),
    };
    Ok((written, readme))
}

/// Writes the list of the crates in the shared library below `root`, which holds the project's sources.
pub fn describe_third_party(root: &Path) -> Result<WrittenFile, PackageError> {
    write(root.join(THIRD_PARTY_PATH), &third_party(root)?)
}

fn write(path: PathBuf, text: &str) -> Result<WrittenFile, PackageError> {
    replace_file(&path, text.as_bytes())?;
    Ok(WrittenFile { path, size: text.len() })
}

/// A README with present tables between its markers; `None` if it lacks the markers.
pub fn readme_with_tables(readme: &str) -> Option<String> {
    let (head, rest) = readme.split_once(BEGIN)?;
    let (_, tail) = rest.split_once(END)?;
    let tables: String = UNITS.iter().map(|unit| table(unit.description)).collect();
    Some(format!("{head}{BEGIN}\n{tables}\n{END}{tail}"))
}

/// The variables of a unit as a Markdown section.
fn table(description: &Description) -> String {
    let mut text = format!(
        "\n### {}\n\n{}.\n\n| Variable | Kind | Unit | Start | Description |\n| --- | --- | --- | --- | --- |\n",
        description.name, description.summary
    );
    for variable in description.variables {
        text += &format!(
            "| `{}` | {} | {} | {} | {} |\n",
            variable.name,
            variable_text::kind(variable),
            variable_text::unit(variable),
            variable_text::start(variable, variable.start),
            meaning(variable).replace('|', "\\|"),
        );
    }
    text
}

/// The description, with the items to choose from.
fn meaning(variable: &Variable) -> String {
    let Kind::Enumeration(enumeration) = variable.kind else { return variable.description.to_owned() };
    let items: Vec<String> = enumeration.items.iter().map(|(name, _)| format!("`{name}`")).collect();
    format!("{}: {}", variable.description, items.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_replace_what_is_between_the_markers() {
        let readme = format!("# Title\n\n{BEGIN}\nstale rows\n{END}\n\nMore.\n");
        let renewed = readme_with_tables(&readme).unwrap();
        assert!(renewed.starts_with("# Title\n\n") && renewed.ends_with("\n\nMore.\n"));
        assert!(!renewed.contains("stale rows"));
        assert!(renewed.contains("| `observer.kind` | parameter | enumeration | newton |"));
        assert!(renewed.contains("epsilon x3 + x3 \\|x3\\| |"));
        assert_eq!(readme_with_tables(&renewed).as_deref(), Some(renewed.as_str()));
        assert_eq!(readme_with_tables("no markers"), None);
    }

    #[test]
    fn a_readme_without_markers_is_left_alone() {
        let root = tempfile::tempdir().unwrap();
        let readme = root.path().join("README.md");
        assert_eq!(describe(root.path()).unwrap().1, Readme::Missing(readme.clone()));
        fs::write(&readme, "text").unwrap();
        assert_eq!(describe(root.path()).unwrap().1, Readme::NoMarkers(readme.clone()));
        assert_eq!(fs::read_to_string(&readme).unwrap(), "text");
    }
}
