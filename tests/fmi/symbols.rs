//! The shared library exports every function of both standards.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use libloading::Library;
use maglev_fmu::fmi::{FmiVersion, function_names};

#[test]
fn library_exports_every_function_of_both_standards() {
    // Cargo leaves the shared library beside the tests.
    let directory = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    let path = directory.join(format!("{DLL_PREFIX}maglev_fmu{DLL_SUFFIX}"));
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
