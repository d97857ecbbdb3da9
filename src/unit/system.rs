//! Which plant and which controller belong together, and how they are wired.

use super::{
    LEVITATED_BALL_CONTROLLER, LEVITATED_BALL_PLANT, MAGLEV_RIG_CONTROLLER, MAGLEV_RIG_PLANT,
    MAGNETIC_BEARING_CONTROLLER, MAGNETIC_BEARING_PLANT, UnitType,
};

/// A plant with its controller. All wires carry reals.
#[derive(Debug)]
pub struct System {
    /// Short name, as on the command line.
    pub name: &'static str,
    pub plant: &'static UnitType,
    pub controller: &'static UnitType,
    /// Outputs of the plant and the inputs of the controller that take them.
    pub sensing: &'static [(&'static str, &'static str)],
    /// Outputs of the controller and the inputs of the plant that take them.
    pub actuation: &'static [(&'static str, &'static str)],
}

pub static BEARING: System = System {
    name: "bearing",
    plant: &MAGNETIC_BEARING_PLANT,
    controller: &MAGNETIC_BEARING_CONTROLLER,
    sensing: &[
        ("position_measured", "position"),
        ("velocity", "state.velocity"),
        ("flux", "state.flux"),
        ("voltage_measured", "voltage_applied"),
    ],
    actuation: &[("voltage", "voltage")],
};

pub static BALL: System = System {
    name: "ball",
    plant: &LEVITATED_BALL_PLANT,
    controller: &LEVITATED_BALL_CONTROLLER,
    sensing: &[
        ("current_measured", "current"),
        ("position", "state.position"),
        ("velocity", "state.velocity"),
        ("flux", "state.flux"),
        ("voltage_measured", "voltage_applied"),
    ],
    actuation: &[("voltage", "voltage")],
};

pub static RIG: System = System {
    name: "rig",
    plant: &MAGLEV_RIG_PLANT,
    controller: &MAGLEV_RIG_CONTROLLER,
    sensing: &[("sensor_voltage_measured", "sensor_voltage"), ("voltage_measured", "voltage_applied")],
    actuation: &[("voltage", "voltage")],
};

/// All systems, in the order of their units.
pub static SYSTEMS: &[&System] = &[&BEARING, &BALL, &RIG];

impl System {
    /// The system called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        SYSTEMS.iter().copied().find(|system| system.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::unit::quantity::UnitOfMeasure;
    use crate::unit::variable::{Causality, Kind};

    fn unit_of_end(unit: &UnitType, name: &str, causality: Causality) -> &'static UnitOfMeasure {
        let (_, variable) = unit.description.find(name).unwrap_or_else(|| panic!("no variable {name}"));
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
}
