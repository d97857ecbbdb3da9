//! The importer in C or C++, compiled where there is a compiler for it.

use core::ffi::{c_char, c_int, c_void};
use std::ffi::CStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use libloading::Library;
use maglev_fmu::fmi::fmi2::types::fmi2CallbackLogger;
use maglev_fmu::fmi::fmi3::types::{
    fmi3ClockUpdateCallback, fmi3IntermediateUpdateCallback, fmi3LogMessageCallback,
};

/// How callbacks are left.
#[derive(Clone, Copy, Debug)]
pub enum Language {
    /// By `longjmp`.
    C,
    /// By an exception.
    Cpp,
}

type Protect =
    unsafe extern "C" fn(unsafe extern "C-unwind" fn(*mut c_void) -> c_int, *mut c_void, *mut c_int) -> c_int;

pub struct Importer {
    library: Library,
    pub log2: fmi2CallbackLogger,
    pub log3: fmi3LogMessageCallback,
    pub update: fmi3IntermediateUpdateCallback,
    pub clock_update: fmi3ClockUpdateCallback,
}

impl Importer {
    /// `None`, and a remark, if no compiler for the language is installed.
    pub fn new(language: Language, test: &str) -> Option<Self> {
        let path = compiled(language, test)?;
        // SAFETY: a library of plain functions; the types are those of its source.
        unsafe {
            let library = Library::new(&path).unwrap();
            let log2 = *library.get("importer_log2").unwrap();
            let log3 = *library.get("importer_log3").unwrap();
            let update = *library.get("importer_update").unwrap();
            let clock_update = *library.get("importer_clock_update").unwrap();
            Some(Self { library, log2, log3, update, clock_update })
        }
    }

    /// Callbacks of this thread return `calls` times and are left by a jump or an exception the next time.
    pub fn leave_after(&self, calls: c_int) {
        // SAFETY: the type of the source.
        unsafe { self.library.get::<unsafe extern "C" fn(c_int)>("importer_leave_after").unwrap()(calls) };
    }

    /// Messages of this thread since the last time.
    pub fn take_messages(&self) -> Vec<String> {
        let mut text = vec![0u8; 65536];
        // SAFETY: the type of the source; as much room as said.
        unsafe {
            let take = self.library.get::<unsafe extern "C" fn(*mut c_char, usize)>("importer_take_messages");
            take.unwrap()(text.as_mut_ptr().cast(), text.len());
        }
        let text = CStr::from_bytes_until_nul(&text).unwrap().to_str().unwrap();
        text.lines().map(str::to_owned).collect()
    }

    /// Result of `call`, `None` if a callback left it. Nothing in `call` may need to be dropped.
    pub fn protect<F: FnMut() -> c_int>(&self, mut call: F) -> Option<c_int> {
        unsafe extern "C-unwind" fn run<F: FnMut() -> c_int>(call: *mut c_void) -> c_int {
            // SAFETY: the closure below, which nobody else uses meanwhile.
            let call = unsafe { &mut *call.cast::<F>() };
            call()
        }
        let mut result = 0;
        // SAFETY: the type of the source; the closure outlives the call, and no exception comes out of it.
        let was_left = unsafe {
            let protect = self.library.get::<Protect>("importer_protect").unwrap();
            protect(run::<F>, (&raw mut call).cast(), &mut result)
        };
        (was_left == 0).then_some(result)
    }
}

/// Compiles the importer for one test, so that tests may run side by side.
fn compiled(language: Language, test: &str) -> Option<PathBuf> {
    let (compilers, dialect) = match language {
        Language::C => (["cc", "gcc", "clang"], "c"),
        Language::Cpp => (["c++", "g++", "clang++"], "c++"),
    };
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmi/throwing/importer.c");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("importer-{language:?}-{test}.so"));
    for compiler in compilers {
        let mut command = Command::new(compiler);
        command.args(["-x", dialect, "-shared", "-fPIC", "-O1", "-o"]).arg(&target).arg(&source);
        if let Ok(output) = command.output() {
            let complaints = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{compiler}: {complaints}");
            return Some(target);
        }
    }
    // Past the capture of the test's output, which nobody reads of a test that passes.
    let missing = format!("NOT RUN: {test} in {language:?}, none of {compilers:?} is installed\n");
    std::io::stderr().write_all(missing.as_bytes()).unwrap();
    None
}
