//! The shared library exports every function of both standards.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;

use libloading::Library;
use maglev_fmu::fmi::{FmiVersion, function_names};
use maglev_models::LIBRARY_NAME;

/// Cargo leaves the shared library beside the tests.
fn library() -> PathBuf {
    let directory = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    directory.join(format!("{DLL_PREFIX}{LIBRARY_NAME}{DLL_SUFFIX}"))
}

#[test]
fn library_exports_every_function_of_both_standards() {
    let path = library();
    // SAFETY: our own library; it has no initialisers.
    let library =
        unsafe { Library::new(&path) }.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let names = FmiVersion::ALL.map(function_names);
    assert_eq!(names.map(<[_]>::len), [44, 75]);
    // SAFETY: the symbols are looked up, not called.
    let is_exported = |name: &str| unsafe { library.get::<extern "C" fn()>(name) }.is_ok();
    let missing: Vec<_> = names.into_iter().flatten().filter(|name| !is_exported(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    assert!(!is_exported("fmi2NoSuchFunction"));
}

/// Newest version of glibc among those of the symbols that the library takes from there: the loader refuses the library
/// with an older one.
#[cfg(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64"))]
fn needed_glibc() -> (u32, u32) {
    use object::Endianness;
    use object::elf::FileHeader64;
    use object::read::elf::FileHeader;

    let bytes = std::fs::read(library()).unwrap();
    let header = FileHeader64::<Endianness>::parse(&*bytes).unwrap();
    let endian = header.endian().unwrap();
    let sections = header.sections(endian, &*bytes).unwrap();
    let (needs, link) = sections.gnu_verneed(endian, &*bytes).unwrap().expect("versioned symbols");
    let strings = sections.strings(endian, &*bytes, link).unwrap();
    let versions = needs.flat_map(|need| need.unwrap().1);
    let names = versions.map(|version| version.unwrap().name(endian, strings).unwrap());
    let glibc = names.filter_map(|name| std::str::from_utf8(name).unwrap().strip_prefix("GLIBC_"));
    glibc.map(version).max().expect("a version of glibc")
}

/// Major and minor version at the beginning of a text such as "2.2.5".
#[cfg(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64"))]
fn version(text: &str) -> (u32, u32) {
    let mut numbers = text.split(|character: char| !character.is_ascii_digit());
    let mut number = || numbers.next().unwrap().parse().unwrap();
    (number(), number())
}

#[cfg(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64"))]
#[test]
fn readme_says_which_glibc_the_library_needs() {
    let readme = include_str!("../../README.md");
    let (_, stated) = readme.split_once("needs glibc ").expect("the README says so");
    let (major, minor) = needed_glibc();
    assert_eq!(version(stated), (major, minor), "README: the library needs glibc {major}.{minor}");
}
