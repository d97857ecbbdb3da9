//! Memory that runs out, at every place where some is asked for: an error with a message, nothing leaked, and the
//! instance goes on.

use core::cell::{Cell, RefCell};
use core::ffi::{CStr, c_char, c_void};
use core::mem::transmute;
use core::ptr::{null, null_mut};
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::{
    FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, fmi2CallbackFunctions, fmi2CallbackLogger,
};
use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::variable::Kind;
use maglev_fmu::model::{Description, Edition, MODELS, StartValues, models};

use super::allocator::{blocks, with_memory_for};
use super::harness::{BOTH, Component, ERROR, OK, Standard};

thread_local! {
    /// Messages, and the last of them, without the heap.
    static MESSAGES: Cell<u32> = const { Cell::new(0) };
    static LAST: RefCell<(i32, usize, [u8; 1024])> = const { RefCell::new((0, 0, [0; 1024])) };
}

/// A host that keeps the last message in memory it has already.
unsafe fn keep(status: i32, text: *const c_char) {
    // SAFETY: a C string.
    let bytes = unsafe { CStr::from_ptr(text) }.to_bytes();
    MESSAGES.set(MESSAGES.get() + 1);
    LAST.with_borrow_mut(|(last_status, length, last)| {
        last[..bytes.len()].copy_from_slice(bytes);
        (*last_status, *length) = (status, bytes.len());
    });
}

unsafe extern "C-unwind" fn logger2(
    _: *mut c_void,
    _: *const c_char,
    status: i32,
    _: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the library passes a C string that lives during the call.
    unsafe { keep(status, text) };
}

unsafe extern "C-unwind" fn logger3(_: *mut c_void, status: i32, _: *const c_char, text: *const c_char) {
    // SAFETY: as above.
    unsafe { keep(status, text) };
}

/// Messages since the last time, and the last of them.
fn messages() -> (u32, i32, String) {
    let (status, text) = LAST.with_borrow(|(status, length, text)| {
        (*status, String::from_utf8_lossy(&text[..*length]).into_owned())
    });
    (MESSAGES.take(), status, text)
}

#[track_caller]
fn assert_says_out_of_memory(what: &str) {
    let (count, status, text) = messages();
    assert!(count >= 1, "{what}: no message");
    assert!(status == ERROR && text.contains("out of memory: no room for"), "{what}: {status} {text}");
}

/// Every way to an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    CoSimulation2,
    ModelExchange2,
    CoSimulation3 { has_events: bool },
    ModelExchange3,
    Scheduled3,
}

const WAYS: [Way; 6] = [
    Way::CoSimulation2,
    Way::ModelExchange2,
    Way::CoSimulation3 { has_events: false },
    Way::CoSimulation3 { has_events: true },
    Way::ModelExchange3,
    Way::Scheduled3,
];

impl Way {
    fn is_open_to(self, model: &Description) -> bool {
        match self {
            Self::CoSimulation2 | Self::CoSimulation3 { has_events: false } => true,
            Self::ModelExchange2 | Self::ModelExchange3 => model.offers_model_exchange(),
            Self::Scheduled3 | Self::CoSimulation3 { has_events: true } => model.is_sampled(),
        }
    }

    fn standard(self) -> Standard {
        match self {
            Self::CoSimulation2 | Self::ModelExchange2 => Standard::Fmi2,
            _ => Standard::Fmi3,
        }
    }

    fn instantiate(self, token: &CStr, logging_on: bool) -> *mut c_void {
        type Fixed =
            unsafe extern "C-unwind" fn(*mut c_void, *const c_char, i32, *const c_char, *const c_char);
        // SAFETY: as for the recording logger of the harness.
        let logger = unsafe { transmute::<Fixed, fmi2CallbackLogger>(logger2) };
        let functions = fmi2CallbackFunctions {
            logger: Some(logger),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: null_mut(),
        };
        let (name, token, log) = (c"short of memory".as_ptr(), token.as_ptr(), logging_on);
        let logger = Some(logger3 as _);
        // SAFETY: C strings, and loggers that need no environment.
        unsafe {
            match self {
                Self::CoSimulation2 => {
                    fmi2Instantiate(name, FMI2_CO_SIMULATION, token, null(), &functions, 0, log.into())
                }
                Self::ModelExchange2 => {
                    fmi2Instantiate(name, FMI2_MODEL_EXCHANGE, token, null(), &functions, 0, log.into())
                }
                Self::CoSimulation3 { has_events } => fmi3InstantiateCoSimulation(
                    name,
                    token,
                    null(),
                    0,
                    log.into(),
                    has_events.into(),
                    has_events.into(),
                    null(),
                    0,
                    null_mut(),
                    logger,
                    None,
                ),
                Self::ModelExchange3 => {
                    fmi3InstantiateModelExchange(name, token, null(), 0, log.into(), null_mut(), logger)
                }
                Self::Scheduled3 => fmi3InstantiateScheduledExecution(
                    name,
                    token,
                    null(),
                    0,
                    log.into(),
                    null_mut(),
                    logger,
                    None,
                    None,
                    None,
                ),
            }
        }
    }
}

/// The token of the model in the edition that offers most, with start values or without.
fn token(model: &'static Description, has_start_values: bool) -> CString {
    let mut values = StartValues::default();
    let rows = model.variables.iter().filter(|row| has_start_values && !row.is_calculated());
    for row in rows.filter(|row| matches!(row.kind, Kind::Real(_))) {
        values.set(model, row.name, row.start).unwrap();
    }
    CString::new(values.token(model, Edition::Clocked)).unwrap()
}

fn component(way: Way, model: &'static Description, handle: *mut c_void) -> Component {
    Component::from_handle(way.standard(), model.name, handle, Box::default())
}

/// Every model, every way to it.
fn all_ways() -> impl Iterator<Item = (&'static Description, Way)> {
    let models = models().map(|model| model.description);
    models.flat_map(|model| WAYS.into_iter().filter(|way| way.is_open_to(model)).map(move |way| (model, way)))
}

#[test]
fn every_allocation_of_instantiate_may_fail() {
    for (model, way) in all_ways() {
        for (has_start_values, logging_on) in [(false, false), (false, true), (true, false), (true, true)] {
            let token = token(model, has_start_values);
            let before = blocks();
            let mut failures = 0;
            let handle = loop {
                MESSAGES.set(0);
                let handle = with_memory_for(failures, || way.instantiate(&token, logging_on));
                if !handle.is_null() {
                    break handle;
                }
                assert_eq!(blocks(), before, "{} {way:?}: a leak at allocation {failures}", model.name);
                assert_says_out_of_memory(model.name);
                failures += 1;
            };
            assert!(failures >= 3, "{} {way:?}: {failures} allocations", model.name);
            let component = component(way, model, handle);
            component.initialise(0.0);
            drop(component);
            assert_eq!(blocks(), before, "{} {way:?}", model.name);
        }
    }
}

#[test]
fn tokens_are_refused_without_memory() {
    let model = MODELS[0].description;
    let own = model.token();
    for tail in [";", ";k1=1.0", ";17=one", ";4711=0.0", ";0=1.0", ";1=NaN"] {
        let token = CString::new(format!("{}{tail}", own.as_str())).unwrap();
        for way in [Way::CoSimulation2, Way::CoSimulation3 { has_events: false }] {
            MESSAGES.set(0);
            assert!(with_memory_for(0, || way.instantiate(&token, true)).is_null());
            let (count, status, text) = messages();
            assert_eq!((count, status), (1, ERROR), "{text}");
            assert!(!text.contains("memory"), "{text}");
        }
    }
}

#[test]
fn every_allocation_of_saved_states_may_fail() {
    for (model, way) in all_ways() {
        let component = component(way, model, way.instantiate(&token(model, false), false));
        component.initialise(0.0);
        let values = component.snapshot();
        let bytes = component.saved_bytes();
        let before = blocks();
        let mut state = null_mut();
        type Call<'a> = &'a dyn Fn(&mut *mut c_void) -> i32;
        let calls: [Call; 2] =
            [&|state: &mut *mut c_void| component.get_state(state), &|state: &mut *mut c_void| {
                component.deserialise_state(&bytes, state)
            }];
        for call in calls {
            MESSAGES.set(0);
            let mut failures = 0;
            while with_memory_for(failures, || call(&mut state)) != OK {
                assert!(state.is_null());
                assert_eq!(blocks(), before);
                assert_says_out_of_memory(model.name);
                failures += 1;
            }
            assert!(failures > 0 && !state.is_null());
            // A state in memory that is there already needs no more.
            assert_eq!(with_memory_for(0, || call(&mut state)), OK);
            assert_eq!(with_memory_for(0, || component.set_state(state)), OK);
            assert_eq!(component.snapshot(), values);
            assert_eq!(component.free_state(&mut state), OK);
            assert_eq!(blocks(), before);
        }
    }
}

#[test]
fn nothing_else_needs_memory() {
    for model in models().map(|model| model.description) {
        for standard in BOTH {
            let way = match standard {
                Standard::Fmi2 => Way::CoSimulation2,
                Standard::Fmi3 => Way::CoSimulation3 { has_events: false },
            };
            let component = component(way, model, way.instantiate(&token(model, true), true));
            let first_life = with_memory_for(0, || live(&component));
            assert_eq!(with_memory_for(0, || component.reset()), OK);
            assert_eq!(with_memory_for(0, || live(&component)), first_life, "{} {standard:?}", model.name);
        }
    }
}

/// A life with refusals; a sum over the bits of all values.
fn live(component: &Component) -> u64 {
    assert_eq!(component.enter_initialization(0.0, None), OK);
    assert_eq!(component.exit_initialization(), OK);
    let mut sum = 0u64;
    for k in 0..50 {
        let time = f64::from(k) * 1e-3;
        assert_eq!(component.set_reals(&[1], &[1e-3 * f64::from(k % 7)]), OK);
        assert_eq!(component.step(time, 1e-3), OK);
        assert_eq!(component.step(time, f64::NAN), ERROR);
        for reference in 0..component.description.variables.len() as u32 {
            sum = sum.wrapping_mul(31).wrapping_add(component.get_reference(reference).1.to_bits());
        }
    }
    assert_eq!(component.terminate(), OK);
    sum
}
