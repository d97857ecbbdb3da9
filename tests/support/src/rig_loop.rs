//! The two rig units wired natively, without FMI, as a master in the controller-first order would.

use maglev_fmu::unit::{MaglevRigController, MaglevRigPlant, Silence, Unit};

use crate::values::{get, set};

/// Numbers of items of enumerations.
pub const NONLINEAR: f64 = 2.0;
pub const KALMAN: f64 = 3.0;
pub const WINDOWED_NEWTON: f64 = 4.0;
pub const EXACT: f64 = 1.0;
pub const RUNGE_KUTTA: f64 = 2.0;
pub const EULER: f64 = 3.0;
pub const CURRENT: f64 = 2.0;
pub const METRES: f64 = 2.0;
pub const MATCHED: f64 = 1.0;
pub const ZERO: f64 = 2.0;
pub const APPLIED: f64 = 2.0;
pub const DISTURBANCE_REJECTION: f64 = 2.0;

/// Parameters of a loop through the extended state that works.
pub const THROUGH_EXTENDED_STATE: [(&str, f64); 3] = [
    ("controller.kind", DISTURBANCE_REJECTION),
    ("observer.bandwidth", 300.0),
    ("observer.input_gain", -3705.0),
];

/// Plant and controller after initialisation with some parameters.
pub struct RigLoop {
    pub plant: MaglevRigPlant,
    pub controller: MaglevRigController,
    pub step_size: f64,
}

impl RigLoop {
    pub fn new(plant_values: &[(&str, f64)], controller_values: &[(&str, f64)]) -> Self {
        let (mut plant, mut controller) = (MaglevRigPlant::new(), MaglevRigController::new());
        plant_values.iter().for_each(|(name, value)| set(&mut plant, name, *value));
        controller_values.iter().for_each(|(name, value)| set(&mut controller, name, *value));
        plant.initialise(0.0).unwrap();
        controller.initialise(0.0).unwrap();
        Self { plant, controller, step_size: 1e-3 }
    }

    /// The controller reads the plant and ticks.
    pub fn step_controller(&mut self) {
        for (from, to) in
            [("sensor_voltage_measured", "sensor_voltage"), ("voltage_measured", "voltage_applied")]
        {
            let value = get(&self.plant, from);
            set(&mut self.controller, to, value);
        }
        self.controller.advance(self.step_size, &mut Silence).unwrap();
    }

    /// The plant takes the controller's voltage; what follows from it at once is computed.
    pub fn hand_over(&mut self) {
        let voltage = get(&self.controller, "voltage");
        set(&mut self.plant, "voltage", voltage);
        self.plant.continuous().expect("a plant").evaluate();
    }

    /// The plant takes the controller's voltage and moves on.
    pub fn step_plant(&mut self) {
        self.hand_over();
        self.plant_advance();
    }

    /// The plant moves on with the inputs it has.
    pub fn plant_advance(&mut self) {
        self.plant.advance(self.step_size, &mut Silence).unwrap();
    }

    pub fn step(&mut self) {
        self.step_controller();
        self.step_plant();
    }
}
