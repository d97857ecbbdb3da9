//! `maglev-fmu trace`

use std::collections::BTreeSet;
use std::error::Error;

use clap::Args;
use maglev_fmu::model::system::{System, systems};
use maglev_fmu::model::variable::{Causality, Kind, Variable};
use maglev_fmu::model::{ClosedLoop, ExchangeOrder, Model};

use super::output::Lines;

/// Run a system without FMI and print all values bit-exact, as a reference for importers
///
/// Controller first. A header, then a line per step: all real outputs of the plant before the step, then all real
/// outputs of the controller after its tick, each as the 16 hexadecimal digits of its bits.
#[derive(Debug, Args)]
pub struct Trace {
    #[arg(value_name = "SYSTEM", default_value = "bearing", value_parser = system)]
    system: &'static System,
    #[arg(long, value_name = "N", default_value_t = 1000)]
    steps: u32,
    /// Communication step in s; the controller's sample time if not given
    #[arg(long, value_name = "S", value_parser = seconds)]
    step_size: Option<f64>,
    /// Parameter or input of the plant, with an enumeration's item by name; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    plant: Vec<String>,
    /// Parameter or input of the controller; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    controller: Vec<String>,
}

fn system(name: &str) -> Result<&'static System, String> {
    System::find(name).ok_or_else(|| {
        let known: Vec<&str> = systems().map(|system| system.name).collect();
        format!("no such system, expected one of: {}", known.join(", "))
    })
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) && value > 0.0 => Ok(value),
        _ => Err("expected a finite number greater than 0 of s".to_owned()),
    }
}

impl Trace {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut closed_loop = ClosedLoop::of(self.system, ExchangeOrder::ControllerFirst);
        assign_all(&mut *closed_loop.plant, &self.plant)?;
        assign_all(&mut *closed_loop.controller, &self.controller)?;
        closed_loop.start(0.0)?;
        closed_loop.step_size = self.step_size.unwrap_or_else(|| sample_time(&*closed_loop.controller));
        closed_loop.check_step()?;
        let plant_outputs = real_outputs(&*closed_loop.plant);
        let controller_outputs = real_outputs(&*closed_loop.controller);
        let mut lines = Lines::new()?;
        lines.say(format_args!(
            "{}",
            [header("plant", &plant_outputs), header("controller", &controller_outputs)].join(",")
        ))?;
        for _ in 0..self.steps {
            let mut row = bits(&*closed_loop.plant, &plant_outputs);
            closed_loop.step_controller()?;
            row.extend(bits(&*closed_loop.controller, &controller_outputs));
            closed_loop.step_plant()?;
            lines.say(format_args!("{}", row.join(",")))?;
        }
        Ok(lines.finish()?)
    }
}

/// \[s\]
fn sample_time(controller: &dyn Model) -> f64 {
    let (reference, _) = controller.description().find("sample_time").expect("a controller samples");
    controller.values()[reference]
}

/// All real outputs with their value references, in the order of the table.
fn real_outputs(model: &dyn Model) -> Vec<(usize, &'static str)> {
    let is_real_output =
        |row: &Variable| row.causality == Causality::Output && matches!(row.kind, Kind::Real(_));
    let rows = model.description().variables.iter().enumerate();
    rows.filter(|(_, row)| is_real_output(row)).map(|(reference, row)| (reference, row.name)).collect()
}

fn header(model: &str, outputs: &[(usize, &str)]) -> String {
    outputs.iter().map(|(_, name)| format!("{model}.{name}")).collect::<Vec<_>>().join(",")
}

fn bits(model: &dyn Model, outputs: &[(usize, &str)]) -> Vec<String> {
    outputs.iter().map(|(reference, _)| format!("{:016x}", model.values()[*reference].to_bits())).collect()
}

/// Carries out each `NAME=VALUE`; no name may be given twice.
fn assign_all(model: &mut dyn Model, assignments: &[String]) -> Result<(), Box<dyn Error>> {
    let mut names = BTreeSet::new();
    for assignment in assignments {
        let name = assignment.split('=').next().unwrap_or_default();
        if !names.insert(name) {
            return Err(format!("{name} is given twice").into());
        }
        assign(model, assignment)?;
    }
    Ok(())
}

/// Carries out `NAME=VALUE`.
fn assign(model: &mut dyn Model, assignment: &str) -> Result<(), Box<dyn Error>> {
    let (name, text) =
        assignment.split_once('=').ok_or_else(|| format!("{assignment}: expected NAME=VALUE"))?;
    let description = model.description();
    let (reference, variable) =
        description.find(name).ok_or_else(|| format!("{} has no variable {name}", description.name))?;
    if variable.is_calculated() {
        return Err(format!("{name} is calculated by the model and cannot be set").into());
    }
    let number = parse(variable, text)?;
    variable.check(number)?;
    model.values_mut()[reference] = number;
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
