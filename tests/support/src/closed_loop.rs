//! The native loop of a system with some parameters.

use maglev_fmu::model::{ClosedLoop, ExchangeOrder, System};

use crate::values::{get, set};

/// Both models of a system, started at 0 s; the controller goes first, every step is one of its sample times.
pub fn closed_loop(
    system: &System,
    plant_values: &[(&str, f64)],
    controller_values: &[(&str, f64)],
) -> ClosedLoop {
    let mut run = ClosedLoop::of(system, ExchangeOrder::ControllerFirst);
    plant_values.iter().for_each(|(name, value)| set(&mut *run.plant, name, *value));
    controller_values.iter().for_each(|(name, value)| set(&mut *run.controller, name, *value));
    run.start(0.0).unwrap();
    run.step_size = get(&*run.controller, "sample_time");
    run
}
