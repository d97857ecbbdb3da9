//! A defect inside a model stays inside the instance.

use maglev_fmu::fmi::{Callback, Instance, Interface, Logger};
use maglev_fmu::model::{Description, LogSink, MagneticBearingPlant, Model, ModelError};
use serde::{Deserialize, Serialize};

use super::harness::{
    BOTH, Component, ERROR, FATAL, OK, PLANT, Recorder, Standard, fmi2_logger, fmi3_logger,
};

/// The plant, with a defect that shows in the third step.
#[derive(Clone, Serialize, Deserialize)]
struct Defective {
    plant: MagneticBearingPlant,
    steps: u32,
}

impl Model for Defective {
    fn description(&self) -> &'static Description {
        self.plant.description()
    }
    fn values(&self) -> &[f64] {
        self.plant.values()
    }
    fn values_mut(&mut self) -> &mut [f64] {
        self.plant.values_mut()
    }
    fn apply_tunable_parameters(&mut self) {}
    fn initialise(&mut self, start_time: f64) -> Result<(), ModelError> {
        self.plant.initialise(start_time)
    }
    fn check_step(&self, _: f64) -> Result<(), ModelError> {
        Ok(())
    }

    fn advance(&mut self, duration: f64, sink: &mut dyn LogSink) -> Result<(), ModelError> {
        self.steps += 1;
        assert!(self.steps < 3, "deliberate");
        self.plant.advance(duration, sink)
    }
}

/// A defective instance behind the boundary.
fn defective(standard: Standard, logging_on: bool) -> Component {
    let recorder = Box::<Recorder>::default();
    let callback = match standard {
        Standard::Fmi2 => Callback::Fmi2(fmi2_logger(), recorder.environment()),
        Standard::Fmi3 => Callback::Fmi3(fmi3_logger, recorder.environment()),
    };
    let logger = Logger::new(callback, c"defective", logging_on).unwrap();
    let model = Box::new(Defective { plant: MagneticBearingPlant::new(), steps: 0 });
    let instance = Instance::new(model, Interface::CoSimulation, logger).unwrap();
    let handle = Box::into_raw(Box::new(instance)).cast();
    Component::from_handle(standard, PLANT, handle, recorder)
}

#[test]
fn a_panic_is_fatal_for_its_instance_only() {
    for (standard, logging_on) in BOTH.into_iter().flat_map(|standard| [(standard, false), (standard, true)])
    {
        let component = defective(standard, logging_on);
        let neighbour = Component::in_phase(standard, PLANT, super::harness::Phase::Step);
        component.initialise(0.0);
        assert_eq!([component.step(0.0, 1e-3), component.step(1e-3, 1e-3)], [OK, OK]);
        component.recorder.clear();

        assert_eq!(component.step(2e-3, 1e-3), FATAL);
        let messages = component.recorder.take();
        assert_eq!(messages.len(), 1, "{messages:?}");
        assert_eq!((messages[0].status, messages[0].category.as_str()), (FATAL, "logStatusFatal"));
        assert!(messages[0].text.contains("DoStep: internal error"), "{messages:?}");

        component.assert_refused(component.step(2e-3, 1e-3), &["DoStep", "fatal error"]);
        component.assert_refused(component.set("voltage", 1.0), &["Set", "fatal error"]);
        component.assert_refused(component.get_reference(0).0, &["Get", "fatal error"]);
        component.assert_refused(component.terminate(), &["Terminate", "fatal error"]);
        component.assert_refused(component.reset(), &["Reset", "fatal error"]);
        component.assert_refused(component.exit_initialization(), &["Initialization", "fatal error"]);
        let status = component.enter_initialization(0.0, None);
        component.assert_refused(status, &["fatal error"]);
        let rows = match standard {
            Standard::Fmi2 => super::allowed_calls_fmi2::table(),
            Standard::Fmi3 => super::allowed_calls_fmi3::table(),
        };
        for row in rows {
            // SAFETY: a live handle, valid arguments.
            let status = unsafe { (row.call)(component.handle) };
            component.assert_refused(status, &[row.name, "fatal error"]);
        }
        assert_eq!(neighbour.step(Component::STEPPED_TO, 1e-3), OK);
        assert_eq!(ERROR, component.step(2e-3, 1e-3));
        // Freed here.
    }
}
