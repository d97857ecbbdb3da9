//! The files that are written from the variable tables are up to date.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use maglev_fmu::package::{Form, checked_in_files, describe, readme_with_tables};

const RENEW: &str = "renew it with `cargo run -- describe`";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn model_descriptions_are_up_to_date() {
    for (path, text) in checked_in_files() {
        let checked_in = fs::read_to_string(root().join(&path)).unwrap_or_default();
        // A checkout may have changed the ends of lines.
        assert!(
            checked_in.replace("\r\n", "\n") == text,
            "{} is not what src/unit says: {RENEW}",
            path.display()
        );
    }
}

#[test]
fn no_model_description_is_left_over() {
    let expected: BTreeSet<PathBuf> =
        checked_in_files().into_iter().map(|(path, _)| root().join(path)).collect();
    for form in Form::ALL {
        for file in fs::read_dir(root().join("modelDescription").join(form.directory())).unwrap() {
            let path = file.unwrap().path();
            assert!(expected.contains(&path), "{} describes no unit: delete it", path.display());
        }
    }
}

#[test]
fn readme_tables_are_up_to_date() {
    let Ok(readme) = fs::read_to_string(root().join("README.md")) else { return };
    let readme = readme.replace("\r\n", "\n");
    if let Some(renewed) = readme_with_tables(&readme) {
        assert!(renewed == readme, "README.md has old tables: {RENEW}");
    }
}

#[test]
fn describe_writes_what_is_checked_in() {
    let directory = tempfile::tempdir().unwrap();
    let (written, _) = describe(directory.path()).unwrap();
    let expected = checked_in_files();
    assert_eq!(written.len(), expected.len());
    for (path, text) in expected {
        assert_eq!(fs::read_to_string(directory.path().join(path)).unwrap(), text);
    }
}
