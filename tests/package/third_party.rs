//! The list of the crates in the shared library is complete and up to date.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use maglev_fmu::package::{STANDARD_LIBRARY_CRATES, THIRD_PARTY_PATH, ThirdPartyError, third_party};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Names and versions of what the library is linked with, as another command of Cargo tells them.
fn linked() -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .current_dir(root())
        .args([
            "tree",
            "--locked",
            "--package",
            "maglev-models",
            "--edges",
            "normal,no-proc-macro",
            "--target",
            "all",
        ])
        .args(["--prefix", "none", "--no-dedupe", "--format", "{p}"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = String::from_utf8(output.stdout).unwrap();
    let crates = lines.lines().filter(|line| !line.starts_with("maglev-models "));
    crates
        .map(|line| line.split_whitespace().take(2).collect::<Vec<_>>().join(" ").replace(" v", " "))
        .collect()
}

#[test]
fn list_is_up_to_date() {
    let checked_in = fs::read_to_string(root().join(THIRD_PARTY_PATH)).unwrap().replace("\r\n", "\n");
    assert!(
        checked_in == third_party(root()).unwrap(),
        "{THIRD_PARTY_PATH} is not what Cargo.lock says: renew it with `cargo run -- describe`"
    );
}

#[test]
fn every_linked_crate_is_listed_with_a_text() {
    let text = fs::read_to_string(root().join(THIRD_PARTY_PATH)).unwrap().replace("\r\n", "\n");
    let (list, texts) = text.split_once("\n\n\n").unwrap();
    let linked = linked();
    assert!(linked.len() > 15, "{linked:?}");
    // Rows begin with a name, their second lines with spaces.
    let rows = list.split("\n\n").last().unwrap().lines().filter(|line| !line.starts_with(' '));
    let listed: BTreeSet<String> = rows
        .map(|row| row.split("  ").next().unwrap().to_owned())
        .filter(|row| !row.starts_with("Rust "))
        .collect();
    assert_eq!(listed, linked);
    // A title names the crates that a text belongs to.
    let lines: Vec<&str> = texts.lines().collect();
    let titles = lines.windows(2).filter(|pair| pair[1].len() == pair[0].len() && pair[1].starts_with("---"));
    let with_text: BTreeSet<String> = titles
        .flat_map(|pair| pair[0].split(", ").map(str::to_owned))
        .filter(|name| !name.starts_with("Rust "))
        .collect();
    assert_eq!(with_text, linked);
    assert!(texts.contains("Permission is hereby granted") && texts.contains("Apache License"));
}

/// Guards: code that comes with the compiler and stands in no tree of dependencies. The program has the same part of the
/// standard library as the shared one, and where it was compiled stands in its messages.
#[test]
fn crates_within_the_standard_library_are_listed() {
    const PLACE: &[u8] = b"/rust/deps/";
    let program = fs::read(env!("CARGO_BIN_EXE_maglev-fmu")).unwrap();
    let found: BTreeSet<String> = program
        .windows(PLACE.len())
        .enumerate()
        .filter(|(_, window)| *window == PLACE)
        .map(|(place, _)| {
            let rest = &program[place + PLACE.len()..];
            let end = rest.iter().position(|byte| *byte == b'/').unwrap();
            let name = String::from_utf8_lossy(&rest[..end]).into_owned();
            name.rsplit_once('-').expect("a version").0.to_owned()
        })
        .collect();
    assert!(found.contains("rustc-demangle"), "{found:?}");
    let text = fs::read_to_string(root().join(THIRD_PARTY_PATH)).unwrap();
    for name in found {
        assert!(text.contains(&format!("Rust standard library: {name} ")), "{name}");
    }
}

/// Guards: a crate that leaves no trace in messages. Whatever the compiler brings along in compiled form may be linked, but for
/// what tests and macros are made with.
#[test]
fn every_crate_beside_the_standard_library_is_listed() {
    const OF_THE_RUST_PROJECT: [&str; 14] = [
        "alloc",
        "compiler_builtins",
        "core",
        "panic_abort",
        "panic_unwind",
        "proc_macro",
        "profiler_builtins",
        "rustc_std_workspace_alloc",
        "rustc_std_workspace_core",
        "rustc_std_workspace_std",
        "std",
        "std_detect",
        "sysroot",
        "unwind",
    ];
    const OF_TESTS_AND_MACROS: [&str; 3] = ["getopts", "rustc_literal_escaper", "test"];
    let compiler = std::env::var("RUSTC").unwrap_or("rustc".to_owned());
    let output = Command::new(compiler).args(["--print", "target-libdir"]).output().unwrap();
    let directory = String::from_utf8(output.stdout).unwrap();
    let names: BTreeSet<String> = fs::read_dir(directory.trim())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|file| {
            Some(file.strip_suffix(".rlib")?.strip_prefix("lib")?.rsplit_once('-')?.0.to_owned())
        })
        .collect();
    assert!(names.contains("std") && names.contains("memchr"), "{names:?}");
    let listed = STANDARD_LIBRARY_CRATES.map(|(name, ..)| name.replace('-', "_"));
    let is_known = |name: &str| {
        OF_THE_RUST_PROJECT.contains(&name)
            || OF_TESTS_AND_MACROS.contains(&name)
            || listed.iter().any(|known| known == name)
    };
    let missing: Vec<_> = names.iter().filter(|name| !is_known(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn sources_without_a_manifest_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    assert!(matches!(third_party(directory.path()), Err(ThirdPartyError::Dependencies(_))));
}
