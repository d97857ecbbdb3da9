//! Instances for model exchange and what an importer does with them.

use core::ffi::c_void;
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::{FMI2_MODEL_EXCHANGE, fmi2CallbackFunctions, fmi2EventInfo};
use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::{Description, models};

use super::{BOTH, Component, OK, Recorder, Standard, description, fmi2_logger, fmi3_logger};

/// Every combination of standard and plant.
pub fn plants() -> impl Iterator<Item = (Standard, &'static str)> {
    let is_plant = |description: &&Description| description.offers_model_exchange();
    let plants = models().map(|model| model.description).filter(is_plant).map(|plant| plant.name);
    plants.flat_map(|plant| BOTH.map(|standard| (standard, plant)))
}

impl Component {
    /// An instance for model exchange.
    pub fn exchanged(standard: Standard, model: &str) -> Self {
        let recorder = Box::new(Recorder::default());
        let (environment, name) = (recorder.environment(), c"under test".as_ptr());
        let token = CString::new(description(model).token().as_str()).unwrap();
        let functions = fmi2CallbackFunctions {
            logger: Some(fmi2_logger()),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: environment,
        };
        let none = core::ptr::null();
        // SAFETY: C strings and callbacks that live long enough.
        let handle: *mut c_void = unsafe {
            match standard {
                Standard::Fmi2 => {
                    fmi2Instantiate(name, FMI2_MODEL_EXCHANGE, token.as_ptr(), none, &functions, 0, 1)
                }
                Standard::Fmi3 => fmi3InstantiateModelExchange(
                    name,
                    token.as_ptr(),
                    none,
                    0,
                    1,
                    environment,
                    Some(fmi3_logger),
                ),
            }
        };
        assert!(!handle.is_null(), "{standard:?} {model}: {:?}", recorder.messages());
        Self::from_handle(standard, model, handle, recorder)
    }

    /// As [`Component::exchanged`], in continuous-time mode at t = 0.
    pub fn in_continuous_time(standard: Standard, model: &str) -> Self {
        let component = Self::exchanged(standard, model);
        component.initialise(0.0);
        component.update_discrete_states();
        assert_eq!(component.enter_continuous_time(), OK);
        component.recorder.clear();
        component
    }

    pub fn enter_event_mode(&self) -> i32 {
        self.plain(fmi2EnterEventMode, fmi3EnterEventMode)
    }

    pub fn enter_continuous_time(&self) -> i32 {
        self.plain(fmi2EnterContinuousTimeMode, fmi3EnterContinuousTimeMode)
    }

    /// Whether a state jumped.
    #[track_caller]
    pub fn update_discrete_states(&self) -> bool {
        let (status, has_jumped) = self.try_update_discrete_states();
        assert_eq!(status, OK, "{:?}", self.recorder.messages());
        has_jumped
    }

    /// Status, and whether a state jumped.
    pub fn try_update_discrete_states(&self) -> (i32, bool) {
        let (status, has_jumped, _) = self.event_iteration();
        (status, has_jumped)
    }

    /// Status, whether a state jumped, and the time of the next event \[s\]; nothing else is ever wanted of the importer.
    pub fn event_iteration(&self) -> (i32, bool, Option<f64>) {
        // SAFETY: a live handle; all results have room.
        unsafe {
            match self.standard {
                Standard::Fmi2 => {
                    let mut info = fmi2EventInfo {
                        new_discrete_states_needed: 0,
                        terminate_simulation: 0,
                        nominals_of_continuous_states_changed: 0,
                        values_of_continuous_states_changed: 0,
                        next_event_time_defined: 0,
                        next_event_time: 0.0,
                    };
                    let status = fmi2NewDiscreteStates(self.handle, &mut info);
                    let quiet = [
                        info.new_discrete_states_needed,
                        info.terminate_simulation,
                        info.nominals_of_continuous_states_changed,
                    ];
                    assert_eq!(quiet, [0; 3]);
                    let next = (info.next_event_time_defined != 0).then_some(info.next_event_time);
                    (status, info.values_of_continuous_states_changed != 0, next)
                }
                Standard::Fmi3 => {
                    let (mut needed, mut terminate, mut nominals, mut changed, mut defined) = (0, 0, 0, 0, 0);
                    let mut next = 0.0;
                    let status = fmi3UpdateDiscreteStates(
                        self.handle,
                        &mut needed,
                        &mut terminate,
                        &mut nominals,
                        &mut changed,
                        &mut defined,
                        &mut next,
                    );
                    assert_eq!([needed, terminate, nominals], [0; 3]);
                    (status, changed != 0, (defined != 0).then_some(next))
                }
            }
        }
    }

    /// No model has step events, nor ends a simulation.
    pub fn complete_integrator_step(&self) -> i32 {
        // SAFETY: a live handle, room for the results.
        let (status, results) = unsafe {
            match self.standard {
                Standard::Fmi2 => {
                    let mut results = [7; 2];
                    let [event, end] = &mut results;
                    (
                        fmi2CompletedIntegratorStep(self.handle, 1, event, end),
                        results.map(|result| result != 0),
                    )
                }
                Standard::Fmi3 => {
                    let mut results = [7; 2];
                    let [event, end] = &mut results;
                    (
                        fmi3CompletedIntegratorStep(self.handle, 1, event, end),
                        results.map(|result| result != 0),
                    )
                }
            }
        };
        assert!(status != OK || results == [false; 2]);
        status
    }

    pub fn set_time(&self, time: f64) -> i32 {
        // SAFETY: a live handle.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SetTime(self.handle, time),
                Standard::Fmi3 => fmi3SetTime(self.handle, time),
            }
        }
    }

    pub fn state_count(&self) -> usize {
        self.description.continuous_states().count()
    }

    pub fn set_states(&self, states: &[f64]) -> i32 {
        // SAFETY: a live handle, as many states as said.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2SetContinuousStates(self.handle, states.as_ptr(), states.len()),
                Standard::Fmi3 => fmi3SetContinuousStates(self.handle, states.as_ptr(), states.len()),
            }
        }
    }

    #[track_caller]
    pub fn states(&self) -> Vec<f64> {
        self.vector(self.state_count(), fmi2GetContinuousStates, fmi3GetContinuousStates)
    }

    #[track_caller]
    pub fn derivatives(&self) -> Vec<f64> {
        self.vector(self.state_count(), fmi2GetDerivatives, fmi3GetContinuousStateDerivatives)
    }

    #[track_caller]
    pub fn event_indicators(&self) -> Vec<f64> {
        let count = self.description.event_indicators().count();
        self.vector(count, fmi2GetEventIndicators, fmi3GetEventIndicators)
    }

    #[track_caller]
    pub fn nominals(&self) -> Vec<f64> {
        self.vector(self.state_count(), fmi2GetNominalsOfContinuousStates, fmi3GetNominalsOfContinuousStates)
    }

    #[track_caller]
    fn vector(
        &self,
        count: usize,
        fmi2: unsafe extern "C-unwind" fn(*mut c_void, *mut f64, usize) -> i32,
        fmi3: unsafe extern "C-unwind" fn(*mut c_void, *mut f64, usize) -> i32,
    ) -> Vec<f64> {
        let mut values = vec![f64::NAN; count];
        let function = if self.standard == Standard::Fmi2 { fmi2 } else { fmi3 };
        // SAFETY: a live handle, as much room as said.
        let status = unsafe { function(self.handle, values.as_mut_ptr(), count) };
        assert_eq!(status, OK, "{:?}", self.recorder.messages());
        values
    }

    /// How `unknowns` move when `knowns` move along `seed`.
    pub fn directional(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> i32 {
        let (u, k, s) = (unknowns.as_ptr(), knowns.as_ptr(), seed.as_ptr());
        let (nu, nk, result) = (unknowns.len(), knowns.len(), sensitivity.as_mut_ptr());
        assert_eq!((seed.len(), sensitivity.len()), (nk, nu));
        // SAFETY: a live handle, arrays of these lengths.
        unsafe {
            match self.standard {
                Standard::Fmi2 => fmi2GetDirectionalDerivative(self.handle, u, nu, k, nk, s, result),
                Standard::Fmi3 => fmi3GetDirectionalDerivative(self.handle, u, nu, k, nk, s, nk, result, nu),
            }
        }
    }

    /// Partial derivative of one variable with respect to another.
    #[track_caller]
    pub fn partial(&self, unknown: u32, known: u32) -> f64 {
        let mut result = [f64::NAN];
        let status = self.directional(&[unknown], &[known], &[1.0], &mut result);
        assert_eq!(status, OK, "{:?}", self.recorder.messages());
        result[0]
    }

    /// Slope of an output at the end of the last step.
    #[track_caller]
    pub fn output_slope(&self, output: u32) -> f64 {
        let mut result = [f64::NAN];
        let status = self.try_output_slope(output, &mut result);
        assert_eq!(status, OK, "{:?}", self.recorder.messages());
        result[0]
    }

    /// As [`Component::output_slope`], with the status.
    pub fn try_output_slope(&self, output: u32, result: &mut [f64; 1]) -> i32 {
        // SAFETY: a live handle, arrays of one element.
        unsafe {
            match self.standard {
                Standard::Fmi2 => {
                    fmi2GetRealOutputDerivatives(self.handle, &output, 1, &1, result.as_mut_ptr())
                }
                Standard::Fmi3 => {
                    fmi3GetOutputDerivatives(self.handle, &output, 1, &1, result.as_mut_ptr(), 1)
                }
            }
        }
    }
}
