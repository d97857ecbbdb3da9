//! The files that are generated from the variable tables are up to date.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use maglev_fmu::package::{Form, describe, generated_files};

const RENEW: &str = "renew it with `cargo run -- describe`";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn generated_files_are_up_to_date() {
    for (path, text) in generated_files() {
        let checked_in = fs::read_to_string(root().join(&path)).unwrap_or_default();
        // A checkout may have changed the ends of lines.
        assert!(
            checked_in.replace("\r\n", "\n") == text,
            "{} is not what models/src/model says: {RENEW}",
            path.display()
        );
    }
}

#[test]
fn no_generated_file_is_left_over() {
    let expected: BTreeSet<PathBuf> = generated_files().into_iter().map(|(path, _)| path).collect();
    let folders: BTreeSet<&Path> = expected.iter().filter_map(|path| path.parent()).collect();
    assert_eq!(folders.len(), Form::ALL.len() + 1, "{folders:?}");
    for folder in folders {
        for file in fs::read_dir(root().join(folder)).unwrap() {
            let path = folder.join(file.unwrap().file_name());
            assert!(expected.contains(&path), "{} describes no model: delete it", path.display());
        }
    }
}

#[test]
fn describe_writes_what_is_checked_in() {
    let directory = tempfile::tempdir().unwrap();
    let written = describe(directory.path()).unwrap();
    let expected = generated_files();
    assert_eq!(written.len(), expected.len());
    for (path, text) in expected {
        assert_eq!(fs::read_to_string(directory.path().join(path)).unwrap(), text);
    }
}
