//! What plant and controller of the magnetic bearing share: the choice of the map, bias and saturation flux.

use super::choice::choice;
use super::quantity::{Enumeration, MAGNETIC_FLUX};
use super::variable::{Kind, Variable};
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
