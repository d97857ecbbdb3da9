//! The two bearing units wired natively, without FMI, as a master in the controller-first order would.

use maglev_fmu::unit::{MagneticBearingController, MagneticBearingPlant, Silence, Unit};

use crate::values::{get, set};

/// Every observer of the controller, as its parameters; the square Newton observer also with the exact map, with a
/// line search and with small steps.
pub const OBSERVERS: [(&str, &[(&str, f64)]); 8] = [
    ("newton", &[]),
    ("newton, exact map", &[("observer.map", EXACT)]),
    ("newton, line search", &[("observer.map", EXACT), ("observer.line_search", 1.0)]),
    ("newton, small steps", &[("observer.max_iterations", 20.0), ("observer.step_size", 0.7)]),
    ("newton, N = 10", &[("observer.map", EXACT), ("observer.window", 10.0)]),
    ("reduced_newton", &[("observer.kind", 2.0), ("observer.filter_time", 2e-3)]),
    ("reduced_newton_compensated", &[("observer.kind", 3.0), ("observer.map", EXACT)]),
    (
        "kalman",
        &[("observer.kind", KALMAN), ("observer.position_noise", 1e-7), ("observer.flux_noise", 1e-7)],
    ),
];

/// Numbers of items of enumerations.
pub const EXACT: f64 = 1.0;
pub const KALMAN: f64 = 4.0;
pub const APPLIED: f64 = 2.0;
pub const FLUX_CASCADE: f64 = 4.0;

/// Plant and controller after initialisation with some parameters.
pub struct BearingLoop {
    pub plant: MagneticBearingPlant,
    pub controller: MagneticBearingController,
    pub step_size: f64,
}

impl BearingLoop {
    pub fn new(plant_values: &[(&str, f64)], controller_values: &[(&str, f64)]) -> Self {
        let mut plant = MagneticBearingPlant::new();
        let mut controller = MagneticBearingController::new();
        plant_values.iter().for_each(|(name, value)| set(&mut plant, name, *value));
        controller_values.iter().for_each(|(name, value)| set(&mut controller, name, *value));
        plant.initialise(0.0).unwrap();
        controller.initialise(0.0).unwrap();
        Self { plant, controller, step_size: 1e-3 }
    }

    /// The controller reads the plant and ticks.
    pub fn step_controller(&mut self) {
        for (from, to) in
            [("position_measured", "position"), ("velocity", "state.velocity"), ("flux", "state.flux")]
        {
            let value = get(&self.plant, from);
            set(&mut self.controller, to, value);
        }
        let acted = get(&self.plant, "voltage_measured");
        set(&mut self.controller, "voltage_applied", acted);
        self.controller.advance(self.step_size, &mut Silence).unwrap();
    }

    /// The plant takes the controller's voltage and moves on.
    pub fn step_plant(&mut self) {
        let voltage = get(&self.controller, "voltage");
        set(&mut self.plant, "voltage", voltage);
        self.plant.advance(self.step_size, &mut Silence).unwrap();
    }
}
