//! Tells the command line when the sources were committed, so that packages built from one commit are identical.

use std::path::Path;
use std::process::Command;

/// 1980-01-01T00:00:00Z, the earliest time an archive can hold; stands for "no commit".
const NO_COMMIT: &str = "315532800";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let time = commit_time().unwrap_or_else(|| NO_COMMIT.to_owned());
    println!("cargo::rustc-env=MAGLEV_FMU_COMMIT_TIME={time}");
}

/// Seconds since 1970 of the commit that is checked out; `None` without git, or if a repository around this
/// directory knows nothing of it, as for unpacked sources.
fn commit_time() -> Option<String> {
    git(&["ls-files", "--error-unmatch", "Cargo.toml"])?;
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for name in ["HEAD", "logs/HEAD", "packed-refs"].into_iter().chain(branch.as_deref()) {
        if let Some(path) = git(&["rev-parse", "--git-path", name])
            && Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    git(&["log", "-1", "--format=%ct"])
}

/// Output of a git command in this directory, trimmed, if the command went well and said something.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}
