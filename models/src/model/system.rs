//! Which plant and which controller belong together, and how they are wired.

pub use super::levitated_ball::BALL;
pub use super::maglev_rig::RIG;
pub use super::magnetic_bearing::BEARING;
use super::sampled::SAMPLE_TIME;
use super::start_values::{StartValueError, StartValues};
use super::variable::{Kind, required_row};
use super::{Description, ModelType, longest_step, start_delay};

/// A plant with its controller. All wires carry reals.
#[derive(Debug)]
pub struct System {
    /// Short name, as on the command line.
    pub name: &'static str,
    pub plant: &'static ModelType,
    pub controller: &'static ModelType,
    /// Outputs of the plant and the inputs of the controller that take them.
    pub sensing: &'static [(&'static str, &'static str)],
    /// Outputs of the controller and the inputs of the plant that take them.
    pub actuation: &'static [(&'static str, &'static str)],
    /// With what the plant starts in a package of the system, where it differs from the plant's own table.
    pub plant_starts: &'static [(&'static str, Start)],
    /// The same of the controller, which also waits for the first values and refuses steps that are too long.
    pub controller_starts: &'static [(&'static str, Start)],
    /// Longest communication step that the controller accepts in a package \[s\], with which the loop is sure to hold.
    pub longest_step: f64,
    /// What else is to be known of these start values; begins with a space.
    pub remark: &'static str,
}

/// An output and the input of the other model that takes it.
#[derive(Clone, Copy, Debug)]
pub struct Wire {
    pub source: &'static Description,
    pub output: &'static str,
    pub target: &'static Description,
    pub input: &'static str,
}

impl Wire {
    /// Value references of the output and of the input.
    pub fn references(&self) -> (usize, usize) {
        let reference = |model: &Description, name: &str| {
            model.find(name).expect("wires end at variables of the tables, which a test checks").0
        };
        (reference(self.source, self.output), reference(self.target, self.input))
    }
}

/// A start value in a package of a system.
#[derive(Clone, Copy, Debug)]
pub enum Start {
    /// Name of an enumeration's item.
    Item(&'static str),
    /// What another variable of the model starts with.
    SameAs(&'static str),
    /// So much more than in the model's table.
    Shifted(f64),
}

/// Masters of packages step both models at once, so that the command acts a step later.
pub const USE_APPLIED_VOLTAGE: (&str, Start) = ("observer.voltage_source", Start::Item("applied"));

/// Communication steps that a controller waits for the first values, which are zeros in some masters.
const STEPS_TO_THE_FIRST_VALUES: f64 = 1.0;

/// Share by which the sample time may miss a multiple of the step by rounding.
const ROUNDING: f64 = 1e-9;

/// All systems of the library's own models, in the order of these.
pub static SYSTEMS: &[&System] = &[&BEARING, &BALL, &RIG];

/// All systems, those that the running program adds included.
pub fn systems() -> impl Iterator<Item = &'static System> + Clone {
    let own = SYSTEMS.iter().copied();
    #[cfg(feature = "added-models")]
    let own = own.chain(super::ADDED_SYSTEMS);
    own
}

impl System {
    /// The system called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        systems().find(|system| system.name == name)
    }

    /// All wires: what the controller reads, then what acts on the plant.
    pub fn wires(&self) -> impl Iterator<Item = Wire> {
        let (plant, controller) = (self.plant.description, self.controller.description);
        let sensing = self.sensing.iter().map(move |wire| (plant, controller, wire));
        let actuation = self.actuation.iter().map(move |wire| (controller, plant, wire));
        let wires = sensing.chain(actuation);
        wires.map(|(source, target, &(output, input))| Wire { source, output, target, input })
    }

    /// Communication step that suits both models \[s\].
    pub fn step_size(&self) -> f64 {
        self.plant.description.step_size.min(self.controller.description.step_size)
    }

    /// The same where the controller starts with these values: no longer than its sample time, which is a multiple of it.
    pub fn step_size_with(&self, controller_values: &StartValues) -> f64 {
        let row = required_row(self.controller.description.variables, SAMPLE_TIME);
        let sample_time = controller_values.of(row, &self.controller.description.variables[row]);
        let (step_size, steps) = (self.step_size(), sample_time / self.step_size());
        let is_multiple = steps > 0.5 && (steps - libm::round(steps)).abs() <= ROUNDING * steps;
        if is_multiple { step_size } else { sample_time / libm::ceil(steps) }
    }

    /// Suggested end of a simulation \[s\].
    pub fn stop_time(&self) -> f64 {
        self.plant.description.stop_time.max(self.controller.description.stop_time)
    }

    /// With what a model of this system starts in a package of it; any other model as its table says.
    pub fn start_values(&self, description: &'static Description) -> Result<StartValues, StartValueError> {
        self.start_values_with(description, StartValues::TABLE)
    }

    /// The same where somebody wants these values instead, from which others may follow.
    pub fn start_values_with(
        &self,
        description: &'static Description,
        wanted: &StartValues,
    ) -> Result<StartValues, StartValueError> {
        let mut values = StartValues::default();
        let is = |model: &ModelType| core::ptr::eq(model.description, description);
        let starts = if is(self.plant) {
            self.plant_starts
        } else if is(self.controller) {
            self.controller_starts
        } else {
            &[]
        };
        for (name, start) in starts {
            let number = start.number(description, name);
            // What does not exist has no value, which is refused as such.
            values.set(description, name, number.unwrap_or(f64::NAN))?;
        }
        if is(self.controller) {
            let delay = STEPS_TO_THE_FIRST_VALUES * self.step_size_with(wanted);
            values.set(description, longest_step::NAME, self.longest_step)?;
            values.set(description, start_delay::NAME, delay)?;
        }
        Ok(values.overridden_by(wanted)?)
    }
}

impl Start {
    /// The value, or nothing if the variable `name` or what this refers to does not exist.
    fn number(self, description: &Description, name: &str) -> Option<f64> {
        let (_, variable) = description.find(name)?;
        match (self, variable.kind) {
            (Self::Item(item), Kind::Enumeration(enumeration)) => {
                let place = enumeration.items.iter().position(|(known, _)| *known == item)?;
                Some((place + 1) as f64)
            }
            (Self::Item(_), _) => None,
            (Self::SameAs(other), _) => Some(description.find(other)?.1.start),
            (Self::Shifted(shift), _) => Some(variable.start + shift),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::unit_of_measure::UnitOfMeasure;
    use crate::model::variable::{Causality, Kind};

    fn unit_of_end(model: &ModelType, name: &str, causality: Causality) -> &'static UnitOfMeasure {
        let (_, variable) = model.description.find(name).unwrap_or_else(|| panic!("no variable {name}"));
        assert_eq!(variable.causality, causality, "{name}");
        match variable.kind {
            Kind::Real(quantity) => quantity.unit,
            _ => panic!("{name} is not real"),
        }
    }

    #[test]
    fn wires_connect_outputs_to_inputs_of_the_same_unit_of_measure() {
        for System { plant, controller, sensing, actuation, .. } in SYSTEMS {
            let wires = [(plant, controller, sensing), (controller, plant, actuation)];
            for (source, target, wires) in wires {
                for (output, input) in *wires {
                    let source = unit_of_end(source, output, Causality::Output);
                    let target = unit_of_end(target, input, Causality::Input);
                    assert!(core::ptr::eq(source, target), "{output} in {} to {input}", source.name);
                }
            }
        }
    }

    #[test]
    fn packages_start_with_what_their_models_accept() {
        for system in SYSTEMS {
            let value = |model: &ModelType, name: &str| {
                let (reference, variable) = model.description.find(name).unwrap();
                (system.start_values(model.description).unwrap().of(reference, variable), variable.kind)
            };
            let Start::Item(item) = USE_APPLIED_VOLTAGE.1 else { panic!("an item") };
            let (number, Kind::Enumeration(enumeration)) = value(system.controller, USE_APPLIED_VOLTAGE.0)
            else {
                panic!("an enumeration")
            };
            assert_eq!(enumeration.items[number as usize - 1].0, item);
            assert_eq!(value(system.controller, start_delay::NAME).0, system.step_size());
            assert!(value(system.controller, longest_step::NAME).0 >= system.step_size());
        }
        let elsewhere = BEARING.start_values(BALL.controller.description).unwrap();
        assert_eq!(elsewhere, *StartValues::TABLE);
    }

    /// Guards: a package whose sensor is adjusted to 0 V at 9 mm and whose descriptions say that -1.50868 V is 9 mm. A number
    /// of the table is told as the manual's, and what is the manual's with its number.
    #[test]
    fn descriptions_are_true_of_shifted_starts() {
        let both = |system: &System| {
            [(system.plant, system.plant_starts), (system.controller, system.controller_starts)]
        };
        for (model, starts) in SYSTEMS.iter().flat_map(|system| both(system)) {
            for (name, _) in starts.iter().filter(|(_, start)| matches!(start, Start::Shifted(_))) {
                let (_, variable) = model.description.find(name).unwrap();
                let text = variable.description;
                let quotes = text.contains(&format!("{} V", variable.start));
                assert_eq!(quotes, text.contains("rig's manual"), "{name}: {text}");
            }
        }
    }

    #[test]
    fn starts_that_do_not_exist_are_refused() {
        let of = |start: Start| start.number(RIG.controller.description, "observer.kind");
        assert_eq!(of(Start::Item("nonlinear")), Some(2.0));
        assert_eq!(of(Start::Item("unlinear")), None);
        assert_eq!(of(Start::SameAs("nothing")), None);
        assert_eq!(Start::Shifted(1.0).number(RIG.controller.description, "nothing"), None);
        let unknown = StartValues::default().set(RIG.controller.description, "observer.kind", f64::NAN);
        assert!(unknown.is_err());
    }
}
