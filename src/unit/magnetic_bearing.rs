//! What plant and controller of the magnetic bearing share: the choice of the map, bias and saturation flux.

use super::quantity::{Enumeration, MAGNETIC_FLUX};
use super::variable::{Kind, Variable};
use crate::plant::magnetic_bearing::Map;

pub static MAP: Enumeration = Enumeration {
    name: "BearingMap",
    description: "Closed form of a step under a held voltage",
    items: &[
        ("exact", "Solution of (3), split where the flux crosses zero"),
        ("printed", "Equation (4a) as printed, wrong across a flux zero crossing"),
    ],
};

/// Number of an item of [`MAP`] for use as a start value.
pub const EXACT: f64 = 1.0;
pub const PRINTED: f64 = 2.0;

pub fn map(value: f64) -> Map {
    if value == PRINTED { Map::Printed } else { Map::Exact }
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
