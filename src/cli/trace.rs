//! `maglev-fmu trace`

use std::error::Error;

use clap::Args;
use maglev_fmu::unit::{MagneticBearingController, MagneticBearingPlant, Silence, Unit};

use super::say;

/// Time per step \[s\].
const STEP_SIZE: f64 = 1e-3;
const PLANT: [&str; 3] = ["position", "velocity", "flux"];
const CONTROLLER: [&str; 4] = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];

/// Run the bearing loop without FMI and print every bit, to compare an importer with
///
/// Start values, controller first, steps of 1 ms. A line per step: position, velocity and flux before the step,
/// then voltage and estimates of the tick, each as the 16 hexadecimal digits of its bits.
#[derive(Debug, Args)]
pub struct Trace {
    #[arg(long, value_name = "N", default_value_t = 1000)]
    steps: u32,
}

impl Trace {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let (mut plant, mut controller) = (MagneticBearingPlant::new(), MagneticBearingController::new());
        plant.initialise(0.0)?;
        controller.initialise(0.0)?;
        for _ in 0..self.steps {
            let state = PLANT.map(|name| get(&plant, name));
            set(&mut controller, "position", state[0]);
            controller.advance(STEP_SIZE, &mut Silence)?;
            let outputs = CONTROLLER.map(|name| get(&controller, name));
            set(&mut plant, "voltage", outputs[0]);
            plant.advance(STEP_SIZE, &mut Silence)?;
            let bits: Vec<String> =
                state.iter().chain(&outputs).map(|value| format!("{:016x}", value.to_bits())).collect();
            say(format_args!("{}", bits.join(",")));
        }
        Ok(())
    }
}

fn get(unit: &dyn Unit, name: &str) -> f64 {
    unit.description().find(name).map_or(f64::NAN, |(reference, _)| unit.values()[reference])
}

fn set(unit: &mut dyn Unit, name: &str, value: f64) {
    if let Some((reference, _)) = unit.description().find(name) {
        unit.values_mut()[reference] = value;
    }
}
