//! Physical units and quantities of exported variables.

/// Unit with its exponents of the SI base units and the unit tools should display.
#[derive(Debug)]
pub struct UnitOfMeasure {
    pub name: &'static str,
    /// Exponents of kg, m, s, A.
    pub exponents: [i8; 4],
    /// Display unit: name and how many of it make one of this unit.
    pub display: Option<(&'static str, f64)>,
}

pub static METRE: UnitOfMeasure =
    UnitOfMeasure { name: "m", exponents: [0, 1, 0, 0], display: Some(("mm", 1e3)) };
pub static METRE_PER_SECOND: UnitOfMeasure =
    UnitOfMeasure { name: "m/s", exponents: [0, 1, -1, 0], display: Some(("mm/s", 1e3)) };
pub static METRE_PER_SECOND_SQUARED: UnitOfMeasure =
    UnitOfMeasure { name: "m/s2", exponents: [0, 1, -2, 0], display: None };
pub static WEBER: UnitOfMeasure =
    UnitOfMeasure { name: "Wb", exponents: [1, 2, -2, -1], display: Some(("mWb", 1e3)) };
pub static VOLT: UnitOfMeasure = UnitOfMeasure { name: "V", exponents: [1, 2, -3, -1], display: None };
pub static VOLT_PER_METRE: UnitOfMeasure =
    UnitOfMeasure { name: "V/m", exponents: [1, 1, -3, -1], display: None };
pub static VOLT_SECOND_PER_METRE: UnitOfMeasure =
    UnitOfMeasure { name: "V.s/m", exponents: [1, 1, -2, -1], display: None };
pub static PER_SECOND: UnitOfMeasure = UnitOfMeasure { name: "1/s", exponents: [0, 0, -1, 0], display: None };
pub static PER_SECOND_SQUARED: UnitOfMeasure =
    UnitOfMeasure { name: "1/s2", exponents: [0, 0, -2, 0], display: None };
pub static PER_SECOND_CUBED: UnitOfMeasure =
    UnitOfMeasure { name: "1/s3", exponents: [0, 0, -3, 0], display: None };
pub static KILOGRAM: UnitOfMeasure =
    UnitOfMeasure { name: "kg", exponents: [1, 0, 0, 0], display: Some(("g", 1e3)) };
pub static NEWTON: UnitOfMeasure =
    UnitOfMeasure { name: "N", exponents: [1, 1, -2, 0], display: Some(("mN", 1e3)) };
pub static AMPERE: UnitOfMeasure = UnitOfMeasure { name: "A", exponents: [0, 0, 0, 1], display: None };
pub static AMPERE_PER_VOLT: UnitOfMeasure =
    UnitOfMeasure { name: "A/V", exponents: [-1, -2, 3, 2], display: None };
pub static OHM: UnitOfMeasure = UnitOfMeasure { name: "Ohm", exponents: [1, 2, -3, -2], display: None };
pub static NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE: UnitOfMeasure =
    UnitOfMeasure { name: "N.m2/A2", exponents: [1, 3, -2, -2], display: None };
pub static SECOND: UnitOfMeasure = UnitOfMeasure { name: "s", exponents: [0, 0, 1, 0], display: None };
pub static ONE: UnitOfMeasure = UnitOfMeasure { name: "1", exponents: [0, 0, 0, 0], display: None };

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
