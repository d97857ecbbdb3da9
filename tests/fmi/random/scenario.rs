//! Which instance is made, and how.

use core::ffi::c_void;
use core::ptr::null;
use std::ffi::CString;

use maglev_fmu::fmi::fmi2::types::{FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, fmi2CallbackFunctions};
use maglev_fmu::fmi::fmi2::{fmi2FreeInstance, fmi2Instantiate};
use maglev_fmu::fmi::fmi3::types::{fmi3ClockUpdateCallback, fmi3IntermediateUpdateCallback};
use maglev_fmu::fmi::fmi3::*;
use maglev_fmu::model::ADDED_MODELS;

use super::super::harness::Standard;
use super::super::standard::{Interface, ModelDescription};
use super::dice::Dice;
use super::environment::in_host;
use super::log;

/// Parameter of sampled models.
pub const SAMPLE_TIME: &str = "sample_time";

/// A package and an interface type that it offers.
#[derive(Clone, Copy)]
pub struct Scenario {
    pub description: &'static ModelDescription,
    pub interface: Interface,
}

impl Scenario {
    /// All of the library's packages, in the same order as in [`Scenario::all`].
    pub fn packaged() -> Vec<Self> {
        Self::all().into_iter().filter(Self::is_packaged).collect()
    }

    /// Whether this is not of a model that a test adds.
    pub fn is_packaged(&self) -> bool {
        ADDED_MODELS.iter().all(|added| added.model.description.name != self.description.name)
    }

    /// All of all packages, then those of added models.
    pub fn all() -> Vec<Self> {
        let interfaces = [Interface::ModelExchange, Interface::CoSimulation, Interface::ScheduledExecution];
        let all = ModelDescription::all()
            .iter()
            .flat_map(|description| interfaces.map(|interface| Self { description, interface }));
        all.filter(|scenario| scenario.description.offers(scenario.interface.element())).collect()
    }

    pub fn name(&self) -> String {
        let Self { description, interface } = self;
        format!("{} {} {interface:?}", description.package, description.name)
    }

    /// Start value of the sample time \[s\], infinite for a model that has none.
    pub fn sample_time(&self) -> f64 {
        let variables = &self.description.variables;
        let found = variables.iter().find(|variable| variable.name == SAMPLE_TIME);
        found.and_then(|variable| variable.start).unwrap_or(f64::INFINITY)
    }

    /// Whether the package declares a capability for this interface type, or an attribute of its clocks.
    pub fn can(&self, capability: &str) -> bool {
        if capability == "intervalDecimal" {
            return self.description.variables.iter().any(|variable| variable.has_interval);
        }
        self.description.can(self.interface.element(), capability)
    }
}

impl Interface {
    /// Element of the model description.
    pub fn element(self) -> &'static str {
        match self {
            Self::ModelExchange => "ModelExchange",
            Self::CoSimulation => "CoSimulation",
            Self::ScheduledExecution => "ScheduledExecution",
        }
    }
}

/// What an importer chooses at instantiation.
#[derive(Clone, Debug)]
pub struct Choices {
    pub interface: Interface,
    pub has_logger: bool,
    pub logging_on: bool,
    /// eventModeUsed
    pub has_events: bool,
    pub may_return_early: bool,
    /// Whether callbacks other than the logger are given.
    pub has_callback: bool,
    /// requiredIntermediateVariables
    pub registered: Vec<u32>,
}

impl Choices {
    pub fn new(scenario: &Scenario, dice: &mut Dice) -> Self {
        let variables = &scenario.description.variables;
        let mut registered = Vec::new();
        for variable in variables.iter().filter(|variable| variable.may_be_updated) {
            if dice.percent(70) {
                registered.push(variable.reference);
            }
        }
        Self {
            interface: scenario.interface,
            has_logger: dice.percent(90),
            logging_on: dice.percent(80),
            has_events: scenario.can("hasEventMode") && dice.percent(60),
            may_return_early: dice.percent(60),
            has_callback: dice.percent(70),
            registered,
        }
    }
}

/// Makes an instance; null if the library refuses.
pub fn instantiate(
    scenario: &Scenario,
    choices: &Choices,
    environment: *mut c_void,
    intermediate_update: fmi3IntermediateUpdateCallback,
    clock_update: fmi3ClockUpdateCallback,
) -> *mut c_void {
    let token = CString::new(scenario.description.token.as_str()).unwrap();
    let (name, token) = (c"random".as_ptr(), token.as_ptr());
    let logging_on = choices.logging_on.into();
    let logger = choices.has_logger.then_some(log::fmi3_logger as _);
    // SAFETY: C strings, and an environment that outlives the instance.
    unsafe {
        match (scenario.description.standard, scenario.interface) {
            (Standard::Fmi2, interface) => {
                let functions = fmi2CallbackFunctions {
                    logger: choices.has_logger.then(log::fmi2_logger),
                    allocate_memory: None,
                    free_memory: None,
                    step_finished: None,
                    component_environment: environment,
                };
                let kind = if interface == Interface::ModelExchange {
                    FMI2_MODEL_EXCHANGE
                } else {
                    FMI2_CO_SIMULATION
                };
                in_host(|| {
                    fmi2Instantiate(name, kind, token, null(), &functions, 0, i32::from(choices.logging_on))
                })
            }
            (Standard::Fmi3, Interface::ModelExchange) => in_host(|| {
                fmi3InstantiateModelExchange(name, token, null(), 0, logging_on, environment, logger)
            }),
            (Standard::Fmi3, Interface::CoSimulation) => in_host(|| {
                fmi3InstantiateCoSimulation(
                    name,
                    token,
                    null(),
                    0,
                    logging_on,
                    choices.has_events.into(),
                    choices.may_return_early.into(),
                    choices.registered.as_ptr(),
                    choices.registered.len(),
                    environment,
                    logger,
                    choices.has_callback.then_some(intermediate_update),
                )
            }),
            (Standard::Fmi3, Interface::ScheduledExecution) => in_host(|| {
                fmi3InstantiateScheduledExecution(
                    name,
                    token,
                    null(),
                    0,
                    logging_on,
                    environment,
                    logger,
                    choices.has_callback.then_some(clock_update),
                    None,
                    None,
                )
            }),
        }
    }
}

/// Frees an instance; null is ignored.
///
/// # Safety
/// A live handle or null, dead afterwards.
pub unsafe fn free(standard: Standard, handle: *mut c_void) {
    // SAFETY: the caller's promise.
    unsafe {
        match standard {
            Standard::Fmi2 => in_host(|| fmi2FreeInstance(handle)),
            Standard::Fmi3 => in_host(|| fmi3FreeInstance(handle)),
        }
    }
}
