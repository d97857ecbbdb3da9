//! The host refuses archives that are too large for the machine or that were forged, and leaves nothing behind.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use maglev_fmu::host::{Archive, HostError, Limits};
use proptest::prelude::*;
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::{FullFileOptions, SimpleFileOptions};

const SMALL: Limits = Limits {
    entries: 5,
    levels: 6,
    entry_bytes: 1_000,
    total_bytes: 1_500,
    description_bytes: 400,
    description_elements: 10,
};

const DESCRIPTION: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="Empty" instantiationToken="t">
  <CoSimulation modelIdentifier="Empty"/><ModelVariables/><ModelStructure/>
</fmiModelDescription>"#;

/// Writes an archive; the directory must outlive its use.
fn write(fill: impl FnOnce(&mut ZipWriter<File>)) -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("model.fmu");
    let mut zip = ZipWriter::new(File::create(&path).unwrap());
    fill(&mut zip);
    zip.finish().unwrap();
    (directory, path)
}

fn archive(entries: &[(&str, &[u8])]) -> (TempDir, PathBuf) {
    write(|zip| {
        for (name, content) in entries {
            zip.start_file(*name, SimpleFileOptions::default()).unwrap();
            zip.write_all(content).unwrap();
        }
    })
}

fn refused(path: &Path, limits: &Limits) -> HostError {
    Archive::unpack_within(path, limits).unwrap_err()
}

/// Replaces bytes wherever they are, local headers and list of entries alike.
fn forge(path: &Path, old: &[u8], new: &[u8]) {
    assert_eq!(old.len(), new.len());
    let mut bytes = fs::read(path).unwrap();
    let places: Vec<usize> =
        (0..=bytes.len() - old.len()).filter(|&place| bytes[place..].starts_with(old)).collect();
    assert!(!places.is_empty());
    for place in places {
        bytes[place..place + new.len()].copy_from_slice(new);
    }
    fs::write(path, bytes).unwrap();
}

/// Guards: 1 MB that unpacks to 1 GB.
#[test]
fn what_is_too_large_is_refused_by_name() {
    let (_directory, path) = archive(&[("a", &[0; 500]), ("resources/zeros.bin", &[0; 1_000])]);
    Archive::unpack_within(&path, &SMALL).unwrap();

    let (_directory, path) = archive(&[("a", &[0; 500]), ("resources/zeros.bin", &[0; 1_001])]);
    let message = refused(&path, &SMALL).to_string();
    assert!(message.contains("`resources/zeros.bin` of the FMU"), "{message}");
    assert!(
        message.ends_with(
            "more than 1000 bytes, but `Limits::entry_bytes` = 1000; raise it if you trust the file"
        )
    );
    Archive::unpack_within(&path, &Limits { entry_bytes: 1_001, total_bytes: 1_501, ..SMALL }).unwrap();

    let (_directory, path) = archive(&[("a", &[0; 501]), ("b", &[0; 1_000])]);
    let message = refused(&path, &SMALL).to_string();
    assert!(message.contains("all its entries together") && message.contains("`Limits::total_bytes` = 1500"));

    let names = ["1", "2", "3", "4", "5", "6"];
    let (_directory, path) = archive(&names.map(|name| (name, b"".as_slice())));
    let message = refused(&path, &SMALL).to_string();
    assert!(
        message.ends_with("6 entries, but `Limits::entries` = 5; raise it if you trust the file"),
        "{message}"
    );
    Archive::unpack_within(&path, &Limits { entries: 6, ..SMALL }).unwrap();
}

/// Guards: thousands of directories from one path, of which only the file at its end was counted.
#[test]
fn directories_on_the_way_to_a_file_are_counted() {
    let entries: [(&str, &[u8]); 2] = [("a/b/c/d", b""), ("a/b/c/e", b"")];
    let (_directory, path) = archive(&entries);
    Archive::unpack_within(&path, &SMALL).unwrap();
    let (_directory, path) = archive(&[entries[0], entries[1], ("a/f/", b"")]);
    let message = refused(&path, &SMALL).to_string();
    assert!(
        message.starts_with("files and directories of the FMU")
            && message.ends_with("more than 5, but `Limits::entries` = 5; raise it if you trust the file"),
        "{message}"
    );
    Archive::unpack_within(&path, &Limits { entries: 6, ..SMALL }).unwrap();

    // Many paths of many levels each.
    let names: Vec<String> = (0..300).map(|number| format!("{number}/").repeat(60) + "file").collect();
    let entries: Vec<(&str, &[u8])> = names.iter().map(|name| (name.as_str(), b"".as_slice())).collect();
    let (_directory, path) = archive(&entries);
    assert!(refused(&path, &Limits::default()).to_string().contains("`Limits::entries` = 10000"));
}

/// Guards: directories so deep that they cannot be deleted again with the file descriptors of a process.
#[test]
fn deep_paths_are_refused() {
    let deep = "d/".repeat(1_900);
    for name in [deep.clone(), format!("{deep}file"), deep.replace('/', "\\")] {
        let (_directory, path) = archive(&[(&name, b"")]);
        let message = refused(&path, &Limits::default()).to_string();
        assert!(message.contains("`d/d/") || message.contains("`d\\\\d"), "{message}");
        assert!(
            message.contains(": a path of 190") && message.contains("`Limits::levels` = 64"),
            "{message}"
        );
        assert!(message.len() < 300, "{message}");
    }
    let (_directory, path) = archive(&[("1/2/3/4/5", b"")]);
    Archive::unpack_within(&path, &SMALL).unwrap();
    let (_directory, path) = archive(&[("1/2/3/4/5/6", b"")]);
    Archive::unpack_within(&path, &Limits { entries: 6, ..SMALL }).unwrap();
    assert!(Archive::unpack_within(&path, &Limits { entries: 6, levels: 5, ..SMALL }).is_err());
}

#[test]
fn the_default_suits_large_fmus_but_no_bomb() {
    let default = Limits::default();
    assert!(default.total_bytes < 1_000_000_000 && default.total_bytes >= 500_000_000);
    assert!(default.entry_bytes <= default.total_bytes);
}

/// Guards: sizes believed from the headers.
#[test]
fn sizes_are_counted_and_not_believed() {
    let (_directory, path) = archive(&[("zeros", &[0; 70_001])]);
    forge(&path, &70_001_u32.to_le_bytes(), &7_u32.to_le_bytes());
    // The reader of archives stops at the declared size, the host at the limit, whichever is smaller.
    let error = refused(&path, &SMALL);
    assert!(matches!(&error, HostError::Unpack { entry, .. } if entry == "zeros"), "{error}");
    let (_directory, path) = archive(&[("zeros", &[0; 70_001])]);
    forge(&path, &70_001_u32.to_le_bytes(), &100_000_u32.to_le_bytes());
    let error = refused(&path, &SMALL);
    assert!(matches!(error, HostError::OverLimit { name: "entry_bytes", .. }), "{error}");
}

/// Guards: a list of entries that fills the memory before anything is unpacked.
#[test]
fn a_list_of_entries_that_is_too_long_is_not_read() {
    let comment = "x".repeat(60_000);
    let (_directory, path) = write(|zip| {
        for number in 0..40 {
            let options = FullFileOptions::default().with_file_comment(comment.as_str());
            zip.start_file(number.to_string(), options).unwrap();
        }
    });
    let limits = Limits { total_bytes: 10_000_000, ..SMALL };
    let error = refused(&path, &limits);
    assert!(matches!(error, HostError::OverLimit { name: "entries", .. }), "{error}");
}

/// Guards: 53 kB of entries that share their bytes and unpack to 2 GB.
#[test]
fn entries_that_share_bytes_are_refused() {
    let (_directory, path) = write(|zip| {
        zip.start_file("a", SimpleFileOptions::default()).unwrap();
        zip.write_all(&[0; 100]).unwrap();
        zip.shallow_copy_file("a", "b").unwrap();
    });
    let message = refused(&path, &Limits::default()).to_string();
    assert!(message.contains("entries overlap"), "{message}");
}

/// Guards: the last of two entries won, and which one is last differs between programs.
#[test]
fn an_entry_that_is_there_twice_is_refused_by_name() {
    let (_directory, path) = archive(&[("modelDescription.xml", b"a"), ("modelDescription.xm2", b"b")]);
    forge(&path, b"modelDescription.xm2", b"modelDescription.xml");
    let message = refused(&path, &Limits::default()).to_string();
    assert!(message.ends_with("its entry `modelDescription.xml` is there twice"), "{message}");

    for other in ["MODELDESCRIPTION.XML", "./modelDescription.xml", "resources\\..\\x"] {
        let (_directory, path) = archive(&[("modelDescription.xml", b"a"), (other, b"b")]);
        let error = refused(&path, &Limits::default());
        assert!(
            matches!(&error, HostError::Entry { entry, .. } | HostError::EntryEscapes { entry, .. } if entry == other),
            "{error}"
        );
    }
}

#[test]
fn links_and_absolute_paths_are_refused() {
    let (_directory, path) = write(|zip| {
        zip.add_symlink("resources/passwords", "/etc/passwd", SimpleFileOptions::default()).unwrap();
    });
    let message = refused(&path, &Limits::default()).to_string();
    assert!(message.contains("`resources/passwords` is a link"), "{message}");
    let (_directory, path) = archive(&[("_etc/passwd", b"x")]);
    forge(&path, b"_etc/passwd", b"/etc/passwd");
    assert!(matches!(refused(&path, &Limits::default()), HostError::EntryEscapes { .. }));
}

#[test]
fn names_are_printed_escaped() {
    let (_directory, path) = archive(&[("a\u{1b}[2J/../../x", b"x")]);
    let message = refused(&path, &Limits::default()).to_string();
    assert!(message.contains(r"`a\u{1b}[2J/../../x`"), "{message}");
}

/// Both standards allow version 2.0 of the format at most; the counts of ZIP64 could ask for any memory.
#[test]
fn zip64_archives_are_refused() {
    let (_directory, path) = archive(&[("a", b"x")]);
    let mut bytes = fs::read(&path).unwrap();
    let end = bytes.len() - 22;
    bytes.splice(end..end, b"PK\x06\x07".iter().copied().chain([0; 16]));
    fs::write(&path, bytes).unwrap();
    assert!(refused(&path, &Limits::default()).to_string().contains("ZIP64"));
}

#[test]
fn descriptions_have_limits_of_their_own() {
    let unpack = |text: &str| {
        let (_directory, path) = archive(&[("modelDescription.xml", text.as_bytes())]);
        Archive::unpack_within(&path, &SMALL).unwrap().description()
    };
    unpack(DESCRIPTION).unwrap();
    let long =
        DESCRIPTION.replace("<ModelStructure/>", &format!("<!-- {} --><ModelStructure/>", "x".repeat(400)));
    let message = unpack(&long).unwrap_err().to_string();
    assert!(
        message.contains(&format!("{} bytes", long.len()))
            && message.contains("`Limits::description_bytes` = 400")
    );
    let many = DESCRIPTION
        .replace("<ModelVariables/>", &format!("<ModelVariables>{}</ModelVariables>", "<x/>".repeat(7)));
    let message = unpack(&many).unwrap_err().to_string();
    assert!(
        message.contains("more than 10 elements") && message.contains("`Limits::description_elements` = 10"),
        "{message}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// An archive with damaged bytes is unpacked or refused, within the limits.
    #[test]
    fn damaged_archives_do_no_harm(
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let (_directory, path) = archive(&[
            ("modelDescription.xml", DESCRIPTION.as_bytes()),
            ("resources/a.txt", &[7; 300]),
            ("resources/b.txt", &[8; 300]),
        ]);
        let mut bytes = fs::read(&path).unwrap();
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        fs::write(&path, bytes).unwrap();
        if let Ok(unpacked) = Archive::unpack_within(&path, &SMALL) {
            let _ = unpacked.description();
        }
    }
}
