//! `maglev-fmu trace`

use std::error::Error;

use clap::Args;
use maglev_fmu::unit::variable::{Kind, Variable};
use maglev_fmu::unit::{MagneticBearingController, MagneticBearingPlant, Silence, Unit};

use super::say;

/// Time per step \[s\].
const STEP_SIZE: f64 = 1e-3;
const PLANT: [&str; 3] = ["position", "velocity", "flux"];
const CONTROLLER: [&str; 4] = ["voltage", "estimate.position", "estimate.velocity", "estimate.flux"];
/// Outputs of the plant and the controller's inputs they go to.
const WIRES: [(&str, &str); 4] = [
    ("position_measured", "position"),
    ("velocity", "state.velocity"),
    ("flux", "state.flux"),
    ("voltage_measured", "voltage_applied"),
];

/// Run the bearing loop without FMI and print every bit, to compare an importer with
///
/// Controller first, steps of 1 ms. A line per step: position, velocity and flux before the step, then voltage and
/// estimates of the tick, each as the 16 hexadecimal digits of its bits.
#[derive(Debug, Args)]
pub struct Trace {
    #[arg(long, value_name = "N", default_value_t = 1000)]
    steps: u32,
    /// Parameter of the plant, with an enumeration's item by name; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    plant: Vec<String>,
    /// Parameter of the controller; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    controller: Vec<String>,
}

impl Trace {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let (mut plant, mut controller) = (MagneticBearingPlant::new(), MagneticBearingController::new());
        self.plant.iter().try_for_each(|assignment| assign(&mut plant, assignment))?;
        self.controller.iter().try_for_each(|assignment| assign(&mut controller, assignment))?;
        plant.initialise(0.0)?;
        controller.initialise(0.0)?;
        for _ in 0..self.steps {
            let state = PLANT.map(|name| *value(&mut plant, name));
            for (output, input) in WIRES {
                *value(&mut controller, input) = *value(&mut plant, output);
            }
            controller.advance(STEP_SIZE, &mut Silence)?;
            let outputs = CONTROLLER.map(|name| *value(&mut controller, name));
            *value(&mut plant, "voltage") = outputs[0];
            plant.advance(STEP_SIZE, &mut Silence)?;
            let bits: Vec<String> =
                state.iter().chain(&outputs).map(|value| format!("{:016x}", value.to_bits())).collect();
            say(format_args!("{}", bits.join(",")));
        }
        Ok(())
    }
}

/// The value of a variable that the unit's table has.
fn value<'a>(unit: &'a mut dyn Unit, name: &str) -> &'a mut f64 {
    let (reference, _) = unit.description().find(name).expect("a name of this file");
    &mut unit.values_mut()[reference]
}

/// Carries out `NAME=VALUE`.
fn assign(unit: &mut dyn Unit, assignment: &str) -> Result<(), Box<dyn Error>> {
    let (name, text) =
        assignment.split_once('=').ok_or_else(|| format!("{assignment}: expected NAME=VALUE"))?;
    let description = unit.description();
    let (reference, variable) =
        description.find(name).ok_or_else(|| format!("{} has no variable {name}", description.name))?;
    if variable.is_calculated() {
        return Err(format!("{name} is calculated by the unit and cannot be set").into());
    }
    let number = parse(variable, text)?;
    variable.check(number)?;
    unit.values_mut()[reference] = number;
    Ok(())
}

fn parse(variable: &Variable, text: &str) -> Result<f64, String> {
    let unknown = |expected: String| format!("{} = {text}: expected {expected}", variable.name);
    match variable.kind {
        Kind::Enumeration(enumeration) => {
            let names = || enumeration.items.iter().map(|(name, _)| *name);
            let place = names().position(|name| name == text);
            place
                .map(|place| (place + 1) as f64)
                .ok_or_else(|| unknown(format!("one of {}", names().collect::<Vec<_>>().join(", "))))
        }
        Kind::Boolean => {
            let truth: Result<bool, _> = text.parse();
            truth.map(|truth| f64::from(u8::from(truth))).map_err(|_| unknown("true or false".to_owned()))
        }
        Kind::Integer => {
            let number: Result<i32, _> = text.parse();
            number.map(f64::from).map_err(|_| unknown("an integer".to_owned()))
        }
        Kind::Real(quantity) => {
            text.parse().map_err(|_| unknown(format!("a number of {}", quantity.unit.name)))
        }
    }
}
