//! A library is packed only if it is one of these models, whatever platform it is for.

use std::fs;

use maglev_fmu::fmi::{FmiVersion, function_names};
use maglev_fmu::model::{MODELS, Token, editions_of};
use maglev_fmu::package::{Library, PackageError};
use object::{Architecture, BinaryFormat};
use proptest::prelude::*;

use super::library_file::{all_functions, library};

fn read(bytes: &[u8]) -> Result<Library, PackageError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("library");
    fs::write(&path, bytes).unwrap();
    Library::read(&path)
}

const PLATFORMS: [(BinaryFormat, Architecture, &str, &str, &str); 6] = [
    (BinaryFormat::Elf, Architecture::X86_64, "linux64", "x86_64-linux", "so"),
    (BinaryFormat::Elf, Architecture::Aarch64, "aarch64-linux", "aarch64-linux", "so"),
    (BinaryFormat::Pe, Architecture::X86_64, "win64", "x86_64-windows", "dll"),
    (BinaryFormat::Pe, Architecture::Aarch64, "aarch64-windows", "aarch64-windows", "dll"),
    (BinaryFormat::MachO, Architecture::X86_64, "darwin64", "x86_64-darwin", "dylib"),
    (BinaryFormat::MachO, Architecture::Aarch64, "aarch64-darwin", "aarch64-darwin", "dylib"),
];

#[test]
fn libraries_of_every_platform_go_to_its_directory() {
    for (format, architecture, fmi2, fmi3, extension) in PLATFORMS {
        let platform = read(&library(format, architecture, &all_functions())).unwrap().platform();
        assert_eq!(platform.directory(FmiVersion::Two), fmi2);
        assert_eq!(platform.directory(FmiVersion::Three), fmi3);
        assert_eq!(platform.extension(), extension);
    }
}

#[test]
fn the_library_of_this_build_is_one() {
    let library = Library::of_this_build().unwrap();
    assert_eq!(library.bytes().len() as u64, fs::metadata(library.path()).unwrap().len());
}

/// Guards: packages without the functions that an importer calls.
#[test]
fn every_function_must_be_exported() {
    for (format, architecture, ..) in PLATFORMS {
        for version in FmiVersion::ALL {
            for missing in function_names(version) {
                let others: Vec<_> = all_functions().into_iter().filter(|name| name != missing).collect();
                let error = read(&library(format, architecture, &others)).unwrap_err();
                assert!(
                    matches!(&error, PackageError::MissingFunctions { first, count: 1, .. } if first == missing),
                    "{format:?}: {error}"
                );
            }
        }
        let error = read(&library(format, architecture, &["main"])).unwrap_err().to_string();
        assert!(error.contains("it lacks fmi2GetTypesPlatform and, with it, 119 of the 119"), "{error}");
    }
}

#[test]
fn other_processors_and_other_models_are_refused() {
    let foreign = library(BinaryFormat::Elf, Architecture::I386, &all_functions());
    assert!(matches!(read(&foreign), Err(PackageError::UnknownPlatform { .. })));
    let mut bytes = library(BinaryFormat::Elf, Architecture::X86_64, &all_functions());
    let name = MODELS[3].description.name;
    let place = bytes.windows(name.len()).position(|part| part == name.as_bytes()).unwrap();
    bytes[place] = b'?';
    assert!(matches!(read(&bytes), Err(PackageError::OtherModels { model, .. }) if model == name));
    // A program of the same format.
    let mut program = library(BinaryFormat::MachO, Architecture::X86_64, &all_functions());
    program[12..16].copy_from_slice(&object::macho::MH_EXECUTE.0.to_le_bytes());
    assert!(matches!(read(&program), Err(PackageError::UnknownPlatform { .. })));
}

/// Guards: packages whose library refuses every token in their model descriptions.
#[test]
fn a_library_of_another_release_is_refused() {
    for (model, edition) in editions_of(MODELS.iter().copied()) {
        let mut bytes = library(BinaryFormat::Elf, Architecture::X86_64, &all_functions());
        let token = edition.token(model.description);
        let place = bytes.windows(Token::LENGTH).position(|part| part == token.as_str().as_bytes()).unwrap();
        // Another hexadecimal digit.
        bytes[place + 1] = if bytes[place + 1] == b'0' { b'1' } else { b'0' };
        let error = read(&bytes).unwrap_err();
        let name = model.description.name;
        assert!(
            matches!(&error, PackageError::OtherRelease { model, .. } if *model == name),
            "{edition:?}: {error}"
        );
        let message = error.to_string();
        assert!(message.contains("is the library of another release: it would refuse"), "{message}");
        assert!(
            message.ends_with(&format!("of {name}; build it from the sources of this program")),
            "{message}"
        );
    }
}

#[test]
fn what_is_no_library_has_no_platform() {
    for bytes in [b"".as_slice(), b"MZ", b"\x7fELF\x01\x01", b"\x7fELF\x02\x01", b"#!/bin/sh\n"] {
        assert!(matches!(read(bytes), Err(PackageError::UnknownPlatform { .. })), "{bytes:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A library that was cut or damaged is read or refused, but never trips the reader.
    #[test]
    fn damaged_libraries_do_no_harm(
        platform in 0..PLATFORMS.len(),
        damage in proptest::collection::vec((0..6000_usize, any::<u8>()), 0..20),
        length in 0..12_000_usize,
    ) {
        let (format, architecture, ..) = PLATFORMS[platform];
        let mut bytes = library(format, architecture, &all_functions());
        damage.into_iter().for_each(|(place, byte)| bytes[place] = byte);
        let _ = read(&bytes[..length]);
        let _ = read(&bytes);
    }
}
