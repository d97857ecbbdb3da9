//! The shared library exports every function of both standards.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;

use libloading::Library;

/// Functions of fmi2Functions.h, version 2.0.5.
#[rustfmt::skip]
const FMI2: &[&str] = &[
    "fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2SetDebugLogging", "fmi2Instantiate", "fmi2FreeInstance",
    "fmi2SetupExperiment", "fmi2EnterInitializationMode", "fmi2ExitInitializationMode", "fmi2Terminate",
    "fmi2Reset", "fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString", "fmi2SetReal",
    "fmi2SetInteger", "fmi2SetBoolean", "fmi2SetString", "fmi2GetFMUstate", "fmi2SetFMUstate",
    "fmi2FreeFMUstate", "fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate",
    "fmi2GetDirectionalDerivative", "fmi2EnterEventMode", "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode", "fmi2CompletedIntegratorStep", "fmi2SetTime", "fmi2SetContinuousStates",
    "fmi2GetDerivatives", "fmi2GetEventIndicators", "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates", "fmi2SetRealInputDerivatives", "fmi2GetRealOutputDerivatives",
    "fmi2DoStep", "fmi2CancelStep", "fmi2GetStatus", "fmi2GetRealStatus", "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus", "fmi2GetStringStatus",
];

/// Functions of fmi3Functions.h, version 3.0.2.
#[rustfmt::skip]
const FMI3: &[&str] = &[
    "fmi3GetVersion", "fmi3SetDebugLogging", "fmi3InstantiateModelExchange", "fmi3InstantiateCoSimulation",
    "fmi3InstantiateScheduledExecution", "fmi3FreeInstance", "fmi3EnterInitializationMode",
    "fmi3ExitInitializationMode", "fmi3EnterEventMode", "fmi3Terminate", "fmi3Reset", "fmi3GetFloat32",
    "fmi3GetFloat64", "fmi3GetInt8", "fmi3GetUInt8", "fmi3GetInt16", "fmi3GetUInt16", "fmi3GetInt32",
    "fmi3GetUInt32", "fmi3GetInt64", "fmi3GetUInt64", "fmi3GetBoolean", "fmi3GetString", "fmi3GetBinary",
    "fmi3GetClock", "fmi3SetFloat32", "fmi3SetFloat64", "fmi3SetInt8", "fmi3SetUInt8", "fmi3SetInt16",
    "fmi3SetUInt16", "fmi3SetInt32", "fmi3SetUInt32", "fmi3SetInt64", "fmi3SetUInt64", "fmi3SetBoolean",
    "fmi3SetString", "fmi3SetBinary", "fmi3SetClock", "fmi3GetNumberOfVariableDependencies",
    "fmi3GetVariableDependencies", "fmi3GetFMUState", "fmi3SetFMUState", "fmi3FreeFMUState",
    "fmi3SerializedFMUStateSize", "fmi3SerializeFMUState", "fmi3DeserializeFMUState",
    "fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative", "fmi3EnterConfigurationMode",
    "fmi3ExitConfigurationMode", "fmi3GetIntervalDecimal", "fmi3GetIntervalFraction",
    "fmi3GetShiftDecimal", "fmi3GetShiftFraction", "fmi3SetIntervalDecimal", "fmi3SetIntervalFraction",
    "fmi3SetShiftDecimal", "fmi3SetShiftFraction", "fmi3EvaluateDiscreteStates",
    "fmi3UpdateDiscreteStates", "fmi3EnterContinuousTimeMode", "fmi3CompletedIntegratorStep",
    "fmi3SetTime", "fmi3SetContinuousStates", "fmi3GetContinuousStateDerivatives",
    "fmi3GetEventIndicators", "fmi3GetContinuousStates", "fmi3GetNominalsOfContinuousStates",
    "fmi3GetNumberOfEventIndicators", "fmi3GetNumberOfContinuousStates", "fmi3EnterStepMode",
    "fmi3GetOutputDerivatives", "fmi3DoStep", "fmi3ActivateModelPartition",
];

/// Cargo leaves the shared library beside the tests.
fn library() -> PathBuf {
    let directory = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    directory.join(format!("{DLL_PREFIX}maglev_fmu{DLL_SUFFIX}"))
}

#[test]
fn library_exports_every_function_of_both_standards() {
    let path = library();
    // SAFETY: our own library; it has no initialisers.
    let library =
        unsafe { Library::new(&path) }.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!((FMI2.len(), FMI3.len()), (44, 75));
    // SAFETY: the symbols are looked up, not called.
    let is_exported = |name: &str| unsafe { library.get::<extern "C" fn()>(name) }.is_ok();
    let missing: Vec<_> = FMI2.iter().chain(FMI3).filter(|name| !is_exported(name)).collect();
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
