//! What plant and controller of the magnetic bearing share: the choice of the map, bias and saturation flux, their loop.

use super::choice::choice;
use super::quantity::{Enumeration, MAGNETIC_FLUX};
use super::system::{System, USE_APPLIED_VOLTAGE};
use super::variable::{Kind, Variable};
use super::{MAGNETIC_BEARING_CONTROLLER, MAGNETIC_BEARING_PLANT};
use crate::plant::magnetic_bearing::Map;

choice! {
    /// Closed form of a step.
    pub enum MapChoice = "BearingMap", "Closed form of a step under a held voltage" {
        Exact = "exact", "Solution of (3), split where the flux crosses zero";
        Printed = "printed", "Equation (4a) as printed, wrong across a flux zero crossing";
    }
}

pub static MAP: Enumeration = MapChoice::ENUMERATION;

/// The map that a value of the table stands for.
pub fn map(value: f64) -> Map {
    match MapChoice::from_number(value) {
        MapChoice::Exact => Map::Exact,
        MapChoice::Printed => Map::Printed,
    }
}

pub const fn bias_flux() -> Variable {
    Variable::parameter("bias_flux", Kind::Real(&MAGNETIC_FLUX), 0.0)
        .range(0.0, 1.0)
        .describe("Phi0, bias flux; 0 is operation without bias")
}

pub const fn saturation_flux() -> Variable {
    Variable::parameter("saturation_flux", Kind::Real(&MAGNETIC_FLUX), 0.0022)
        .range(1e-6, 1.0)
        .describe("Phi_sat, saturation flux; epsilon = 2 bias_flux / saturation_flux")
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
    plant_starts: &[],
    controller_starts: &[USE_APPLIED_VOLTAGE],
    // With steps twice as long and a master that steps both models at once the loop is lost.
    longest_step: 1e-3,
    remark: " The sample time of 1 ms has to be a multiple of the step, as it is of 0.5 ms: otherwise ticks lie within steps \
        and the observer takes a position for that of a later time, which loses the rotor.",
};
