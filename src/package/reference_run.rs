//! What a unit must answer to a given input: computed from the unit itself, without FMI, when the package is made.
//!
//! The inputs are those that the unit meets in its loop, with the package's start values in the unit and those of the
//! table in its partner. After a third of the run the inputs that the loop leaves free, such as a reference or a disturbing
//! force, step by a twentieth of their nominal value, so that they matter as well.
//!
//! Some importers set the first row of inputs before the end of the initialisation, some after it. The run is the same
//! either way: an input that an output at the start follows from keeps its start value over the first step.

use crate::unit::system::{System, systems};
use crate::unit::variable::{Causality, Kind, Variable};
use crate::unit::{Description, Silence, StartValues, Unit, UnitError, UnitType, units};

/// Longest run \[s\]. The inputs of a reference run do not react to the plant, and levitation is unstable: what an
/// importer rounds off its step size grows with e^(t / 20 ms) and worse.
const LONGEST: f64 = 0.25;
/// Most communication steps of a run, each of the unit's suggested size.
const MOST_STEPS: usize = 1500;

/// Inputs and outputs of a unit over some communication steps.
#[derive(Clone, Debug)]
pub struct ReferenceRun {
    /// \[s\]
    pub step_size: f64,
    pub inputs: Table,
    pub outputs: Table,
}

/// Values of some variables at communication points.
#[derive(Clone, Debug)]
pub struct Table {
    pub variables: Vec<&'static Variable>,
    /// Time \[s\] and values.
    pub rows: Vec<(f64, Vec<f64>)>,
}

impl ReferenceRun {
    /// Runs the loop of the unit described, controller first; a unit without a loop runs alone.
    ///
    /// Row k of the inputs holds over the step from k h to (k + 1) h, row k of the outputs at k h.
    pub fn of(description: &'static Description, start_values: &StartValues) -> Result<Self, UnitError> {
        let mut bench = Bench::new(description, start_values)?;
        let input = table_of(description, Causality::Input);
        let output = table_of(description, Causality::Output);
        let step_size = description.step_size;
        let mut run = Self { step_size, inputs: input, outputs: output };
        run.outputs.record(0.0, bench.unit());
        let steps = number_of_steps(description);
        for step in 0..steps {
            if step == steps / 3 {
                bench.disturb();
            }
            let before = bench.advance(step_size)?;
            run.inputs.rows.push((step as f64 * step_size, run.inputs.values(&before)));
            run.outputs.record((step + 1) as f64 * step_size, bench.unit());
        }
        Ok(run)
    }
}

fn number_of_steps(description: &Description) -> usize {
    MOST_STEPS.min((LONGEST / description.step_size).round() as usize)
}

/// Columns for all variables of a causality that have a value.
fn table_of(description: &'static Description, causality: Causality) -> Table {
    let has_value = |variable: &&Variable| {
        variable.causality == causality
            && matches!(variable.kind, Kind::Real(_) | Kind::Integer | Kind::Boolean | Kind::Enumeration(_))
    };
    Table { variables: description.variables.iter().filter(has_value).collect(), rows: Vec::new() }
}

impl Table {
    fn values(&self, unit: &[(&'static str, f64)]) -> Vec<f64> {
        let value = |wanted: &&Variable| {
            unit.iter().find(|(name, _)| *name == wanted.name).map_or(f64::NAN, |(_, value)| *value)
        };
        self.variables.iter().map(value).collect()
    }

    fn record(&mut self, time: f64, unit: &dyn Unit) {
        let values = self.values(&named_values(unit));
        self.rows.push((time, values));
    }

    /// Comma-separated values with all their digits; numbers for truth values and items of enumerations.
    pub fn csv(&self) -> String {
        let mut text = String::from("time");
        self.variables.iter().for_each(|variable| {
            text += ",";
            text += variable.name;
        });
        for (time, values) in &self.rows {
            text += &format!("\n{time:?}");
            for (variable, value) in self.variables.iter().zip(values) {
                text += &match variable.kind {
                    Kind::Real(_) => format!(",{value:?}"),
                    _ => format!(",{value:.0}"),
                };
            }
        }
        text.push('\n');
        text
    }
}

fn named_values(unit: &dyn Unit) -> Vec<(&'static str, f64)> {
    let names = unit.description().variables.iter().map(|variable| variable.name);
    names.zip(unit.values().iter().copied()).collect()
}

/// The unit that is looked at and, if it has a loop, the other one.
struct Bench {
    units: Vec<Box<dyn Unit>>,
    system: Option<&'static System>,
    /// Which of the units is looked at.
    place: usize,
    free: Vec<usize>,
    /// Inputs from which outputs at the start follow.
    initial: Vec<usize>,
    has_started: bool,
}

/// Places in a bench with a loop, in the order of stepping.
const CONTROLLER: usize = 0;
const PLANT: usize = 1;

impl Bench {
    fn new(description: &'static Description, start_values: &StartValues) -> Result<Self, UnitError> {
        let is_it = |unit: &UnitType| std::ptr::eq(unit.description, description);
        let system = systems().find(|system| is_it(system.plant) || is_it(system.controller));
        let (types, place) = match system {
            Some(system) => {
                (vec![system.controller, system.plant], if is_it(system.plant) { PLANT } else { CONTROLLER })
            }
            None => (units().filter(|unit| is_it(unit)).collect(), 0),
        };
        let mut units: Vec<Box<dyn Unit>> = types.iter().map(|unit| (unit.create)()).collect();
        if let Some(system) = system {
            apply_starts_of_partner(system, description, start_values, &types, &mut units);
        }
        start_values.apply(&mut *units[place]);
        units.iter_mut().try_for_each(|unit| unit.start(0.0))?;
        let wires =
            system.map_or(&[][..], |system| if place == PLANT { system.actuation } else { system.sensing });
        let is_free = |variable: &Variable| {
            variable.causality == Causality::Input
                && matches!(variable.kind, Kind::Real(_))
                && !wires.iter().any(|(_, input)| *input == variable.name)
        };
        let rows = description.variables.iter().enumerate();
        let free = rows.filter(|(_, variable)| is_free(variable)).map(|(reference, _)| reference).collect();
        let initial = initial_inputs(description);
        Ok(Self { units, system, place, free, initial, has_started: false })
    }

    fn unit(&self) -> &dyn Unit {
        &*self.units[self.place]
    }

    /// Moves the free inputs by a twentieth of their nominal values, as far as their range allows.
    fn disturb(&mut self) {
        let unit = &mut self.units[self.place];
        for &reference in &self.free {
            let variable = &unit.description().variables[reference];
            if let Kind::Real(quantity) = variable.kind {
                let moved = unit.values()[reference] + 0.05 * quantity.nominal;
                if variable.check(moved).is_ok() {
                    unit.values_mut()[reference] = moved;
                }
            }
        }
    }

    /// Steps the loop; returns what the unit's variables were when its own step began.
    fn advance(&mut self, step_size: f64) -> Result<Vec<(&'static str, f64)>, UnitError> {
        let mut seen = Vec::new();
        for place in 0..self.units.len() {
            if let Some(system) = self.system {
                let (source, wires) = match place {
                    CONTROLLER => (PLANT, system.sensing),
                    _ => (CONTROLLER, system.actuation),
                };
                for (output, input) in wires {
                    let value = self.units[source].values()[reference(&*self.units[source], output)];
                    let target = &mut self.units[place];
                    let reference = reference(&**target, input);
                    let keeps_start =
                        !self.has_started && place == self.place && self.initial.contains(&reference);
                    if !keeps_start {
                        target.values_mut()[reference] = value;
                    }
                }
            }
            if place == self.place {
                seen = named_values(self.unit());
            }
            self.units[place].advance(step_size, &mut Silence)?;
        }
        self.has_started = true;
        Ok(seen)
    }
}

/// Value references of the inputs from which outputs at the end of the initialisation follow. In co-simulation those of
/// a plant follow from its states alone; its echo of the inputs tells of the last step, of which there is none yet.
fn initial_inputs(description: &'static Description) -> Vec<usize> {
    if !description.is_sampled() {
        return Vec::new();
    }
    let rows = description.variables.iter().zip(description.dependencies());
    let outputs = rows.filter(|(variable, _)| variable.causality == Causality::Output);
    let sources = outputs.flat_map(|(_, dependencies)| dependencies.initially);
    sources.filter(|source| description.variables[*source].causality == Causality::Input).collect()
}

/// A unit that starts as in a package of its system meets the other one as it starts there.
fn apply_starts_of_partner(
    system: &System,
    description: &'static Description,
    start_values: &StartValues,
    types: &[&UnitType],
    units: &mut [Box<dyn Unit>],
) {
    let own = system.start_values(description);
    if own.is_ok_and(|own| own != *StartValues::TABLE && start_values.include(&own)) {
        for (unit, made) in types.iter().zip(units) {
            // What cannot be packaged has been refused before.
            system.start_values(unit.description).unwrap_or_default().apply(&mut **made);
        }
    }
}

/// Value reference of an end of a wire.
fn reference(unit: &dyn Unit, name: &str) -> usize {
    unit.description().find(name).expect("wires end at variables of the table").0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a package of the rig both sensors are adjusted; a plant with another sensor would lose its ball.
    #[test]
    fn units_of_a_system_meet_each_other() {
        let rig = System::find("rig").unwrap();
        for unit in [rig.plant, rig.controller] {
            let starts = rig.start_values(unit.description).unwrap();
            let run = ReferenceRun::of(unit.description, &starts).unwrap();
            for table in [&run.inputs, &run.outputs] {
                let sensor =
                    table.variables.iter().position(|variable| variable.name.starts_with("sensor_voltage"));
                if let Some(column) = sensor {
                    let worst = table.rows.iter().map(|(_, row)| row[column].abs()).fold(0.0, f64::max);
                    assert!(worst < 0.5, "{}: {worst} V off the operating point", unit.description.name);
                }
            }
        }
    }
}
