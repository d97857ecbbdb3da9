//! Every command tells when it could not write what it was asked for, on standard output and to files.

use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use object::Architecture;

use crate::library_file;

/// What a shell reports for a program that SIGPIPE has ended.
const CLOSED_PIPE: i32 = 141;

fn maglev_fmu(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maglev-fmu"));
    command.current_dir(directory).args(arguments).stdin(Stdio::null());
    command
}

/// Every command that ends soon, and help, which the parser of the command line prints.
const COMMANDS: [&[&str]; 6] = [
    &["--help"],
    &["--version"],
    &["trace", "rig", "--steps", "3"],
    &["describe"],
    &["build", "--library", "library.so"],
    &["tune", "--particles", "2", "--iterations", "1"],
];

fn directory_with_library() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let library = library_file::write_library(directory.path(), Architecture::X86_64);
    fs::rename(library, directory.path().join("library.so")).unwrap();
    directory
}

#[cfg(target_os = "linux")]
fn full() -> File {
    OpenOptions::new().write(true).open("/dev/full").unwrap()
}

/// Guards: exit status 0 and nothing printed on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let directory = directory_with_library();
    for arguments in COMMANDS {
        let output = maglev_fmu(directory.path(), arguments).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains("error: cannot write to standard output"), "{arguments:?}: {message}");
        assert!(message.contains("because: No space left on device"), "{arguments:?}: {message}");
    }
}

/// Guards: exit status 0 where standard output is a file that was opened for reading.
#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_cannot_be_written_is_an_error() {
    let directory = directory_with_library();
    for arguments in COMMANDS.iter().filter(|arguments| !arguments[0].starts_with('-')) {
        let readable = File::open("/etc/passwd").unwrap();
        let output = maglev_fmu(directory.path(), arguments).stdout(readable).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains("error: cannot write to standard output"), "{arguments:?}: {message}");
    }
}

/// Guards: a panic, hence status 101, while the error is printed.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_error_leaves_the_status() {
    let directory = tempfile::tempdir().unwrap();
    for (arguments, status) in
        [(&["build", "--library", "missing.so"], 1), (&["trace", "rig", "--nonsense"], 2)]
    {
        let status_of = maglev_fmu(directory.path(), arguments).stderr(full()).output().unwrap().status;
        assert_eq!(status_of.code(), Some(status), "{arguments:?}");
    }
}

/// Guards: `trace rig --steps 2000000000 | head -1` computed on for hours.
#[test]
fn a_closed_pipe_ends_a_run_at_once() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = ["trace", "rig", "--steps", "2000000000"];
    let mut child = maglev_fmu(directory.path(), &arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    assert!(line.starts_with("plant."), "{line}");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("still running");
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert_eq!(status.code(), Some(CLOSED_PIPE));
    let mut message = String::new();
    child.stderr.unwrap().read_to_string(&mut message).unwrap();
    assert_eq!(message, "");
}

/// A reader that is gone from the start: quiet for every command, and files are complete all the same.
#[test]
fn a_closed_pipe_is_no_error_to_talk_about() {
    let directory = directory_with_library();
    for arguments in COMMANDS {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = maglev_fmu(directory.path(), arguments).stdout(writer).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), message.as_str()), (Some(CLOSED_PIPE), ""), "{arguments:?}");
    }
    for path in
        ["dist/bearing.ssp", "results/rig-linear-paper.json", "modelDescription/fmi3/MaglevRigPlant.xml"]
    {
        assert!(directory.path().join(path).is_file(), "{path}");
    }
}

/// Guards: a file that ends within a number where the disk was full. A limit on the size of files stands for the disk.
#[test]
fn a_file_is_whole_or_the_old_one() {
    let directory = directory_with_library();
    let old = directory.path().join("modelDescription/fmi2/MaglevRigPlant.xml");
    fs::create_dir_all(old.parent().unwrap()).unwrap();
    fs::write(&old, "old").unwrap();
    for (arguments, file) in [
        ("describe", "modelDescription/fmi2/"),
        ("build --library library.so", "dist/fmi2/"),
        ("tune --particles 2 --iterations 1", "results/rig-linear-paper."),
    ] {
        let script = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" {arguments}");
        let output = Command::new("sh")
            .current_dir(directory.path())
            .args(["-c", &script, env!("CARGO_BIN_EXE_maglev-fmu")])
            .output()
            .unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}: {message}");
        assert!(message.contains("error: cannot write ") && message.contains(file), "{message}");
        assert!(message.contains("because: File too large"), "{message}");
    }
    assert_eq!(fs::read_to_string(&old).unwrap(), "old");
    for folder in ["modelDescription/fmi2", "dist/fmi2", "results"] {
        for entry in fs::read_dir(directory.path().join(folder)).unwrap() {
            assert_eq!(entry.unwrap().path(), old, "nothing but what was there");
        }
    }
}

/// Guards: pictures of a search in /dev, or beside a pipe or a link to a device.
#[cfg(target_os = "linux")]
#[test]
fn nothing_is_put_beside_a_device() {
    let directory = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink("/dev/full", directory.path().join("link.json")).unwrap();
    let pipe = Command::new("mkfifo").arg(directory.path().join("pipe.json")).status().unwrap();
    assert!(pipe.success());
    let names = |path: &Path| -> Vec<_> {
        let mut names: Vec<_> = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = [names(Path::new("/dev")), names(directory.path())];
    for (file, reason) in [
        ("/dev/full", "a directory, device or pipe"),
        ("/dev/full.json", "among devices"),
        ("/dev/../dev/full.json", "among devices"),
        ("link.json", "a directory, device or pipe"),
        ("pipe.json", "a directory, device or pipe"),
        (".", "a directory, device or pipe"),
    ] {
        let arguments = ["tune", "--particles", "2", "--iterations", "1", "--out", file];
        let output = maglev_fmu(directory.path(), &arguments).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{file}: {message}");
        assert!(message.contains(&format!("{reason}: expected a regular file")), "{message}");
    }
    assert_eq!([names(Path::new("/dev")), names(directory.path())], before);
}

/// Guards: a parameter file that took the place of its own picture.
#[test]
fn a_parameter_file_is_none_of_the_files_beside_it() {
    let directory = tempfile::tempdir().unwrap();
    for file in ["q.png", "q.svg", "q.CSV"] {
        let arguments = ["tune", "--particles", "2", "--iterations", "1", "--out", file];
        let output = maglev_fmu(directory.path(), &arguments).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{file}: {message}");
        assert!(message.contains("expected another one, such as .json"), "{message}");
    }
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
}

/// Guards: a panic in the random numbers, after some thousand iterations that were lost with it.
#[test]
fn a_diverging_search_ends_with_what_it_has() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = ["tune", "--swarm", "printed", "--iterations", "14000", "--observer", "nonlinear"];
    let output = maglev_fmu(directory.path(), &arguments).output().unwrap();
    let (said, message) =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).into();
    assert!(output.status.success(), "{message}");
    assert!(
        said.contains("The swarm has diverged: after ") && said.contains(" of 14000 iterations"),
        "{said}"
    );
    let file = fs::read(directory.path().join("results/rig-nonlinear-paper.json")).unwrap();
    let file: serde_json::Value = serde_json::from_slice(&file).unwrap();
    let iterations = file["provenance"]["iterations"].as_u64().unwrap();
    assert!(said.contains(&format!("after {iterations} of")), "{said}");
    assert!(file["values"]["observer.gain[1]"].is_number(), "{file}");
    for extension in ["svg", "png", "csv"] {
        assert!(directory.path().join("results/rig-nonlinear-paper").with_extension(extension).is_file());
    }
}

/// Guards: axes of more decades than numbers have ratios, on which the drawing never ended.
#[test]
fn searches_that_went_as_far_as_numbers_reach_are_drawn() {
    let noise_aware = ["linear", "--objective", "noise-aware", "--noise", "1e-3", "--particles", "2"];
    for arguments in
        [&["nonlinear", "--particles", "4"][..], &["nonlinear", "--particles", "7"], &noise_aware]
    {
        let directory = tempfile::tempdir().unwrap();
        let swarm =
            ["tune", "--swarm", "printed", "--iterations", "14000", "--out", "far.json", "--observer"];
        let output = maglev_fmu(directory.path(), &[&swarm[..], arguments].concat()).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        for name in ["far.json", "far.svg", "far.png", "far.csv"] {
            assert!(directory.path().join(name).is_file(), "{arguments:?}: {name}");
        }
    }
}
