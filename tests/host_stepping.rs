//! The host drives a small unit of both versions, compiled here: `y <- a y + b u` in every step.
//!
//! The unit misbehaves on request, which no honest FMU does.
#![cfg(feature = "tools")]

use std::fs::File;
use std::io::Write;
use std::process::Command;
use std::sync::OnceLock;

use maglev_fmu::fmi::Status;
use maglev_fmu::host::{ExchangeOrder, Fmu, HostError, Instance, Logging, ReportedStatus, TwoUnitLoop};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Both interfaces in one library. Step sizes 97, 98, 99 and below 0 ask for trouble.
const UNIT: &str = r#"
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

// Reals: 0 u, 1 y, 2 a, 3 b. Others: 0.
pub struct Unit { reals: [f64; 4], steps: i64, flag: u8, mode: i64, saved: f64, log: Log }

fn unit(log: Log) -> *mut Unit {
    Box::into_raw(Box::new(Unit { reals: [0.0, 0.0, 1.0, 1.0], steps: 0, flag: 0, mode: 0, saved: 0.0, log }))
}

unsafe fn token_fits(token: *const c_char, resources: *const c_char) -> bool {
    let resources = CStr::from_ptr(resources).to_str().unwrap();
    let path = resources.strip_prefix("file://").unwrap_or(resources);
    CStr::from_ptr(token).to_bytes() == b"right" && std::path::Path::new(path).is_dir()
}

unsafe fn step(unit: *mut Unit, size: f64) -> i32 {
    let unit = &mut *unit;
    match size {
        97.0 => return 1,
        98.0 => return 17,
        99.0 => return 4,
        size if size < 0.0 => {
            let category = c"error".as_ptr();
            match unit.log {
                Log::Two(callbacks) => {
                    let callbacks = &*callbacks;
                    // The extra arguments show that a logger with fixed arguments survives them.
                    (callbacks.logger)(callbacks.environment, c"unit".as_ptr(), 3, category,
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
    unit.reals[1] = unit.reals[2] * unit.reals[1] + unit.reals[3] * unit.reals[0];
    unit.steps += 1;
    0
}

macro_rules! plain { ($($name:ident),*) => {$(
    #[no_mangle] pub extern "C" fn $name(_: *mut Unit) -> i32 { 0 }
)*} }
plain!(fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2Terminate, fmi3ExitInitializationMode, fmi3Terminate);

#[no_mangle] pub extern "C" fn fmi2GetVersion() -> *const c_char { c"2.0".as_ptr() }
#[no_mangle] pub extern "C" fn fmi3GetVersion() -> *const c_char { c"3.0".as_ptr() }
#[no_mangle] pub unsafe extern "C" fn fmi2Instantiate(_: *const c_char, _: i32, token: *const c_char, resources: *const c_char,
    callbacks: *const Callbacks2, _: i32, _: i32) -> *mut Unit {
    if !token_fits(token, resources) { return std::ptr::null_mut(); }
    ((*callbacks).free)(((*callbacks).allocate)(2, 8));
    unit(Log::Two(callbacks))
}
#[no_mangle] pub unsafe extern "C" fn fmi3InstantiateCoSimulation(_: *const c_char, token: *const c_char, resources: *const c_char,
    _: u8, _: u8, _: u8, _: u8, _: *const u32, _: usize, environment: *mut c_void, logger: Logger3, _: *const c_void) -> *mut Unit {
    if !token_fits(token, resources) { return std::ptr::null_mut(); }
    unit(Log::Three(environment, logger))
}
#[no_mangle] pub unsafe extern "C" fn fmi2FreeInstance(unit: *mut Unit) { drop(Box::from_raw(unit)) }
#[no_mangle] pub unsafe extern "C" fn fmi3FreeInstance(unit: *mut Unit) { drop(Box::from_raw(unit)) }
#[no_mangle] pub extern "C" fn fmi2SetupExperiment(_: *mut Unit, _: i32, _: f64, _: f64, _: i32, _: f64) -> i32 { 0 }
#[no_mangle] pub extern "C" fn fmi3EnterInitializationMode(_: *mut Unit, _: u8, _: f64, _: f64, _: u8, _: f64) -> i32 { 0 }
unsafe fn reset(unit: *mut Unit) -> i32 { (*unit).reals = [0.0, 0.0, 1.0, 1.0]; (*unit).steps = 0; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2Reset(unit: *mut Unit) -> i32 { reset(unit) }
#[no_mangle] pub unsafe extern "C" fn fmi3Reset(unit: *mut Unit) -> i32 { reset(unit) }
#[no_mangle] pub unsafe extern "C" fn fmi2DoStep(unit: *mut Unit, _: f64, size: f64, _: i32) -> i32 { step(unit, size) }
#[no_mangle] pub unsafe extern "C" fn fmi3DoStep(unit: *mut Unit, _: f64, size: f64, _: u8, _: *mut u8, terminate: *mut u8,
    _: *mut u8, _: *mut f64) -> i32 {
    *terminate = u8::from(size == 96.0);
    step(unit, size)
}
unsafe fn get(unit: *mut Unit, references: *const u32, count: usize, values: *mut f64) -> i32 {
    for k in 0..count { *values.add(k) = (*unit).reals[*references.add(k) as usize]; }
    0
}
unsafe fn set(unit: *mut Unit, references: *const u32, count: usize, values: *const f64) -> i32 {
    for k in 0..count { (*unit).reals[*references.add(k) as usize] = *values.add(k); }
    0
}
#[no_mangle] pub unsafe extern "C" fn fmi2GetReal(unit: *mut Unit, r: *const u32, n: usize, v: *mut f64) -> i32 { get(unit, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi2SetReal(unit: *mut Unit, r: *const u32, n: usize, v: *const f64) -> i32 { set(unit, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi3GetFloat64(unit: *mut Unit, r: *const u32, n: usize, v: *mut f64, _: usize) -> i32 { get(unit, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi3SetFloat64(unit: *mut Unit, r: *const u32, n: usize, v: *const f64, _: usize) -> i32 { set(unit, r, n, v) }
#[no_mangle] pub unsafe extern "C" fn fmi2GetInteger(unit: *mut Unit, r: *const u32, _: usize, v: *mut i32) -> i32 {
    *v = if *r == 0 { (*unit).steps } else { (*unit).mode } as i32; 0
}
#[no_mangle] pub unsafe extern "C" fn fmi3GetInt64(unit: *mut Unit, r: *const u32, _: usize, v: *mut i64, _: usize) -> i32 {
    *v = if *r == 0 { (*unit).steps } else { (*unit).mode }; 0
}
#[no_mangle] pub unsafe extern "C" fn fmi2SetInteger(unit: *mut Unit, _: *const u32, _: usize, v: *const i32) -> i32 { (*unit).mode = *v as i64; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetInt64(unit: *mut Unit, _: *const u32, _: usize, v: *const i64, _: usize) -> i32 { (*unit).mode = *v; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2GetBoolean(unit: *mut Unit, _: *const u32, _: usize, v: *mut i32) -> i32 { *v = (*unit).flag as i32; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2SetBoolean(unit: *mut Unit, _: *const u32, _: usize, v: *const i32) -> i32 { (*unit).flag = *v as u8; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3GetBoolean(unit: *mut Unit, _: *const u32, _: usize, v: *mut u8, _: usize) -> i32 { *v = (*unit).flag; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetBoolean(unit: *mut Unit, _: *const u32, _: usize, v: *const u8, _: usize) -> i32 { (*unit).flag = *v; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi2GetString(_: *mut Unit, _: *const u32, _: usize, v: *mut *const c_char) -> i32 { *v = c"text".as_ptr(); 0 }
#[no_mangle] pub extern "C" fn fmi2SetString(_: *mut Unit, _: *const u32, _: usize, _: *const *const c_char) -> i32 { 0 }
// States exist in FMI 3.0 only: the unit keeps one value and hands out its own address.
#[no_mangle] pub unsafe extern "C" fn fmi3GetFMUState(unit: *mut Unit, s: *mut *mut c_void) -> i32 { (*unit).saved = (*unit).reals[1]; *s = unit.cast(); 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3SetFMUState(unit: *mut Unit, _: *mut c_void) -> i32 { (*unit).reals[1] = (*unit).saved; 0 }
#[no_mangle] pub unsafe extern "C" fn fmi3FreeFMUState(_: *mut Unit, s: *mut *mut c_void) -> i32 { *s = std::ptr::null_mut(); 0 }
"#;

const FMI2: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="Two" guid="right">
<CoSimulation modelIdentifier="unit"/>
<TypeDefinitions><SimpleType name="Mode"><Enumeration><Item name="idle" value="0"/><Item name="busy" value="5"/></Enumeration></SimpleType></TypeDefinitions>
<ModelVariables>
<ScalarVariable name="u" valueReference="0" causality="input"><Real unit="V"/></ScalarVariable>
<ScalarVariable name="y" valueReference="1" causality="output"><Real unit="m"/></ScalarVariable>
<ScalarVariable name="a" valueReference="2" causality="parameter"><Real/></ScalarVariable>
<ScalarVariable name="b" valueReference="3" causality="parameter"><Real/></ScalarVariable>
<ScalarVariable name="steps" valueReference="0" causality="output"><Integer/></ScalarVariable>
<ScalarVariable name="mode" valueReference="1" causality="parameter"><Enumeration declaredType="Mode"/></ScalarVariable>
<ScalarVariable name="flag" valueReference="0" causality="input"><Boolean/></ScalarVariable>
<ScalarVariable name="text" valueReference="0" causality="local"><String/></ScalarVariable>
</ModelVariables></fmiModelDescription>"#;

const FMI3: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="Three" instantiationToken="right">
<CoSimulation modelIdentifier="unit"/>
<TypeDefinitions><EnumerationType name="Mode"><Item name="idle" value="0"/><Item name="busy" value="5"/></EnumerationType></TypeDefinitions>
<ModelVariables>
<Float64 name="u" valueReference="0" causality="input" unit="V"/>
<Float64 name="y" valueReference="1" causality="output" unit="m"/>
<Float64 name="a" valueReference="2" causality="parameter"/>
<Float64 name="b" valueReference="3" causality="parameter"/>
<Float64 name="vector" valueReference="4" causality="parameter"><Dimension start="3"/></Float64>
<Int64 name="steps" valueReference="0" causality="output"/>
<Enumeration name="mode" valueReference="1" declaredType="Mode" causality="parameter"/>
<Boolean name="flag" valueReference="0" causality="input"/>
<Int16 name="text" valueReference="0"/>
</ModelVariables></fmiModelDescription>"#;

/// Compiles a shared library.
fn compile(source_text: &str) -> Vec<u8> {
    let directory = tempfile::tempdir().unwrap();
    let source = directory.path().join("unit.rs");
    let target = directory.path().join("unit.bin");
    std::fs::write(&source, source_text).unwrap();
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(compiler)
        .args(["--edition=2021", "--crate-type=cdylib", "-Copt-level=1", "-Anon_snake_case", "-o"])
        .args([&target, &source])
        .status()
        .expect("the compiler that built this test");
    assert!(status.success());
    std::fs::read(target).unwrap()
}

/// Packs an FMU and opens it.
fn open_with(description: &str, library: &[u8]) -> Result<Fmu, HostError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("unit.fmu");
    let mut zip = ZipWriter::new(File::create(&path).unwrap());
    let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
    let library_name =
        format!("binaries/{}-{system}/unit.{}", std::env::consts::ARCH, std::env::consts::DLL_EXTENSION);
    for (name, content) in
        [("modelDescription.xml", description.as_bytes()), (library_name.as_str(), library)]
    {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    Fmu::open(&path)
}

fn open(description: &str) -> Result<Fmu, HostError> {
    static UNIT_LIBRARY: OnceLock<Vec<u8>> = OnceLock::new();
    open_with(description, UNIT_LIBRARY.get_or_init(|| compile(UNIT)))
}

fn both() -> [Fmu; 2] {
    [FMI2, FMI3].map(|description| open(description).unwrap())
}

#[test]
fn values_of_every_kind_go_in_and_out() {
    for fmu in both() {
        let mut unit = fmu.instantiate("one", Logging::On).unwrap();
        drop(fmu);
        unit.set_by_name("mode", "busy").unwrap();
        unit.set_by_name("flag", true).unwrap();
        unit.set_by_name("b", 2.0).unwrap();
        unit.set_by_name("u", 3).unwrap();
        unit.initialise(0.0, Some(1.0)).unwrap();
        unit.step(0.0, 0.5).unwrap();
        unit.step(0.5, 0.5).unwrap();
        let values = ["y", "mode", "flag", "steps"].map(|name| unit.get_by_name(name).unwrap());
        assert_eq!(values, [12.0, 5.0, 1.0, 2.0]);

        let mut batch = [0.0; 3];
        unit.get_reals(&[1, 3, 0], &mut batch).unwrap();
        assert_eq!(batch, [12.0, 2.0, 3.0]);
        unit.set_reals(&[0, 2], &[-1.0, 0.5]).unwrap();
        unit.step(1.0, 0.5).unwrap();
        assert_eq!(unit.get_by_name("y").unwrap(), 4.0);
        unit.terminate().unwrap();
        unit.reset().unwrap();
        assert_eq!(unit.get_by_name("steps").unwrap(), 0.0);
    }
}

#[test]
fn impossible_values_are_refused_before_they_reach_the_unit() {
    for fmu in both() {
        let mut unit = fmu.instantiate("one", Logging::Off).unwrap();
        let flag = unit.variable("flag").unwrap();
        let mode = unit.variable("mode").unwrap();
        assert!(
            matches!(unit.set(flag, 0.5), Err(HostError::NotRepresentable { variable, .. }) if variable == "flag")
        );
        assert!(
            matches!(unit.set(mode, 2.5), Err(HostError::NotRepresentable { variable, .. }) if variable == "mode")
        );
        assert!(matches!(unit.set(mode, f64::NAN), Err(HostError::NotRepresentable { .. })));
        assert_eq!(
            unit.set_by_name("mode", "asleep").unwrap_err().to_string(),
            "variable `mode` of instance `one` has no item `asleep`, only `idle`, `busy`"
        );
        assert!(matches!(unit.set_by_name("u", true), Err(HostError::WrongKind { .. })));
        assert!(matches!(unit.set_by_name("u", "1.0"), Err(HostError::WrongKind { .. })));
        assert!(matches!(unit.set_by_name("flag", 1.0), Err(HostError::WrongKind { .. })));
        assert!(matches!(unit.set_by_name("v", 1.0), Err(HostError::UnknownVariable { .. })));
        assert!(matches!(
            unit.set_reals(&[0, 1], &[0.0]),
            Err(HostError::LengthMismatch { references: 2, values: 1, .. })
        ));
    }
    let [two, three] = both();
    let two = two.instantiate("two", Logging::Off).unwrap();
    assert_eq!(two.get_text(two.variable("text").unwrap()).unwrap(), "text");
    assert!(matches!(two.get_by_name("text"), Err(HostError::WrongKind { given: "number", .. })));
    let three = three.instantiate("three", Logging::Off).unwrap();
    assert!(matches!(three.variable("vector"), Err(HostError::Array { .. })));
    assert!(matches!(
        three.get_by_name("text"),
        Err(HostError::MissingFunction { function: "fmi3GetInt16", .. })
    ));
}

#[test]
fn a_bad_status_is_an_error_with_the_last_log_message() {
    for (fmu, text) in both().into_iter().zip(["100% wrong: %g %d %s", "100% wrong"]) {
        let mut unit = fmu.instantiate("one", Logging::On).unwrap();
        unit.initialise(0.0, None).unwrap();
        unit.step(0.0, 97.0).expect("a warning is accepted");
        let error = unit.step(0.0, -1.0).unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with(&format!("DoStep of instance `one` returned Error; its last log message: {text}"))
        );
        let HostError::Call { status, log, .. } = error else { panic!("{error}") };
        assert_eq!((status.known(), log.as_deref()), (Some(Status::Error), Some(text)));
        assert_eq!((unit.log().len(), unit.log()[0].category.as_str()), (1, "error"));
        assert!(matches!(unit.step(0.0, 98.0), Err(HostError::Call { status: ReportedStatus(17), .. })));
        unit.step(0.0, 0.1).expect("an error is not the end");
    }
}

#[test]
fn after_fatal_the_unit_is_left_alone() {
    for fmu in both() {
        let mut unit = fmu.instantiate("one", Logging::Off).unwrap();
        unit.initialise(0.0, None).unwrap();
        let error = unit.step(0.0, 99.0).unwrap_err();
        assert!(error.to_string().ends_with("DoStep of instance `one` returned Fatal and logged nothing"));
        assert!(matches!(unit.step(0.0, 0.1), Err(HostError::Lost { .. })));
        assert!(matches!(unit.get_by_name("y"), Err(HostError::Lost { .. })));
    }
}

#[test]
fn a_unit_may_ask_to_terminate() {
    let mut unit = open(FMI3).unwrap().instantiate("one", Logging::Off).unwrap();
    unit.initialise(0.0, None).unwrap();
    assert!(matches!(
        unit.step(0.25, 96.0),
        Err(HostError::TerminationRequested { time, .. }) if time == 0.25
    ));
}

#[test]
fn a_wrong_token_is_reported() {
    for fmu in both() {
        let error = fmu.instantiate_with_token("one", "left", Logging::Off).unwrap_err();
        assert!(matches!(&error, HostError::Instantiate { instance, .. } if instance == "one"), "{error}");
        assert!(matches!(fmu.instantiate("a\0b", Logging::Off), Err(HostError::NulInText { .. })));
    }
}

#[test]
fn states_are_saved_and_restored_by_their_own_instance_only() {
    let [two, three] = both();
    let mut unit = three.instantiate("one", Logging::Off).unwrap();
    let mut other = three.instantiate("other", Logging::Off).unwrap();
    unit.initialise(0.0, None).unwrap();
    unit.set_by_name("u", 1.0).unwrap();
    unit.step(0.0, 0.1).unwrap();
    let saved = unit.save_state().unwrap();
    unit.step(0.1, 0.1).unwrap();
    unit.restore_state(&saved).unwrap();
    assert_eq!(unit.get_by_name("y").unwrap(), 1.0);
    assert!(matches!(other.restore_state(&saved), Err(HostError::ForeignState { .. })));
    unit.free_state(saved).unwrap();

    let mut unit = two.instantiate("two", Logging::Off).unwrap();
    assert!(matches!(unit.save_state(), Err(HostError::MissingFunction { function: "fmi2GetFMUstate", .. })));
}

#[test]
fn instances_move_between_threads() {
    let fmu = open(FMI3).unwrap();
    let mut unit = fmu.instantiate("one", Logging::Off).unwrap();
    let moved = std::thread::spawn(move || {
        unit.initialise(0.0, None).unwrap();
        unit.set_by_name("u", 2.0).unwrap();
        unit.step(0.0, 0.1).unwrap();
        unit
    });
    assert_eq!(moved.join().unwrap().get_by_name("y").unwrap(), 2.0);
}

/// Controller `y = -u / 2`, plant `y <- y + u` from `y = 1`: the units of a loop, one of each version.
fn control_loop(order: ExchangeOrder) -> TwoUnitLoop {
    let [two, three] = both();
    let with_parameters = |fmu: &Fmu, name: &str, parameters: [f64; 3]| -> Instance {
        let mut unit = fmu.instantiate(name, Logging::Off).unwrap();
        for (variable, value) in ["y", "a", "b"].into_iter().zip(parameters) {
            unit.set_by_name(variable, value).unwrap();
        }
        unit
    };
    let controller = with_parameters(&two, "controller", [0.0, 0.0, -0.5]);
    let plant = with_parameters(&three, "plant", [1.0, 1.0, 1.0]);
    let mut control_loop =
        TwoUnitLoop::connect(controller, plant, order, &[("y", "u"), ("flag", "flag")], &[("y", "u")])
            .unwrap();
    control_loop.record(&[("plant", "y"), ("controller", "y"), ("plant", "steps")]).unwrap();
    control_loop
}

#[test]
fn the_controller_acts_at_once_or_one_step_late() {
    let mut at_once = control_loop(ExchangeOrder::ControllerFirst);
    at_once.initialise(10.0, None, 0.1).unwrap();
    let trace = at_once.run(3).unwrap();
    assert_eq!(trace.names, ["plant.y", "controller.y", "plant.steps"]);
    assert_eq!(trace.units, [Some("m".to_owned()), Some("m".to_owned()), None]);
    assert_eq!(trace.time, [10.0, 10.0 + 0.1, 10.0 + 2.0 * 0.1]);
    assert_eq!(trace.column("plant.y").unwrap(), [1.0, 0.5, 0.25]);
    assert_eq!(trace.column("controller.y").unwrap(), [-0.5, -0.25, -0.125]);
    assert_eq!(trace.column("plant.steps").unwrap(), [0.0, 1.0, 2.0]);
    assert_eq!(at_once.plant().get_by_name("y").unwrap(), 0.125, "the plant after the last step");

    let mut late = control_loop(ExchangeOrder::Parallel);
    late.initialise(10.0, None, 0.1).unwrap();
    let trace = late.run(4).unwrap();
    assert_eq!(trace.column("plant.y").unwrap(), [1.0, 1.0, 0.5, 0.0]);
    assert_eq!(trace.column("controller.y").unwrap(), [0.0, -0.5, -0.5, -0.25]);
}

#[test]
fn a_run_goes_on_where_the_last_one_ended() {
    for order in [ExchangeOrder::ControllerFirst, ExchangeOrder::Parallel] {
        let mut whole = control_loop(order);
        whole.initialise(0.0, Some(1.0), 0.01).unwrap();
        let expected = whole.run(20).unwrap();

        let mut split = control_loop(order);
        split.initialise(0.0, Some(1.0), 0.01).unwrap();
        let mut trace = split.run(7).unwrap();
        assert_eq!(split.time(), Some(7.0 * 0.01));
        split.run_into(&mut trace, 13, |_, _, _| Ok(())).unwrap();
        assert_eq!(trace, expected);
    }
}

#[test]
fn an_intervention_sees_every_communication_point() {
    let mut control_loop = control_loop(ExchangeOrder::ControllerFirst);
    control_loop.initialise(0.0, None, 0.5).unwrap();
    let mut times = Vec::new();
    let trace = control_loop
        .run_with(3, |time, controller, plant| {
            times.push(time);
            controller.set_by_name("b", 0.0)?;
            plant.set_by_name("y", time)
        })
        .unwrap();
    assert_eq!(times, [0.0, 0.5, 1.0]);
    assert_eq!(trace.column("plant.y").unwrap(), times);
}

#[test]
fn a_misused_loop_says_so() {
    let mut control_loop = control_loop(ExchangeOrder::Parallel);
    assert!(matches!(control_loop.run(1), Err(HostError::LoopNotInitialised { .. })));
    for step_size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(control_loop.initialise(0.0, None, step_size), Err(HostError::StepSize { .. })));
    }
    assert!(matches!(
        control_loop.record(&[("observer", "y")]),
        Err(HostError::UnknownUnit { unit, .. }) if unit == "observer"
    ));
    assert!(matches!(control_loop.record(&[("plant", "z")]), Err(HostError::UnknownVariable { .. })));
    control_loop.initialise(0.0, None, 0.1).unwrap();
    let mut foreign = maglev_fmu::host::Trace::default();
    assert!(matches!(
        control_loop.run_into(&mut foreign, 1, |_, _, _| Ok(())),
        Err(HostError::ForeignTrace { .. })
    ));
    let (controller, plant) = control_loop.into_instances();
    let unknown = TwoUnitLoop::connect(controller, plant, ExchangeOrder::Parallel, &[("y", "w")], &[]);
    assert!(matches!(unknown, Err(HostError::UnknownVariable { variable, .. }) if variable == "w"));
}

#[test]
fn the_library_must_fit_the_description() {
    let only_version = |version: &str| {
        compile(&format!(
            "#[no_mangle] pub extern \"C\" fn fmi2GetVersion() -> *const std::ffi::c_char {{ c\"{version}\".as_ptr() }}"
        ))
    };
    let two = only_version("2.0");
    assert!(matches!(
        open_with(FMI2, &two),
        Err(HostError::MissingFunction { function: "fmi2Instantiate", .. })
    ));
    assert!(matches!(
        open_with(FMI3, &two),
        Err(HostError::MissingFunction { function: "fmi3GetVersion", .. })
    ));
    assert_eq!(
        open_with(FMI2, &only_version("3.0")).unwrap_err().to_string(),
        "fmi2GetVersion of `Two` returned \"3.0\", but its fmiVersion is 2.0"
    );
}
