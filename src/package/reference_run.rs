//! What a model must answer to a given input: computed from the model itself, without FMI, when the package is made.
//!
//! The inputs are those that the model meets in its loop, with the package's start values in the model and those of the
//! table in its partner. After a third of the run the inputs that the loop leaves free, such as a reference or a disturbing
//! force, step by a twentieth of their nominal value, so that they matter as well.
//!
//! Some importers set the first row of inputs before the end of the initialisation, some after it. The run is the same
//! either way: an input that an output at the start follows from keeps its start value over the first step.

use super::dependencies;
use crate::model::system::{System, systems};
use crate::model::variable::{Causality, Kind, Variable};
use crate::model::{
    ClosedLoop, Description, ExchangeOrder, Model, ModelError, ModelType, NullLogSink, StartValues, models,
};

/// Longest run \[s\]. The inputs of a reference run do not react to the plant, and levitation is unstable: what an
/// importer rounds off its step size grows with e^(t / 20 ms) and worse.
const LONGEST: f64 = 0.25;
/// Most communication steps of a run, each of the model's suggested size.
const MOST_STEPS: usize = 1500;

/// Inputs and outputs of a model over some communication steps.
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
    /// Runs the loop of the model described, controller first; a model without a loop runs alone.
    ///
    /// Row k of the inputs holds over the step from k h to (k + 1) h, row k of the outputs at k h.
    pub fn of(description: &'static Description, start_values: &StartValues) -> Result<Self, ModelError> {
        let mut bench = Bench::new(description, start_values)?;
        let input = table_of(description, Causality::Input);
        let output = table_of(description, Causality::Output);
        let step_size = description.step_size;
        let mut run = Self { step_size, inputs: input, outputs: output };
        run.outputs.record(0.0, bench.model());
        let steps = number_of_steps(description);
        for step in 0..steps {
            if step == steps / 3 {
                bench.disturb();
            }
            let before = bench.advance(step_size)?;
            run.inputs.rows.push((step as f64 * step_size, run.inputs.values(&before)));
            run.outputs.record((step + 1) as f64 * step_size, bench.model());
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
    fn values(&self, model: &[(&'static str, f64)]) -> Vec<f64> {
        let value = |wanted: &&Variable| {
            model.iter().find(|(name, _)| *name == wanted.name).map_or(f64::NAN, |(_, value)| *value)
        };
        self.variables.iter().map(value).collect()
    }

    fn record(&mut self, time: f64, model: &dyn Model) {
        let values = self.values(&named_values(model));
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

fn named_values(model: &dyn Model) -> Vec<(&'static str, f64)> {
    let names = model.description().variables.iter().map(|variable| variable.name);
    names.zip(model.values().iter().copied()).collect()
}

/// The model that is looked at, in its loop if it has one.
struct Bench {
    stage: Stage,
    free: Vec<usize>,
    /// Inputs from which outputs at the start follow.
    initial: Vec<usize>,
    has_started: bool,
}

enum Stage {
    Alone(Box<dyn Model>),
    Plant(ClosedLoop),
    Controller(ClosedLoop),
}

impl Bench {
    fn new(description: &'static Description, start_values: &StartValues) -> Result<Self, ModelError> {
        let is_it = |model: &ModelType| std::ptr::eq(model.description, description);
        let system = systems().find(|system| is_it(system.plant) || is_it(system.controller));
        let mut stage = match system {
            Some(system) => {
                let mut closed_loop = ClosedLoop::of(system, ExchangeOrder::ControllerFirst);
                closed_loop.step_size = description.step_size;
                apply_starts_of_partner(system, description, start_values, &mut closed_loop);
                if is_it(system.plant) { Stage::Plant(closed_loop) } else { Stage::Controller(closed_loop) }
            }
            None => {
                let model = models().find(|model| is_it(model)).expect("a model of the list");
                Stage::Alone((model.create)())
            }
        };
        start_values.apply(stage.model_mut());
        match &mut stage {
            Stage::Alone(model) => model.start(0.0)?,
            Stage::Plant(closed_loop) | Stage::Controller(closed_loop) => closed_loop.start(0.0)?,
        }
        let wired: Vec<&str> = system
            .into_iter()
            .flat_map(System::wires)
            .filter(|wire| std::ptr::eq(wire.target, description))
            .map(|wire| wire.input)
            .collect();
        let is_free = |variable: &Variable| {
            variable.causality == Causality::Input
                && matches!(variable.kind, Kind::Real(_))
                && !wired.contains(&variable.name)
        };
        let rows = description.variables.iter().enumerate();
        let free = rows.filter(|(_, variable)| is_free(variable)).map(|(reference, _)| reference).collect();
        Ok(Self { stage, free, initial: initial_inputs(description), has_started: false })
    }

    fn model(&self) -> &dyn Model {
        match &self.stage {
            Stage::Alone(model) => &**model,
            Stage::Plant(closed_loop) => &*closed_loop.plant,
            Stage::Controller(closed_loop) => &*closed_loop.controller,
        }
    }

    /// Moves the free inputs by a twentieth of their nominal values, as far as their range allows.
    fn disturb(&mut self) {
        let model = self.stage.model_mut();
        for &reference in &self.free {
            let variable = &model.description().variables[reference];
            if let Kind::Real(quantity) = variable.kind {
                let moved = model.values()[reference] + 0.05 * quantity.nominal;
                if variable.check(moved).is_ok() {
                    model.values_mut()[reference] = moved;
                }
            }
        }
    }

    /// Steps the loop; returns what the model's variables were when its own step began.
    fn advance(&mut self, step_size: f64) -> Result<Vec<(&'static str, f64)>, ModelError> {
        if let Stage::Plant(closed_loop) = &mut self.stage {
            closed_loop.step_controller()?;
        }
        let starts: Vec<f64> =
            self.initial.iter().map(|reference| self.model().values()[*reference]).collect();
        match &mut self.stage {
            Stage::Alone(_) => (),
            Stage::Plant(closed_loop) => closed_loop.actuate(),
            Stage::Controller(closed_loop) => closed_loop.sense(),
        }
        if !self.has_started {
            for (reference, start) in self.initial.iter().zip(starts) {
                self.stage.model_mut().values_mut()[*reference] = start;
            }
        }
        self.has_started = true;
        let seen = named_values(self.model());
        self.stage.model_mut().advance(step_size, &mut NullLogSink)?;
        if let Stage::Controller(closed_loop) = &mut self.stage {
            closed_loop.step_plant()?;
        }
        Ok(seen)
    }
}

impl Stage {
    fn model_mut(&mut self) -> &mut dyn Model {
        match self {
            Self::Alone(model) => &mut **model,
            Self::Plant(closed_loop) => &mut *closed_loop.plant,
            Self::Controller(closed_loop) => &mut *closed_loop.controller,
        }
    }
}

/// Value references of the inputs from which outputs at the end of the initialisation follow. In co-simulation those of
/// a plant follow from its states alone; its echo of the inputs tells of the last step, of which there is none yet.
fn initial_inputs(description: &'static Description) -> Vec<usize> {
    if !description.is_sampled() {
        return Vec::new();
    }
    let rows = description.variables.iter().zip(dependencies(description));
    let outputs = rows.filter(|(variable, _)| variable.causality == Causality::Output);
    let sources = outputs.flat_map(|(_, dependencies)| dependencies.initially);
    sources.filter(|source| description.variables[*source].causality == Causality::Input).collect()
}

/// A model that starts as in a package of its system meets the other one as it starts there.
fn apply_starts_of_partner(
    system: &System,
    description: &'static Description,
    start_values: &StartValues,
    closed_loop: &mut ClosedLoop,
) {
    let own = system.start_values_with(description, start_values);
    if own.is_ok_and(|own| own != *StartValues::TABLE && start_values.include(&own)) {
        for model in [&mut closed_loop.plant, &mut closed_loop.controller] {
            // What cannot be packaged has been refused before.
            system.start_values(model.description()).unwrap_or_default().apply(&mut **model);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a package of the rig both sensors are adjusted; a plant with another sensor would lose its ball.
    #[test]
    fn models_of_a_system_meet_each_other() {
        let rig = System::find("rig").unwrap();
        let mut faster = StartValues::default();
        faster.set(rig.controller.description, "sample_time", 5e-4).unwrap();
        let table = StartValues::TABLE;
        for (model, wanted) in [(rig.plant, table), (rig.controller, table), (rig.controller, &faster)] {
            let starts = rig.start_values_with(model.description, wanted).unwrap();
            let run = ReferenceRun::of(model.description, &starts).unwrap();
            for table in [&run.inputs, &run.outputs] {
                let sensor =
                    table.variables.iter().position(|variable| variable.name.starts_with("sensor_voltage"));
                if let Some(column) = sensor {
                    let worst = table.rows.iter().map(|(_, row)| row[column].abs()).fold(0.0, f64::max);
                    assert!(worst < 0.5, "{}: {worst} V off the operating point", model.description.name);
                }
            }
        }
    }
}
