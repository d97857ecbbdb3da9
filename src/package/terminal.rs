//! The terminal of a model: what it exchanges with the other model of its loop.
//!
//! Both terminals of a loop carry the same member names, those of the plant's variables, and the same kind, so that an
//! importer can wire a loop by connecting one terminal with the other.

use crate::model::Description;
use crate::model::system::{System, systems};

/// One end of a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name that both ends of the wire share.
    pub name: &'static str,
    /// The model's own variable.
    pub variable: &'static str,
}

/// A model's side of a loop.
#[derive(Clone, Debug)]
pub struct Terminal {
    pub system: &'static System,
    /// In the order of the system's table: what the controller reads, then what acts on the plant.
    pub members: Vec<Member>,
}

impl Terminal {
    /// The terminals of a model, one for each loop that it is part of.
    pub fn all_of(description: &Description) -> Vec<Self> {
        systems().filter_map(|system| Self::new(description, system)).collect()
    }

    fn new(description: &Description, system: &'static System) -> Option<Self> {
        let of_plant = |(output, input): (&'static str, &'static str), is_sensed: bool| {
            let variable = if is_sensed { output } else { input };
            Member { name: variable, variable }
        };
        let of_controller = |(output, input): (&'static str, &'static str), is_sensed: bool| {
            let (name, variable) = if is_sensed { (output, input) } else { (input, output) };
            Member { name, variable }
        };
        let wires = system.sensing.iter().map(|wire| (*wire, true));
        let wires = wires.chain(system.actuation.iter().map(|wire| (*wire, false)));
        let members = if std::ptr::eq(description, system.plant.description) {
            wires.map(|(wire, is_sensed)| of_plant(wire, is_sensed)).collect()
        } else if std::ptr::eq(description, system.controller.description) {
            wires.map(|(wire, is_sensed)| of_controller(wire, is_sensed)).collect()
        } else {
            return None;
        };
        Some(Self { system, members })
    }

    /// The attribute `terminalKind`. A leading underscore marks kinds of a vendor (FMI 3.0.2, section 2.4.9.2.2).
    pub fn kind(&self) -> String {
        format!("_maglev-fmu_{}", self.system.name)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::model::variable::Causality;

    #[test]
    fn terminals_of_a_loop_match_and_outputs_meet_inputs() {
        for system in systems() {
            let [plant, controller] = [system.plant, system.controller].map(|model| {
                let terminals = Terminal::all_of(model.description);
                terminals.into_iter().find(|terminal| terminal.system.name == system.name).unwrap()
            });
            assert_eq!(plant.kind(), controller.kind());
            assert_eq!(plant.members.len(), system.sensing.len() + system.actuation.len());
            let names: BTreeSet<&str> = plant.members.iter().map(|member| member.name).collect();
            assert_eq!(names.len(), plant.members.len(), "{}: a member twice", system.name);
            for (of_plant, of_controller) in plant.members.iter().zip(&controller.members) {
                assert_eq!(of_plant.name, of_controller.name);
                let causality = |description: &Description, member: &Member| {
                    description.find(member.variable).unwrap().1.causality
                };
                let ends = [
                    causality(system.plant.description, of_plant),
                    causality(system.controller.description, of_controller),
                ];
                assert!(
                    [[Causality::Input, Causality::Output], [Causality::Output, Causality::Input]]
                        .contains(&ends),
                    "{}",
                    of_plant.name
                );
            }
        }
    }
}
