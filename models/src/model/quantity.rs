//! Quantities: what exported variables measure, and choices between named items.

use super::unit_of_measure::{
    METRE, METRE_PER_SECOND, METRE_PER_SECOND_SQUARED, ONE, PER_SECOND, PER_SECOND_SQUARED, SECOND,
    UnitOfMeasure, VOLT, VOLT_PER_METRE, VOLT_SECOND_PER_METRE, WEBER,
};

/// Type definition of a real variable: what is measured, in which unit, and how large it usually is.
#[derive(Debug)]
pub struct Quantity {
    pub name: &'static str,
    pub description: &'static str,
    pub unit: &'static UnitOfMeasure,
    pub nominal: f64,
}

pub static TIME: Quantity =
    Quantity { name: "Time", description: "Simulation time", unit: &SECOND, nominal: 1.0 };
pub static DURATION: Quantity =
    Quantity { name: "Duration", description: "Time interval", unit: &SECOND, nominal: 1e-3 };
pub static LENGTH: Quantity =
    Quantity { name: "Length", description: "Rotor displacement", unit: &METRE, nominal: 1e-2 };
pub static VELOCITY: Quantity =
    Quantity { name: "Velocity", description: "Rotor velocity", unit: &METRE_PER_SECOND, nominal: 1e-2 };
pub static ACCELERATION: Quantity = Quantity {
    name: "Acceleration",
    description: "Rotor acceleration",
    unit: &METRE_PER_SECOND_SQUARED,
    nominal: 1e-2,
};
pub static MAGNETIC_FLUX: Quantity =
    Quantity { name: "MagneticFlux", description: "Magnetic flux", unit: &WEBER, nominal: 0.1 };
pub static VOLTAGE: Quantity =
    Quantity { name: "Voltage", description: "Coil voltage", unit: &VOLT, nominal: 100.0 };
pub static POSITION_GAIN: Quantity = Quantity {
    name: "PositionGain",
    description: "Voltage per displacement",
    unit: &VOLT_PER_METRE,
    nominal: 1.0,
};
pub static VELOCITY_GAIN: Quantity = Quantity {
    name: "VelocityGain",
    description: "Voltage per velocity",
    unit: &VOLT_SECOND_PER_METRE,
    nominal: 10.0,
};
pub static SQUARED_RATE: Quantity = Quantity {
    name: "SquaredRate",
    description: "Acceleration per displacement",
    unit: &PER_SECOND_SQUARED,
    nominal: 10.0,
};
pub static RATE: Quantity =
    Quantity { name: "Rate", description: "Reciprocal of a time constant", unit: &PER_SECOND, nominal: 10.0 };
pub static RATIO: Quantity =
    Quantity { name: "Ratio", description: "Dimensionless number", unit: &ONE, nominal: 1.0 };

/// Enumeration type with its named items, numbered from 1.
#[derive(Debug)]
pub struct Enumeration {
    pub name: &'static str,
    pub description: &'static str,
    /// Name and description of each item.
    pub items: &'static [(&'static str, &'static str)],
}
