//! The two packages of a system, and their loop as every experiment runs it.

use std::path::Path;

use super::StudyError;
use super::run::Run;
use crate::fmi::FmiVersion;
use crate::host::{ControlLoop, ExchangeOrder, Fmu, HostError, Instance, Logging, Value};
use crate::model::{ModelType, System};

/// Variable and value.
pub type Parameter<'a> = (&'a str, Value<'a>);

/// Plant and controller, loaded.
pub struct LoopPackages {
    system: &'static System,
    plant: Fmu,
    controller: Fmu,
}

impl LoopPackages {
    /// Opens the system's FMI 3.0 packages below `packages`.
    pub fn open(packages: &Path, system: &'static System) -> Result<Self, HostError> {
        let open = |model: &ModelType| {
            let folder = packages.join(FmiVersion::Three.directory());
            Fmu::open(&folder.join(model.description.name).with_extension("fmu"))
        };
        Ok(Self { system, plant: open(system.plant)?, controller: open(system.controller)? })
    }

    /// A plant with parameters, to be initialised.
    pub fn plant(&self, parameters: &[Parameter<'_>]) -> Result<Instance, HostError> {
        with_parameters(&self.plant, "plant", parameters)
    }

    /// A controller with parameters, to be initialised.
    pub fn controller(&self, parameters: &[Parameter<'_>]) -> Result<Instance, HostError> {
        with_parameters(&self.controller, "controller", parameters)
    }

    /// Both with parameters, wired, the controller to go first and to tick every `sample_time` \[s\]; to be initialised.
    pub fn connect(
        &self,
        plant: &[Parameter<'_>],
        controller: &[Parameter<'_>],
        sample_time: f64,
    ) -> Result<ControlLoop, HostError> {
        let (plant, mut controller) = (self.plant(plant)?, self.controller(controller)?);
        controller.set_by_name("sample_time", sample_time)?;
        let System { sensing, actuation, .. } = self.system;
        ControlLoop::connect(controller, plant, ExchangeOrder::ControllerFirst, sensing, actuation)
    }

    /// Runs the loop, controller first, for `duration` \[s\] with a tick every `sample_time` \[s\]; the last row is at the
    /// end.
    pub fn simulate(
        &self,
        plant: &[Parameter<'_>],
        controller: &[Parameter<'_>],
        record: &[(&str, &str)],
        sample_time: f64,
        duration: f64,
    ) -> Result<Run, StudyError> {
        self.simulate_with(plant, controller, record, sample_time, duration, |_, _, _| Ok(()))
    }

    /// As [`LoopPackages::simulate`], with a `stimulus(time, controller, plant)` before every step: the place to move a
    /// reference or to disturb the plant.
    pub fn simulate_with(
        &self,
        plant: &[Parameter<'_>],
        controller: &[Parameter<'_>],
        record: &[(&str, &str)],
        sample_time: f64,
        duration: f64,
        stimulus: impl FnMut(f64, &mut Instance, &mut Instance) -> Result<(), HostError>,
    ) -> Result<Run, StudyError> {
        let mut control_loop = self.connect(plant, controller, sample_time)?;
        control_loop.record(record)?;
        // The last row, at the end, belongs to a step that begins there.
        let steps = (duration / sample_time).round() as usize + 1;
        control_loop.initialise(0.0, Some(steps as f64 * sample_time), sample_time)?;
        Ok(control_loop.run_with(steps, stimulus)?.into())
    }
}

fn with_parameters(fmu: &Fmu, name: &str, parameters: &[Parameter<'_>]) -> Result<Instance, HostError> {
    let mut instance = fmu.instantiate(name, Logging::Off)?;
    for (parameter, value) in parameters {
        instance.set_by_name(parameter, *value)?;
    }
    Ok(instance)
}
