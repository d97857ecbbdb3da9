//! The bearing's two packages, and their loop as every experiment runs it.

use std::path::Path;

use super::StudyError;
use crate::fmi::FmiVersion;
use crate::host::{ExchangeOrder, Fmu, HostError, Instance, Logging, Trace, TwoUnitLoop, Value};

/// Variable and value.
pub type Parameter<'a> = (&'a str, Value<'a>);

/// Plant and controller, loaded.
pub struct BearingPackages {
    plant: Fmu,
    controller: Fmu,
}

impl BearingPackages {
    /// Opens the FMI 3.0 packages below `packages`.
    pub fn open(packages: &Path) -> Result<Self, HostError> {
        let open = |unit: &str| {
            Fmu::open(&packages.join(FmiVersion::Three.directory()).join(unit).with_extension("fmu"))
        };
        Ok(Self { plant: open("MagneticBearingPlant")?, controller: open("MagneticBearingController")? })
    }

    /// A plant with parameters, to be initialised.
    pub fn plant(&self, parameters: &[Parameter<'_>]) -> Result<Instance, HostError> {
        with_parameters(&self.plant, "plant", parameters)
    }

    /// Runs the loop, controller first, for `duration` \[s\] with a tick every `sample_time` \[s\]; the last row is at the
    /// end. The controller gets the sensor's reading and, for comparison without an observer, the true state.
    pub fn simulate(
        &self,
        plant: &[Parameter<'_>],
        controller: &[Parameter<'_>],
        record: &[(&str, &str)],
        sample_time: f64,
        duration: f64,
    ) -> Result<Trace, StudyError> {
        let plant = self.plant(plant)?;
        let mut controller = with_parameters(&self.controller, "controller", controller)?;
        controller.set_by_name("sample_time", sample_time)?;
        let mut control_loop = TwoUnitLoop::connect(
            controller,
            plant,
            ExchangeOrder::ControllerFirst,
            &[("position_measured", "position"), ("velocity", "state.velocity"), ("flux", "state.flux")],
            &[("voltage", "voltage")],
        )?;
        control_loop.record(record)?;
        control_loop.initialise(0.0, Some(duration), sample_time)?;
        Ok(control_loop.run((duration / sample_time).round() as usize + 1)?)
    }
}

fn with_parameters(fmu: &Fmu, name: &str, parameters: &[Parameter<'_>]) -> Result<Instance, HostError> {
    let mut instance = fmu.instantiate(name, Logging::Off)?;
    for (parameter, value) in parameters {
        instance.set_by_name(parameter, *value)?;
    }
    Ok(instance)
}
