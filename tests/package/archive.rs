//! Archives: layout, what the standards ask of the ZIP format, and the same bytes from the same inputs.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use maglev_fmu::model::system::SYSTEMS;
use maglev_fmu::model::{Description, MODELS, ModelType, StartValues, models};
use maglev_fmu::package::{
    FmiVersion, Form, GenerationTime, Library, PackageError, SystemForm, build, icon_png, model_description,
};
use object::Architecture;
use zip::ZipArchive;

use super::library_file::write_library;

const TIME: u32 = 1_234_567_891;

/// Builds all packages for Linux on both processors; file name below the directory to bytes.
fn packages(time: u32) -> BTreeMap<PathBuf, Vec<u8>> {
    let directory = tempfile::tempdir().unwrap();
    let paths = [Architecture::X86_64, Architecture::Aarch64]
        .map(|architecture| write_library(directory.path(), architecture));
    let libraries = Library::read_all(&paths).unwrap();
    let out = directory.path().join("dist");
    let written = build(&out, &libraries, GenerationTime::from_epoch_seconds(time)).unwrap();
    let packages: BTreeMap<_, _> = written
        .iter()
        .map(|file| (file.path.strip_prefix(&out).unwrap().to_owned(), fs::read(&file.path).unwrap()))
        .collect();
    let forms = |model: &ModelType| Form::all_of(model.description).count();
    let models = MODELS.iter().map(|model| forms(model)).sum::<usize>();
    assert_eq!(packages.len(), models + SystemForm::ALL.len() * SYSTEMS.len());
    // Nothing but the packages: no temporary file is left.
    let directories = SystemForm::ALL.iter().filter(|form| !form.directory().is_empty()).count();
    assert_eq!(fs::read_dir(&out).unwrap().count(), Form::ALL.len() + directories + SYSTEMS.len());
    for form in Form::ALL {
        let suited = MODELS.iter().filter(|model| form.edition.suits(model.description)).count();
        assert_eq!(fs::read_dir(out.join(form.directory())).unwrap().count(), suited);
    }
    assert!(written.iter().all(|file| file.size as u64 == fs::metadata(&file.path).unwrap().len()));
    packages
}

fn file(archive: &mut ZipArchive<Cursor<&Vec<u8>>>, name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
    bytes
}

#[test]
fn same_inputs_give_same_bytes() {
    let first = packages(TIME);
    assert!(first == packages(TIME));
    assert!(first != packages(TIME + 2));
}

#[test]
fn archives_hold_what_the_standards_name() {
    let packages = packages(TIME);
    for model in MODELS {
        for form in Form::all_of(model.description) {
            let name = model.description.name;
            let bytes = &packages[&Path::new(form.directory()).join(name).with_extension("fmu")];
            let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
            let (platforms, own_icon) = match form.version {
                FmiVersion::Two => (["aarch64-linux", "linux64"], Some("model.png")),
                FmiVersion::Three => (["aarch64-linux", "x86_64-linux"], None),
            };
            let mut expected: Vec<String> =
                platforms.map(|platform| format!("binaries/{platform}/{name}.so")).to_vec();
            expected.extend(own_icon.map(str::to_owned));
            let in_loop = |other: &ModelType| std::ptr::eq(other, *model);
            let loops = SYSTEMS.iter().filter(|system| in_loop(system.plant) || in_loop(system.controller));
            let diagrams: Vec<String> =
                loops.map(|system| format!("documentation/{}.svg", system.name)).collect();
            expected.extend(diagrams.clone());
            for path in [
                "modelDescription.xml",
                "terminalsAndIcons/icon.png",
                "terminalsAndIcons/icon.svg",
                "terminalsAndIcons/terminalsAndIcons.xml",
                "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
                "extra/org.fmi-standard.fmi-ls-ref/reference-input.csv",
                "extra/org.fmi-standard.fmi-ls-ref/reference-output.csv",
                "documentation/index.html",
                "documentation/reference-run.svg",
                "documentation/licenses/license.txt",
                "documentation/licenses/THIRD-PARTY.txt",
            ] {
                expected.push(path.to_owned());
            }
            expected.sort();
            let names: Vec<String> = (0..archive.len())
                .map(|index| archive.by_index(index).unwrap().name().unwrap().into_owned())
                .collect();
            assert_eq!(names, expected);

            let time = Some(GenerationTime::from_epoch_seconds(TIME));
            let description = model_description(model.description, StartValues::TABLE, form, time);
            assert_eq!(file(&mut archive, "modelDescription.xml"), description.as_bytes());
            for icon in own_icon.into_iter().chain(["terminalsAndIcons/icon.png"]) {
                assert!(file(&mut archive, icon).starts_with(b"\x89PNG\r\n\x1a\n"));
            }
            let page = String::from_utf8(file(&mut archive, "documentation/index.html")).unwrap();
            for variable in model.description.variables {
                assert!(page.contains(&format!("<code>{}</code>", variable.name)), "{}", variable.name);
            }
            for diagram in &diagrams {
                assert!(page.contains(diagram.strip_prefix("documentation/").unwrap()), "{diagram}");
            }
            let token = form.edition.token(model.description);
            assert!(page.contains("2009-02-13T23:31:31Z") && page.contains(token.as_str()));
        }
    }
}

/// Numbers in the heads of an archive, as the format specification (APPNOTE.TXT) lays them out.
struct Head<'a>(&'a [u8]);

impl Head<'_> {
    fn short(&self, offset: usize) -> u16 {
        u16::from_le_bytes(self.0[offset..offset + 2].try_into().unwrap())
    }

    fn long(&self, offset: usize) -> u32 {
        u32::from_le_bytes(self.0[offset..offset + 4].try_into().unwrap())
    }
}

#[test]
fn archives_keep_to_the_plain_format() {
    for (path, bytes) in packages(TIME) {
        let end = Head(&bytes[bytes.len() - 22..]);
        assert_eq!(end.long(0), 0x0605_4b50, "end of central directory without a comment");
        assert_eq!([end.short(4), end.short(6)], [0, 0], "one disk");
        assert_eq!(end.short(8), end.short(10));
        let (count, mut at) = (end.short(10), end.long(16) as usize);
        for _ in 0..count {
            let central = Head(&bytes[at..]);
            assert_eq!(central.long(0), 0x0201_4b50);
            let local = Head(&bytes[central.long(42) as usize..]);
            assert_eq!(local.long(0), 0x0403_4b50);
            let name_length = usize::from(central.short(28));
            let name = std::str::from_utf8(&bytes[at + 46..at + 46 + name_length]).unwrap();
            // Version needed, flags, method, time, date.
            for (central, local) in
                [6, 8, 10, 12, 14].map(|offset| (central.short(offset), local.short(offset - 2)))
            {
                assert_eq!(central, local, "{name}");
            }
            assert!(central.short(6) <= 20, "{name} needs version {}", central.short(6));
            // No encryption, no data descriptor, nothing else; 0x800 would be a name in UTF-8.
            assert_eq!(central.short(8), 0, "{name}");
            assert_eq!(central.short(10), 8, "{name} is deflated");
            assert_eq!(
                [central.short(30), local.short(28)],
                [0, 0],
                "{name} has extra fields, perhaps of ZIP64"
            );
            // 2009-02-13T23:31:31Z, in steps of two seconds.
            assert_eq!(central.short(12), (23 << 11) | (31 << 5) | 15);
            assert_eq!(central.short(14), ((2009 - 1980) << 9) | (2 << 5) | 13);
            let mode = central.long(38) >> 16;
            let expected = if name.starts_with("binaries/") { 0o100_755 } else { 0o100_644 };
            assert_eq!(mode, expected, "{name}");
            assert!(
                name.is_ascii() && !name.contains('\\') && !name.starts_with('/') && !name.ends_with('/')
            );
            at += 46 + name_length + usize::from(central.short(30)) + usize::from(central.short(32));
        }
        assert_eq!(at, bytes.len() - 22, "{}: nothing between directory and its end", path.display());
    }
}

#[test]
fn times_before_1980_do_not_fit_an_archive() {
    for bytes in packages(0).values() {
        let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
        assert_eq!(archive.by_index(0).unwrap().last_modified().unwrap().year(), 1980);
        let is_system = archive.index_for_name("SystemStructure.ssd").is_some();
        let description = if is_system { "SystemStructure.ssd" } else { "modelDescription.xml" };
        let text = String::from_utf8(file(&mut archive, description)).unwrap();
        assert!(text.contains("generationDateAndTime=\"1970-01-01T00:00:00Z\""));
    }
}

#[test]
fn libraries_are_told_apart() {
    let directory = tempfile::tempdir().unwrap();
    let library = write_library(directory.path(), Architecture::X86_64);
    let twice = Library::read_all(&[library.clone(), library]).unwrap_err();
    assert!(matches!(twice, PackageError::SamePlatform { .. }) && twice.to_string().contains("x86_64-linux"));
    let text = directory.path().join("no-library.so");
    fs::write(&text, "text").unwrap();
    assert!(matches!(Library::read(&text), Err(PackageError::UnknownPlatform { .. })));
    let missing = directory.path().join("missing.so");
    let error = Library::read(&missing).unwrap_err();
    assert!(matches!(error, PackageError::Read { .. }) && error.to_string().contains("missing.so"));
}

#[test]
fn a_failed_build_leaves_the_old_package() {
    let directory = tempfile::tempdir().unwrap();
    let libraries = [Library::read(&write_library(directory.path(), Architecture::X86_64)).unwrap()];
    let out = directory.path().join("dist");
    // A directory where the package belongs cannot be replaced by a file.
    let blocked = out.join("fmi3").join(MODELS[0].description.name).with_extension("fmu");
    fs::create_dir_all(blocked.join("inside")).unwrap();
    let error = build(&out, &libraries, GenerationTime::from_epoch_seconds(TIME)).unwrap_err();
    assert!(matches!(&error, PackageError::Write { path, .. } if *path == blocked), "{error}");
    assert_eq!(fs::read_dir(out.join("fmi3")).unwrap().count(), 1);
}

#[test]
fn every_model_has_an_icon() {
    for model in models() {
        icon_png(model.description).unwrap();
    }
    let without = Description::new("Unknown", &[]);
    assert!(matches!(icon_png(&without), Err(PackageError::NoIcon { model: "Unknown" })));
}
