//! Compiled by the host's tests to a library of its own; not a part of this package.
use std::ffi::{c_char, c_void, CStr};

type Logger2 = unsafe extern "C" fn(*mut c_void, *const c_char, i32, *const c_char, *const c_char, ...);
type Logger3 = unsafe extern "C" fn(*mut c_void, i32, *const c_char, *const c_char);

#[repr(C)]
pub struct Callbacks2 {
    logger: Logger2,
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    finished: *const c_void,
    environment: *mut c_void,
}

enum Log { Two(*const Callbacks2), Three(*mut c_void, Logger3) }

// Reals: 0 u, 1 y, 2 a, 3 b. Of FMI 2.0, integers: 0 steps, 1 mode; of FMI 3.0: 5 steps, 6 mode.
pub struct Model { reals: [f64; 4], steps: i64, flag: u8, mode: i64, saved: f64, log: Log }

fn model(log: Log) -> *mut Model {
    Box::into_raw(Box::new(Model { reals: [0.0, 0.0, 1.0, 1.0], steps: 0, flag: 0, mode: 0, saved: 0.0, log }))
}

unsafe fn token_fits(token: *const c_char, resources: *const c_char) -> bool {
    let resources = CStr::from_ptr(resources).to_str().unwrap();
    let path = resources.strip_prefix("file://").unwrap_or(resources);
    CStr::from_ptr(token).to_bytes() == b"right" && std::path::Path::new(path).is_dir()
}

unsafe fn step(model: *mut Model, size: f64) -> i32 {
    let model = &mut *model;
    match size {
        97.0 => return 1,
        98.0 => return 17,
        99.0 => return 4,
        size if size < 0.0 => {
            let category = c"error".as_ptr();
            match model.log {
                Log::Two(callbacks) => {
                    let callbacks = &*callbacks;
                    // The extra arguments show that a logger with fixed arguments survives them.
                    (callbacks.logger)(callbacks.environment, c"model".as_ptr(), 3, category,
                        c"100%% wrong: %g %d %s".as_ptr(), size, 7 as std::ffi::c_int, category);
                }
                Log::Three(environment, logger) => {
                    logger(environment, 3, category, c"100% wrong".as_ptr());
                }
            }
            return 3;
        }
        _ => {}
    }
    model.reals[1] = model.reals[2] * model.reals[1] + model.reals[3] * model.reals[0];
    model.steps += 1;
    0
}

macro_rules! plain { ($($name:ident),*) => {$(
    #[no_mangle] pub extern "C" fn $name(_: *mut Model) -> i32 { 0 }
)*} }
plain!(fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2Terminate, fmi3ExitInitializationMode, fmi3Terminate);

#[no_mangle] pub extern "C" fn fmi2GetVersion() -> *const c_char { c"2.0".as_ptr() }
#[no_mangle] pub extern "C" fn fmi3GetVersion() -> *const c_char { c"3.0".as_ptr() }
#[no_mangle] pub unsafe extern "C" fn fmi2Instantiate(_: *const c_char, _: i32, token: *const c_char, resources: *const c_char,
    callbacks: *const Callbacks2, _: i32, _: i32) -> *mut Model {
    if !token_fits(token, resources) { return std::ptr::null_mut(); }
    ((*callbacks).free)(((*callbacks).allocate)(2, 8));
    model(Log::Two(callbacks))
}
#[no_mangle] pub unsafe extern "C" fn fmi3InstantiateCoSimulation(_: *const c_char, token: *const c_char, resources: *const c_char,
    _: u8, _: u8, _: u8, _: u8, _: *const u32, _: usize, environment: *mut c_void, logger: Logger3, _: *const c_void) -> *mut Model {
    if !token_fits(token, resources) { return std::ptr::null_mut(); }
    model(Log::Three(environment, logger))
}
#[no_mangle] pub unsafe extern "C" fn fmi2FreeInstance(model: *mut Model) { drop(Box::from_raw(model)) }
#[no_mangle] pub unsafe extern "C" fn fmi3FreeInstance(model: *mut Model) { drop(Box::from_raw(model)) }
#[no_mangle] pub extern "C" fn fmi2SetupExperiment(_: *mut Model, _: i32, _: f64, _: f64, _: i32, _: f64) -> i32 { 0 }
#[no_mangle] pub extern "C" fn fmi3EnterInitializationMode(_: *mut Model, _: u8, _: f64, _: f64, _: u8, _: f64) -> i32 { 0 }
unsafe fn reset(model: *mut Model) -> i32 { (*model).reals = [0.0, 0.0, 1.0, 1.0]; (*model).steps = 0; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2Reset(model: *mut Model) -> i32 { reset(model) }
#[no_mangle] pub unsafe extern "C" fn fmi3Reset(model: *mut Model) -> i32 { reset(model) }
#[no_mangle] pub unsafe extern "C" fn fmi2DoStep(model: *mut Model, _: f64, size: f64, _: i32) -> i32 { step(model, size) }
#[no_mangle] pub unsafe extern "C" fn fmi3DoStep(model: *mut Model, _: f64, size: f64, _: u8, _: *mut u8, terminate: *mut u8,
    _: *mut u8, _: *mut f64) -> i32 {
    *terminate = u8::from(size == 96.0);
    step(model, size)
}
unsafe fn get(model: *mut Model, references: *const u32, count: usize, values: *mut f64) -> i32 {
    for k in 0..count { *values.add(k) = (*model).reals[*references.add(k) as usize]; }
    0
}
unsafe fn set(model: *mut Model, references: *const u32, count: usize, values: *const f64) -> i32 {
    for k in 0..count { (*model).reals[*references.add(k) as usize] = *values.add(k); }
    0
}
#[no_mangle] pub unsafe extern "C" fn fmi2GetReal(model: *mut Model, r: *const u32, n: usize, v: *mut f64) -> i32 { get(model, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi2SetReal(model: *mut Model, r: *const u32, n: usize, v: *const f64) -> i32 { set(model, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi3GetFloat64(model: *mut Model, r: *const u32, n: usize, v: *mut f64, _: usize) -> i32 { get(model, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi3SetFloat64(model: *mut Model, r: *const u32, n: usize, v: *const f64, _: usize) -> i32 { set(model, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi2GetInteger(model: *mut Model, r: *const u32, _: usize, v: *mut i32) -> i32 {
    *v = if *r == 0 { (*model).steps } else { (*model).mode } as i32; 0
}
#[no_mangle] pub unsafe extern "C" fn fmi3GetInt64(model: *mut Model, r: *const u32, _: usize, v: *mut i64, _: usize) -> i32 {
    *v = if *r == 5 { (*model).steps } else { (*model).mode }; 0
}
#[no_mangle] pub unsafe extern "C" fn fmi2SetInteger(model: *mut Model, _: *const u32, _: usize, v: *const i32) -> i32 { (*model).mode = *v as i64; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetInt64(model: *mut Model, _: *const u32, _: usize, v: *const i64, _: usize) -> i32 { (*model).mode = *v; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2GetBoolean(model: *mut Model, _: *const u32, _: usize, v: *mut i32) -> i32 { *v = (*model).flag as i32; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2SetBoolean(model: *mut Model, _: *const u32, _: usize, v: *const i32) -> i32 { (*model).flag = *v as u8; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3GetBoolean(model: *mut Model, _: *const u32, _: usize, v: *mut u8, _: usize) -> i32 { *v = (*model).flag; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetBoolean(model: *mut Model, _: *const u32, _: usize, v: *const u8, _: usize) -> i32 { (*model).flag = *v; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2GetString(_: *mut Model, _: *const u32, _: usize, v: *mut *const c_char) -> i32 { *v = c"text".as_ptr(); 0 }
#[no_mangle] pub extern "C" fn fmi2SetString(_: *mut Model, _: *const u32, _: usize, _: *const *const c_char) -> i32 { 0 }
// States exist in FMI 3.0 only: the model keeps one value and hands out its own address.
#[no_mangle] pub unsafe extern "C" fn fmi3GetFMUState(model: *mut Model, s: *mut *mut c_void) -> i32 { (*model).saved = (*model).reals[1]; *s = model.cast(); 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetFMUState(model: *mut Model, _: *mut c_void) -> i32 { (*model).reals[1] = (*model).saved; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3FreeFMUState(_: *mut Model, s: *mut *mut c_void) -> i32 { *s = std::ptr::null_mut(); 0 }
