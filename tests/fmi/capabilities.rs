//! What the model description declares works, and what it does not declare is refused: flag by flag, model by model.

use core::cell::Cell;
use core::ffi::c_void;
use core::ptr::{null, null_mut};

use maglev_fmu::fmi::fmi2::types::{FMI2_MODEL_EXCHANGE, fmi2CallbackFunctions};
use maglev_fmu::fmi::fmi2::*;
use maglev_fmu::fmi::fmi3::types::fmi3Boolean;
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::{Edition, editions, models};
use maglev_fmu::package::Capabilities;

use super::harness::clocked::{Choices, co_simulation_of};
use super::harness::{Component, OK, Phase, Recorder, Standard, token};

/// Whether something works on a model.
type Probe = fn(&str) -> bool;
/// Whether something works on an edition of a model.
type EditionProbe = fn(Edition, &str) -> bool;

fn stepped(standard: Standard, model: &str) -> Component {
    Component::in_phase(standard, model, Phase::Step)
}

/// Whether a call on an instance in step mode works.
fn works(standard: Standard, model: &str, call: unsafe fn(*mut c_void) -> i32) -> bool {
    let component = stepped(standard, model);
    // SAFETY: a live handle, valid arguments.
    let status = unsafe { call(component.handle) };
    // What is refused says that it is not offered, and why.
    assert!(status == OK || component.recorder.messages().last().unwrap().text.contains("not offered"));
    status == OK
}

fn saves(standard: Standard, model: &str) -> bool {
    let component = stepped(standard, model);
    let mut state = null_mut();
    let saved = component.get_state(&mut state) == OK && component.set_state(state) == OK;
    saved && component.free_state(&mut state) == OK
}

fn serialises(standard: Standard, model: &str) -> bool {
    let component = stepped(standard, model);
    component.restore_bytes(&component.saved_bytes()) == OK
}

/// Steps of different sizes.
fn varies(standard: Standard, model: &str) -> bool {
    let component = stepped(standard, model);
    let now = Component::STEPPED_TO;
    component.step(now, 1e-3) == OK && component.step(now + 1e-3, 0.37e-3) == OK
}

fn is_made(handle: *mut c_void) -> bool {
    // SAFETY: null or just made.
    unsafe { fmi3FreeInstance(handle) };
    !handle.is_null()
}

const EVENTS: Choices = Choices { event_mode: true, early_return: true, intermediate_update: None };

thread_local! {
    static CALLS: Cell<u32> = const { Cell::new(0) };
}

/// Counts, and asks for the end of the step.
unsafe extern "C-unwind" fn stop(
    _: *mut c_void,
    time: f64,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    _: fmi3Boolean,
    requested: *mut fmi3Boolean,
    return_time: *mut f64,
) {
    CALLS.set(CALLS.get() + 1);
    // SAFETY: the results are writable.
    unsafe {
        requested.write(1);
        return_time.write(time);
    }
}

/// Calls back within a step, and ends it when asked to.
fn calls_back(edition: Edition, model: &str) -> [bool; 2] {
    CALLS.set(0);
    let choices = Choices { early_return: true, intermediate_update: Some(stop), event_mode: false };
    let component = Component::co_simulation_of(edition, model, choices);
    component.initialise(0.0);
    let step = component.step_to_event(0.0, 0.1);
    assert_eq!(step.status, OK);
    [CALLS.get() > 0, step.is_early]
}

fn has_events(edition: Edition, model: &str) -> bool {
    let recorder = Recorder::default();
    is_made(co_simulation_of(edition, model, EVENTS, recorder.environment()))
}

/// Whether a tick is evaluated before the end of the event iteration; otherwise the call has to be ignored.
fn evaluates_discrete_states(edition: Edition, model: &str) -> bool {
    if !has_events(edition, model) {
        return false;
    }
    let component = Component::co_simulation_of(edition, model, EVENTS);
    component.initialise(0.0);
    assert_eq!(component.set_clock(component.clocks()[0], 1), OK);
    let before = component.saved_bytes();
    // SAFETY: a live handle.
    assert_eq!(unsafe { fmi3EvaluateDiscreteStates(component.handle) }, OK);
    component.saved_bytes() != before
}

fn is_schedulable(edition: Edition, model: &str) -> bool {
    let token = token(model, edition);
    let (name, token) = (c"x".as_ptr(), token.as_ptr());
    // SAFETY: C strings, nothing else.
    is_made(unsafe {
        fmi3InstantiateScheduledExecution(name, token, null(), 0, 0, null_mut(), None, None, None, None)
    })
}

#[test]
fn flags_of_fmi3_tell_the_truth() {
    use Standard::Fmi3;
    type Flag = (&'static str, fn(&Capabilities) -> bool, EditionProbe);
    let flags: [Flag; 13] = [
        ("canGetAndSetFMUState", |can| can.can_get_and_set_fmu_state, |_, model| saves(Fmi3, model)),
        ("canSerializeFMUState", |can| can.can_serialize_fmu_state, |_, model| serialises(Fmi3, model)),
        (
            "canHandleVariableCommunicationStepSize",
            |can| can.can_handle_variable_communication_step_size,
            |_, model| varies(Fmi3, model),
        ),
        (
            "providesDirectionalDerivatives",
            |can| can.provides_directional_derivatives,
            |_, model| {
                works(Fmi3, model, |c| unsafe {
                    fmi3GetDirectionalDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0)
                })
            },
        ),
        (
            "providesAdjointDerivatives",
            |can| can.provides_adjoint_derivatives,
            |_, model| {
                works(Fmi3, model, |c| unsafe {
                    fmi3GetAdjointDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0)
                })
            },
        ),
        (
            "providesPerElementDependencies",
            |can| can.provides_per_element_dependencies,
            |_, model| works(Fmi3, model, |c| unsafe { fmi3GetNumberOfVariableDependencies(c, 2, &mut 0) }),
        ),
        (
            "maxOutputDerivativeOrder",
            |can| can.max_output_derivative_order > 0,
            |_, model| {
                works(Fmi3, model, |c| unsafe {
                    fmi3GetOutputDerivatives(c, null(), 0, null(), null_mut(), 0)
                })
            },
        ),
        (
            "providesIntermediateUpdate",
            |can| can.provides_intermediate_update,
            |edition, model| calls_back(edition, model)[0],
        ),
        (
            "canReturnEarlyAfterIntermediateUpdate",
            |can| can.can_return_early_after_intermediate_update,
            |edition, model| calls_back(edition, model)[1],
        ),
        ("hasEventMode", |can| can.has_event_mode, has_events),
        (
            "mightReturnEarlyFromDoStep",
            |can| can.might_return_early_from_do_step,
            |edition, model| {
                if !has_events(edition, model) {
                    return calls_back(edition, model)[1];
                }
                let component = Component::co_simulation_of(edition, model, EVENTS);
                component.initialise(0.0);
                component.settle_event();
                component.enter_step_mode();
                component.step_to_event(0.0, 0.1).is_early
            },
        ),
        (
            "providesEvaluateDiscreteStates",
            |can| can.provides_evaluate_discrete_states,
            evaluates_discrete_states,
        ),
        ("ScheduledExecution", |can| can.offers_scheduled_execution, is_schedulable),
    ];
    for (model, edition) in editions() {
        let can = Capabilities::of(model.description, edition);
        for (flag, declared, probe) in flags {
            let name = model.description.name;
            assert_eq!(probe(edition, name), declared(&can), "{name}, {edition:?}: {flag}");
        }
    }
}

#[test]
fn flags_of_fmi2_tell_the_truth() {
    use Standard::Fmi2;
    type Flag = (&'static str, fn(&Capabilities) -> bool, Probe);
    let flags: [Flag; 7] = [
        ("canGetAndSetFMUstate", |can| can.can_get_and_set_fmu_state, |model| saves(Fmi2, model)),
        ("canSerializeFMUstate", |can| can.can_serialize_fmu_state, |model| serialises(Fmi2, model)),
        (
            "canHandleVariableCommunicationStepSize",
            |can| can.can_handle_variable_communication_step_size,
            |model| varies(Fmi2, model),
        ),
        (
            "providesDirectionalDerivative",
            |can| can.provides_directional_derivatives,
            |model| {
                works(Fmi2, model, |c| unsafe {
                    fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut())
                })
            },
        ),
        (
            "canInterpolateInputs",
            |can| can.can_interpolate_inputs,
            |model| {
                works(Fmi2, model, |c| unsafe { fmi2SetRealInputDerivatives(c, null(), 0, null(), null()) })
            },
        ),
        (
            "maxOutputDerivativeOrder",
            |can| can.max_output_derivative_order > 0,
            |model| {
                works(Fmi2, model, |c| unsafe {
                    fmi2GetRealOutputDerivatives(c, null(), 0, null(), null_mut())
                })
            },
        ),
        // A step that went on in the background could be cancelled.
        (
            "canRunAsynchronuously",
            |can| can.can_run_asynchronously,
            |model| {
                let component = stepped(Fmi2, model);
                component.step(Component::STEPPED_TO, 1e-3);
                // SAFETY: a live handle.
                unsafe { fmi2CancelStep(component.handle) == OK }
            },
        ),
    ];
    for model in models() {
        let can = Capabilities::of(model.description, Edition::Plain);
        for (flag, declared, probe) in flags {
            let name = model.description.name;
            assert_eq!(probe(name), declared(&can), "{name}: {flag}");
        }
    }
}

#[test]
fn model_exchange_is_offered_where_it_is_declared() {
    for model in models() {
        let token = token(model.description.name, Edition::Plain);
        let (name, token) = (c"x".as_ptr(), token.as_ptr());
        let functions = fmi2CallbackFunctions {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: null_mut(),
        };
        // SAFETY: C strings, no callbacks.
        unsafe {
            let three = fmi3InstantiateModelExchange(name, token, null(), 0, 0, null_mut(), None);
            let two = fmi2Instantiate(name, FMI2_MODEL_EXCHANGE, token, null(), &functions, 0, 0);
            let offered = model.description.offers_model_exchange();
            assert_eq!([!two.is_null(), !three.is_null()], [offered; 2], "{}", model.description.name);
            fmi2FreeInstance(two);
            fmi3FreeInstance(three);
        }
    }
}
