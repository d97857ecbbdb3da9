//! The exported functions called as a C importer does, both standards behind one interface.

mod access;
pub mod clocked;
mod exchange;
mod instantiate;
mod recorder;
mod state;

use core::ffi::c_void;
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::fmi2Boolean;
use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::types::fmi3Boolean;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::variable::Causality;
use maglev_fmu::model::{Description, Edition, models};

pub use exchange::plants;
pub use instantiate::{instantiate, instantiate_with};
pub use recorder::{Message, Recorder, fmi2_logger, fmi3_logger};
pub use state::State;

pub const PLANT: &str = "MagneticBearingPlant";
pub const CONTROLLER: &str = "MagneticBearingController";

pub const OK: i32 = 0;
pub const DISCARD: i32 = 2;
pub const ERROR: i32 = 3;
pub const FATAL: i32 = 4;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standard {
    Fmi2,
    Fmi3,
}

pub const BOTH: [Standard; 2] = [Standard::Fmi2, Standard::Fmi3];

/// Every combination of standard and model.
pub fn all() -> impl Iterator<Item = (Standard, &'static str)> {
    let names = models().map(|model| model.description.name);
    BOTH.into_iter().flat_map(move |standard| names.clone().map(move |model| (standard, model)))
}

/// The bearing's models under both standards, for tests that name their variables.
pub fn bearing() -> impl Iterator<Item = (Standard, &'static str)> {
    BOTH.into_iter().flat_map(|standard| [PLANT, CONTROLLER].map(|model| (standard, model)))
}

/// Phases that an importer can bring an instance into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    Instantiated,
    Initialization,
    Step,
    Terminated,
}

pub const PHASES: [Phase; 4] = [Phase::Instantiated, Phase::Initialization, Phase::Step, Phase::Terminated];

impl Phase {
    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::Step => "step mode",
            Self::Terminated => "terminated",
        }
    }
}

/// Instantiation token of an edition of a model.
pub fn token(model: &str, edition: Edition) -> CString {
    CString::new(edition.token(description(model)).as_str()).unwrap()
}

pub fn description(model: &str) -> &'static Description {
    models().find(|known| known.description.name == model).expect("a model").description
}

/// An instance with a recording logger. Freed when dropped.
pub struct Component {
    pub standard: Standard,
    pub description: &'static Description,
    pub handle: *mut c_void,
    pub recorder: Box<Recorder>,
}

// SAFETY: both standards bind an instance to no thread, they only forbid concurrent calls; not `Sync`.
unsafe impl Send for Component {}

impl Component {
    /// An instance called `under test` with logging on.
    pub fn new(standard: Standard, model: &str) -> Self {
        Self::with_logging(standard, model, true)
    }

    pub fn with_logging(standard: Standard, model: &str, logging_on: bool) -> Self {
        let recorder = Box::new(Recorder::default());
        let token = token(model, Edition::Plain);
        // SAFETY: C strings and callbacks that live long enough.
        let handle = unsafe {
            instantiate(standard, c"under test".as_ptr(), token.as_ptr(), recorder.environment(), logging_on)
        };
        assert!(!handle.is_null(), "{standard:?} {model}: {:?}", recorder.messages());
        Self { standard, description: description(model), handle, recorder }
    }

    /// Around an instance that was made elsewhere.
    pub fn from_handle(
        standard: Standard,
        model: &str,
        handle: *mut c_void,
        recorder: Box<Recorder>,
    ) -> Self {
        Self { standard, description: description(model), handle, recorder }
    }

    /// A new instance brought into `phase`, with an empty log. In the last two phases some steps were done.
    pub fn in_phase(standard: Standard, model: &str, phase: Phase) -> Self {
        let component = Self::new(standard, model);
        if phase != Phase::Instantiated {
            assert_eq!(component.enter_initialization(0.0, None), OK);
        }
        if matches!(phase, Phase::Step | Phase::Terminated) {
            assert_eq!(component.exit_initialization(), OK);
            let mut variables = component.description.variables.iter();
            let input = variables.find(|variable| variable.causality == Causality::Input).unwrap().name;
            for k in 0..5 {
                assert_eq!(component.set(input, 1e-3 * f64::from(k)), OK);
                assert_eq!(component.step(f64::from(k) * 1e-3, 1e-3), OK);
            }
        }
        if phase == Phase::Terminated {
            assert_eq!(component.terminate(), OK);
        }
        component.recorder.clear();
        component
    }

    /// Time at which an instance made by [`Component::in_phase`] stands in step mode.
    pub const STEPPED_TO: f64 = 4.0 * 1e-3 + 1e-3;

    pub fn enter_initialization(&self, start_time: f64, stop_time: Option<f64>) -> i32 {
        let (stop, has_stop) = (stop_time.unwrap_or(0.0), stop_time.is_some());
        // SAFETY: a live handle.
        unsafe {
            match self.standard {
                Standard::Fmi2 => {
                    match fmi2SetupExperiment(
                        self.handle,
                        0,
                        0.0,
                        start_time,
                        fmi2Boolean::from(has_stop),
                        stop,
                    ) {
                        OK => fmi2EnterInitializationMode(self.handle),
                        status => status,
                    }
                }
                Standard::Fmi3 => fmi3EnterInitializationMode(
                    self.handle,
                    0,
                    0.0,
                    start_time,
                    fmi3Boolean::from(has_stop),
                    stop,
                ),
            }
        }
    }

    pub fn exit_initialization(&self) -> i32 {
        self.plain(fmi2ExitInitializationMode, fmi3ExitInitializationMode)
    }

    /// Ready to step from `start_time`.
    pub fn initialise(&self, start_time: f64) {
        assert_eq!(self.enter_initialization(start_time, None), OK);
        assert_eq!(self.exit_initialization(), OK);
    }

    pub fn terminate(&self) -> i32 {
        self.plain(fmi2Terminate, fmi3Terminate)
    }

    pub fn reset(&self) -> i32 {
        self.plain(fmi2Reset, fmi3Reset)
    }

    #[inline]
    pub fn step(&self, time: f64, step_size: f64) -> i32 {
        // SAFETY: a live handle; the results of FMI 3.0 have room.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2DoStep(self.handle, time, step_size, 1),
                Standard::Fmi3 => {
                    let (mut event, mut terminate, mut early, mut reached) = (0, 0, 0, 0.0);
                    fmi3DoStep(
                        self.handle,
                        time,
                        step_size,
                        1,
                        &mut event,
                        &mut terminate,
                        &mut early,
                        &mut reached,
                    )
                }
            }
        }
    }

    pub fn plain(
        &self,
        fmi2: unsafe extern "C-unwind" fn(*mut c_void) -> i32,
        fmi3: unsafe extern "C-unwind" fn(*mut c_void) -> i32,
    ) -> i32 {
        // SAFETY: a live handle.
        unsafe { if self.standard == Standard::Fmi2 { fmi2(self.handle) } else { fmi3(self.handle) } }
    }

    /// Asserts that `status` is Error and that the one new message says so with all of `fragments`.
    #[track_caller]
    pub fn assert_refused(&self, status: i32, fragments: &[&str]) {
        let messages = self.recorder.take();
        assert_eq!(status, ERROR, "{messages:?}");
        assert_eq!(messages.len(), 1, "{messages:?}");
        let Message { status, category, text, .. } = &messages[0];
        assert_eq!((*status, category.as_str()), (ERROR, "logStatusError"));
        for fragment in fragments {
            assert!(text.contains(fragment), "\"{text}\" lacks \"{fragment}\"");
        }
    }
}

impl Drop for Component {
    fn drop(&mut self) {
        // SAFETY: a live handle, freed once.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2FreeInstance(self.handle),
                Standard::Fmi3 => fmi3FreeInstance(self.handle),
            }
        }
    }
}
