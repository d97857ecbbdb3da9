//! Instances of FMI 3.0 that tick at events, on activation, or with callbacks within steps.

use core::ffi::c_void;
use core::ptr::null;

use maglev_fmu::fmi::fmi3::types::*;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::{Edition, models};

use super::{Component, OK, Recorder, Standard, fmi3_logger, token};

/// Names of all models that tick.
pub fn sampled_models() -> impl Iterator<Item = &'static str> {
    models().map(|model| model.description).filter(|model| model.is_sampled()).map(|model| model.name)
}

/// What fmi3DoStep tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub status: i32,
    pub is_event: bool,
    pub is_early: bool,
    pub reached: f64,
}

/// What fmi3UpdateDiscreteStates tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    pub status: i32,
    pub is_unfinished: bool,
    pub next_event_time: Option<f64>,
}

/// Choices of fmi3InstantiateCoSimulation; the environment belongs to the logger and to the callback.
#[derive(Clone, Copy, Default)]
pub struct Choices {
    pub event_mode: bool,
    pub early_return: bool,
    pub intermediate_update: Option<fmi3IntermediateUpdateCallback>,
}

/// A callback of intermediate update that sets nothing and goes on with the step.
pub unsafe extern "C-unwind" fn go_on(
    _: *mut c_void,
    _: f64,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: *mut fmi3Boolean,
    _: *mut f64,
) {
}

impl Component {
    /// A co-simulation instance that knows the model's clocks; its recorder is the environment of the callback.
    pub fn co_simulation(model: &str, choices: Choices) -> Self {
        Self::co_simulation_of(Edition::Clocked, model, choices)
    }

    /// As [`Component::co_simulation`], of any edition.
    pub fn co_simulation_of(edition: Edition, model: &str, choices: Choices) -> Self {
        let recorder = Box::new(Recorder::default());
        let environment = recorder.environment();
        let handle = co_simulation_of(edition, model, choices, environment);
        assert!(!handle.is_null(), "{model}: {:?}", recorder.messages());
        Self::from_handle(Standard::Fmi3, model, handle, recorder)
    }

    pub fn scheduled(model: &str, clock_update: Option<fmi3ClockUpdateCallback>) -> Self {
        let recorder = Box::new(Recorder::default());
        let token = token(model, Edition::Clocked);
        // SAFETY: C strings, a recorder that outlives the instance; nothing else is given.
        let handle = unsafe {
            let (name, environment, log) = (c"scheduled".as_ptr(), recorder.environment(), fmi3_logger as _);
            fmi3InstantiateScheduledExecution(
                name,
                token.as_ptr(),
                null(),
                0,
                1,
                environment,
                Some(log),
                clock_update,
                None,
                None,
            )
        };
        assert!(!handle.is_null(), "{model}: {:?}", recorder.messages());
        Self::from_handle(Standard::Fmi3, model, handle, recorder)
    }

    /// Value references of the clocks `tick` and `ticked`.
    pub fn clocks(&self) -> [u32; 2] {
        let count = self.description.variables.len() as u32;
        [count, count + 1]
    }

    pub fn step_to_event(&self, time: f64, step_size: f64) -> Step {
        let (mut event, mut terminate, mut early, mut reached) = (7, 7, 7, f64::NAN);
        // SAFETY: a live handle, room for the results.
        let status = unsafe {
            fmi3DoStep(self.handle, time, step_size, 1, &mut event, &mut terminate, &mut early, &mut reached)
        };
        assert!(status != OK || terminate == 0);
        Step { status, is_event: event != 0, is_early: early != 0, reached }
    }

    pub fn enter_step_mode(&self) -> i32 {
        // SAFETY: a live handle.
        unsafe { fmi3EnterStepMode(self.handle) }
    }

    pub fn end_event_iteration(&self) -> Update {
        let (mut need, mut terminate, mut nominals, mut states, mut defined) = (7, 7, 7, 7, 7);
        let mut next = f64::NAN;
        // SAFETY: a live handle, room for the results.
        let status = unsafe {
            fmi3UpdateDiscreteStates(
                self.handle,
                &mut need,
                &mut terminate,
                &mut nominals,
                &mut states,
                &mut defined,
                &mut next,
            )
        };
        if status == OK {
            assert_eq!((terminate, nominals, states), (0, 0, 0));
        }
        Update { status, is_unfinished: need == 1, next_event_time: (defined == 1).then_some(next) }
    }

    /// Event iterations until there is nothing left to do; the time of the next event.
    pub fn settle_event(&self) -> f64 {
        loop {
            let update = self.end_event_iteration();
            assert_eq!(update.status, OK, "{:?}", self.recorder.messages());
            if !update.is_unfinished {
                return update.next_event_time.unwrap();
            }
        }
    }

    pub fn get_clock(&self, reference: u32) -> (i32, u8) {
        let mut value = 7;
        // SAFETY: a live handle, one reference, room for one value.
        let status = unsafe { fmi3GetClock(self.handle, &reference, 1, &mut value) };
        (status, value)
    }

    pub fn set_clock(&self, reference: u32, value: u8) -> i32 {
        // SAFETY: a live handle, one reference, one value.
        unsafe { fmi3SetClock(self.handle, &reference, 1, &value) }
    }

    pub fn activate(&self, time: f64) -> i32 {
        // SAFETY: a live handle.
        unsafe { fmi3ActivateModelPartition(self.handle, self.clocks()[0], time) }
    }
}

/// As [`Component::co_simulation`], null if refused.
pub fn co_simulation(model: &str, choices: Choices, environment: *mut c_void) -> fmi3Instance {
    co_simulation_of(Edition::Clocked, model, choices, environment)
}

/// As [`Component::co_simulation_of`], null if refused.
pub fn co_simulation_of(
    edition: Edition,
    model: &str,
    choices: Choices,
    environment: *mut c_void,
) -> fmi3Instance {
    let token = token(model, edition);
    // SAFETY: C strings; the callers keep the environment alive.
    unsafe {
        fmi3InstantiateCoSimulation(
            c"clocked".as_ptr(),
            token.as_ptr(),
            null(),
            0,
            1,
            choices.event_mode.into(),
            choices.early_return.into(),
            &1,
            1,
            environment,
            Some(fmi3_logger),
            choices.intermediate_update,
        )
    }
}
