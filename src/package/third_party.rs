//! `THIRD-PARTY.txt`: the crates that are linked into the shared library, with the texts of their licences.
//!
//! Written from the tree of dependencies as Cargo resolves it, and from the texts as the crates carry them, so that it
//! is complete whatever comes in by way of others.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package, PackageId, TargetKind};
use spdx::{Expression, ParseMode};
use thiserror::Error;

use super::licenses;

/// Place of the manifest of the library in the repository.
const LIBRARY_MANIFEST: &str = "models/Cargo.toml";

/// Place of the file in the repository.
pub const PATH: &str = "assets/licenses/THIRD-PARTY.txt";

/// Licences under which the library takes crates, the preferred one first, and the names of the files in crates that
/// hold their texts, those of crates with one licence last.
const ACCEPTED: [(&str, &[&str]); 2] = [
    ("MIT", &["LICENSE-MIT", "LICENSE", "LICENSE.txt", "LICENSE.md"]),
    ("Apache-2.0", &["LICENSE-APACHE", "LICENSE", "LICENSE.txt", "LICENSE.md"]),
];

/// Part of every library, and of no tree of dependencies.
const STANDARD_LIBRARY: Crate<'_> = Crate {
    name: Cow::Borrowed("Rust standard library"),
    version: String::new(),
    declared: "MIT OR Apache-2.0",
    license: "MIT",
    repository: "https://github.com/rust-lang/rust",
};
const STANDARD_LIBRARY_COPYRIGHT: &str = "Copyright (c) The Rust Project Contributors";

/// Crates that the standard library brings along in compiled form, which no tree of dependencies has either; their versions
/// are those of the compiler that built the library.
pub const STANDARD_LIBRARY_CRATES: [(&str, &str, &str); 10] = [
    ("addr2line", "Apache-2.0 OR MIT", "https://github.com/gimli-rs/addr2line"),
    ("adler2", "0BSD OR MIT OR Apache-2.0", "https://github.com/oyvindln/adler2"),
    ("cfg-if", "MIT OR Apache-2.0", "https://github.com/rust-lang/cfg-if"),
    ("gimli", "MIT OR Apache-2.0", "https://github.com/gimli-rs/gimli"),
    ("hashbrown", "MIT OR Apache-2.0", "https://github.com/rust-lang/hashbrown"),
    ("libc", "MIT OR Apache-2.0", "https://github.com/rust-lang/libc"),
    ("memchr", "Unlicense OR MIT", "https://github.com/BurntSushi/memchr"),
    ("miniz_oxide", "MIT OR Zlib OR Apache-2.0", "https://github.com/Frommi/miniz_oxide"),
    ("object", "Apache-2.0 OR MIT", "https://github.com/gimli-rs/object"),
    ("rustc-demangle", "MIT/Apache-2.0", "https://github.com/rust-lang/rustc-demangle"),
];
/// Licence under which those are taken that allow it, and words of its text. Others are taken as the crates of that name in
/// the tree of dependencies are, whose texts are theirs.
const THEIR_LICENSE: (&str, &str) = ("Apache-2.0", "END OF TERMS AND CONDITIONS");

/// Why the file could not be written.
#[derive(Debug, Error)]
pub enum ThirdPartyError {
    #[error("cannot tell the tree of dependencies")]
    Dependencies(#[from] cargo_metadata::Error),
    #[error("the tree of dependencies has no root")]
    NoRoot,
    #[error(
        "no crate carries the text of the {license} licence, under which crates of the standard library are taken"
    )]
    NoSharedText { license: &'static str },
    #[error(
        "the standard library holds {name}, whose licence text no crate of that name carries: none is in the tree"
    )]
    NotInTree { name: &'static str },
    #[error("{name} {version} declares the licence {declared:?}: expected one that allows MIT or Apache-2.0")]
    License { name: String, version: String, declared: String },
    #[error("{name} {version} carries no text of its {license} licence: expected one of {expected:?} in {}", .directory.display())]
    NoText {
        name: String,
        version: String,
        license: &'static str,
        expected: &'static [&'static str],
        directory: PathBuf,
    },
}

/// A row of the list.
struct Crate<'a> {
    name: Cow<'a, str>,
    version: String,
    declared: &'a str,
    license: &'static str,
    repository: &'a str,
}

impl Crate<'_> {
    fn title(&self) -> String {
        format!("{} {}", self.name, self.version).trim_end().to_owned()
    }
}

/// Contents of the file for the sources below `root`, with the versions that `Cargo.lock` names.
pub fn third_party(root: &Path) -> Result<String, ThirdPartyError> {
    let metadata = MetadataCommand::new()
        .manifest_path(root.join(LIBRARY_MANIFEST))
        .other_options(["--locked".to_owned()])
        .exec()?;
    let mut rows = Vec::new();
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in linked_packages(&metadata)? {
        let row = row(package)?;
        texts.entry(text(package, row.license)?).or_default().push(row.title());
        rows.push(row);
    }
    // The project's own text is the common one but for whom it names.
    let standard = licenses::LICENSE.replace(licenses::COPYRIGHT, STANDARD_LIBRARY_COPYRIGHT);
    texts.entry(normalised(&standard)).or_default().push(STANDARD_LIBRARY.title());
    rows.push(STANDARD_LIBRARY);
    let (shared_license, words) = THEIR_LICENSE;
    let shared_text = texts.keys().find(|text| text.contains(words)).cloned();
    let shared_text = shared_text.ok_or(ThirdPartyError::NoSharedText { license: shared_license })?;
    for (name, declared, repository) in STANDARD_LIBRARY_CRATES {
        let (license, text) = if allows(declared, shared_license) {
            (shared_license, shared_text.clone())
        } else {
            let package = metadata.packages.iter().find(|package| package.name.as_str() == name);
            let package = package.ok_or(ThirdPartyError::NotInTree { name })?;
            let license = accepted_license(package)?;
            (license, text(package, license)?)
        };
        let name = Cow::Owned(format!("Rust standard library: {name}"));
        let row = Crate { name, version: String::new(), declared, license, repository };
        texts.entry(text).or_default().push(row.title());
        rows.push(row);
    }
    Ok(document(&rows, &texts))
}

/// The packages that the library is linked with, by name: normal dependencies of the models, but for optional ones, and
/// theirs.
/// Procedural macros run in the compiler only.
fn linked_packages(metadata: &Metadata) -> Result<Vec<&Package>, ThirdPartyError> {
    let resolve = metadata.resolve.as_ref().ok_or(ThirdPartyError::NoRoot)?;
    let root = resolve.root.as_ref().ok_or(ThirdPartyError::NoRoot)?;
    let optional = metadata[root].dependencies.iter().filter(|dependency| dependency.optional);
    let optional: BTreeSet<&str> = optional.map(|dependency| dependency.name.as_str()).collect();
    let is_linked = |id: &PackageId| {
        let package = &metadata[id];
        let is_macro = package.targets.iter().any(|target| target.kind.contains(&TargetKind::ProcMacro));
        !is_macro && !optional.contains(package.name.as_str())
    };
    let mut found = BTreeSet::new();
    let mut open = vec![root];
    while let Some(id) = open.pop() {
        let node = resolve.nodes.iter().find(|node| node.id == *id).ok_or(ThirdPartyError::NoRoot)?;
        let normal = node
            .deps
            .iter()
            .filter(|dependency| dependency.dep_kinds.iter().any(|kind| kind.kind == DependencyKind::Normal));
        open.extend(normal.map(|dependency| &dependency.pkg).filter(|id| is_linked(id) && found.insert(*id)));
    }
    let mut packages: Vec<&Package> = found.into_iter().map(|id| &metadata[id]).collect();
    packages.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    Ok(packages)
}

/// What the list says of a package.
fn row(package: &Package) -> Result<Crate<'_>, ThirdPartyError> {
    Ok(Crate {
        name: Cow::Borrowed(&package.name),
        version: package.version.to_string(),
        declared: package.license.as_deref().unwrap_or_default(),
        license: accepted_license(package)?,
        repository: package.repository.as_deref().unwrap_or_default(),
    })
}

/// The first accepted licence that the package's own allows.
fn accepted_license(package: &Package) -> Result<&'static str, ThirdPartyError> {
    let declared = package.license.as_deref().unwrap_or_default();
    let mut accepted = ACCEPTED.into_iter().map(|(license, _)| license);
    accepted.find(|license| allows(declared, license)).ok_or_else(|| ThirdPartyError::License {
        name: package.name.to_string(),
        version: package.version.to_string(),
        declared: declared.to_owned(),
    })
}

/// Whether code may be taken under `license` where its own licence is the one declared, a slash for "or" included.
fn allows(declared: &str, license: &str) -> bool {
    let wanted = spdx::license_id(license);
    let is_it = |requirement: &spdx::LicenseReq| requirement.license.id() == wanted;
    Expression::parse_mode(declared, ParseMode::LAX).is_ok_and(|expression| expression.evaluate(is_it))
}

/// The text of one of the accepted licences as the package carries it.
fn text(package: &Package, license: &'static str) -> Result<String, ThirdPartyError> {
    let directory = package.manifest_path.as_std_path().parent().unwrap_or(Path::new(""));
    let (_, names) = ACCEPTED.into_iter().find(|(known, _)| *known == license).unwrap_or_default();
    let found = names.iter().find_map(|name| fs::read_to_string(directory.join(name)).ok());
    found.map(|text| normalised(&text)).ok_or_else(|| ThirdPartyError::NoText {
        name: package.name.to_string(),
        version: package.version.to_string(),
        license,
        expected: names,
        directory: directory.to_owned(),
    })
}

/// The text without what editors leave at the ends of lines and of the file.
fn normalised(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned()
}

/// The list and, for each text, the crates under it.
fn document(rows: &[Crate<'_>], texts: &BTreeMap<String, Vec<String>>) -> String {
    let mut document = String::from(
        "\
Third-party software in the shared library
==========================================

The shared library is linked with the following Rust crates. Where a crate
offers a choice of licences (in brackets), it is used under the one in front.
The texts stand below, as the crates carry them.

",
    );
    let width = rows.iter().map(|row| row.title().len()).max().unwrap_or_default();
    for row in rows {
        let choice = if row.declared == row.license { String::new() } else { format!(" ({})", row.declared) };
        document += &format!("{:<width$}  {}{choice}\n", row.title(), row.license);
        document += &format!("{:<width$}  {}\n", "", row.repository);
    }
    let mut texts: Vec<(&String, &Vec<String>)> = texts.iter().collect();
    texts.sort_by_key(|(_, crates)| crates.first().map(|title| title.to_lowercase()));
    for (text, crates) in texts {
        let title = crates.join(", ");
        document += &format!("\n\n{title}\n{}\n\n{text}\n", "-".repeat(title.len()));
    }
    document
}
