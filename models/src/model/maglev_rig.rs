//! What plant and controller of the maglev rig share: quantities, sensor, limits of the voltage, their loop.

use super::quantity::Quantity;
use super::system::{Start, System, USE_APPLIED_VOLTAGE};
use super::unit_of_measure::{
    AMPERE, AMPERE_PER_VOLT, KILOGRAM, METRE, METRE_PER_SECOND, METRE_PER_SECOND_SQUARED, NEWTON,
    NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE, ONE, PER_SECOND, PER_SECOND_CUBED, PER_SECOND_SQUARED, VOLT,
    VOLT_PER_METRE,
};
use super::variable::{Kind, Variable};
use super::{MAGLEV_RIG_CONTROLLER, MAGLEV_RIG_PLANT};
use crate::plant::maglev_rig::{MaglevRig, PositionSensor};

pub static BALL_DISTANCE: Quantity = Quantity {
    name: "BallDistance",
    description: "Distance from coil to ball, positive downwards",
    unit: &METRE,
    nominal: 0.01,
};
pub static BALL_VELOCITY: Quantity = Quantity {
    name: "BallFallVelocity",
    description: "Velocity of the ball, positive downwards",
    unit: &METRE_PER_SECOND,
    nominal: 0.1,
};
pub static BALL_ACCELERATION: Quantity = Quantity {
    name: "BallFallAcceleration",
    description: "Acceleration of the ball, positive downwards",
    unit: &METRE_PER_SECOND_SQUARED,
    nominal: 10.0,
};
pub static DRIVER_VOLTAGE: Quantity = Quantity {
    name: "DriverVoltage",
    description: "Voltage at the coil's driver",
    unit: &VOLT,
    nominal: 1.0,
};
pub static SENSOR_VOLTAGE: Quantity = Quantity {
    name: "SensorVoltage",
    description: "Voltage of the position sensor, the larger the lower the ball",
    unit: &VOLT,
    nominal: 1.0,
};
pub static SENSOR_NOISE: Quantity = Quantity {
    name: "SensorVoltageDeviation",
    description: "Small part of a sensor voltage",
    unit: &VOLT,
    nominal: 1e-3,
};
pub static RIG_CURRENT: Quantity =
    Quantity { name: "RigCoilCurrent", description: "Coil current", unit: &AMPERE, nominal: 1.0 };
pub static RIG_FORCE: Quantity = Quantity {
    name: "RigBallForce",
    description: "Force on the ball, positive downwards",
    unit: &NEWTON,
    nominal: 0.1,
};
pub static RIG_MASS: Quantity =
    Quantity { name: "RigBallMass", description: "Mass of the ball", unit: &KILOGRAM, nominal: 0.01 };
pub static RIG_GRAVITY: Quantity = Quantity {
    name: "RigGravity",
    description: "Acceleration of gravity",
    unit: &METRE_PER_SECOND_SQUARED,
    nominal: 10.0,
};
pub static ELECTROMAGNETIC_CONSTANT: Quantity = Quantity {
    name: "ElectromagneticConstant",
    description: "Magnetic force times squared distance per squared current",
    unit: &NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE,
    nominal: 1e-5,
};
pub static DRIVER_GAIN: Quantity = Quantity {
    name: "DriverGain",
    description: "Coil current per voltage at the driver",
    unit: &AMPERE_PER_VOLT,
    nominal: 1.0,
};
pub static SENSOR_GAIN: Quantity = Quantity {
    name: "SensorGain",
    description: "Sensor voltage per distance",
    unit: &VOLT_PER_METRE,
    nominal: 100.0,
};

/// Quantities in the unit that `observer.measurement` selects; a variable of a model description has one unit only.
pub static OBSERVED_POSITION: Quantity = Quantity {
    name: "ObservedPosition",
    description: "Position in V or m, as observer.measurement selects",
    unit: &ONE,
    nominal: 1.0,
};
pub static OBSERVED_VELOCITY: Quantity = Quantity {
    name: "ObservedVelocity",
    description: "Velocity in V/s or m/s, as observer.measurement selects",
    unit: &ONE,
    nominal: 1.0,
};
pub static OBSERVED_ACCELERATION: Quantity = Quantity {
    name: "ObservedAcceleration",
    description: "Acceleration in V/s2 or m/s2, as observer.measurement selects",
    unit: &ONE,
    nominal: 1e3,
};
pub static OBSERVED_INPUT_GAIN: Quantity = Quantity {
    name: "ObservedInputGain",
    description: "Acceleration per driver voltage in 1/s2 or m/(s2.V), as observer.measurement selects",
    unit: &ONE,
    nominal: 1e3,
};
pub static INPUT_GAIN: Quantity = Quantity {
    name: "InputGain",
    description: "Acceleration in sensor volts per driver voltage",
    unit: &PER_SECOND_SQUARED,
    nominal: 1e3,
};
pub static BANDWIDTH: Quantity = Quantity {
    name: "Bandwidth",
    description: "Negative of a multiple pole, in rad/s",
    unit: &PER_SECOND,
    nominal: 100.0,
};
pub static FIRST_OBSERVER_GAIN: Quantity = Quantity {
    name: "FirstObserverGain",
    description: "Gain from the error to the rate of the position",
    unit: &PER_SECOND,
    nominal: 100.0,
};
pub static SECOND_OBSERVER_GAIN: Quantity = Quantity {
    name: "SecondObserverGain",
    description: "Gain from the error to the rate of the velocity",
    unit: &PER_SECOND_SQUARED,
    nominal: 1e4,
};
pub static THIRD_OBSERVER_GAIN: Quantity = Quantity {
    name: "ThirdObserverGain",
    description: "Gain from the error to the rate of the extended state",
    unit: &PER_SECOND_CUBED,
    nominal: 1e6,
};

/// Sensor voltage at 9 mm \[V\], the operating point of the rig's manual.
pub const OPERATING_SENSOR_VOLTAGE: f64 = -1.50868;
/// Voltage \[V\] that holds the ball there, from Table 1.
pub const OPERATING_VOLTAGE: f64 = 0.758_946_638_440_411;

pub const fn mass() -> Variable {
    Variable::parameter("mass", Kind::Real(&RIG_MASS), MaglevRig::PRINTED.mass)
        .range(1e-6, 1e3)
        .describe("m, printed in Table 1")
}

pub const fn gravity() -> Variable {
    Variable::parameter("gravity", Kind::Real(&RIG_GRAVITY), MaglevRig::PRINTED.gravity)
        .range(-100.0, 100.0)
        .describe("g, printed in Table 1")
}

pub const fn electromagnetic_constant() -> Variable {
    let start = MaglevRig::PRINTED.electromagnetic_constant;
    Variable::parameter("electromagnetic_constant", Kind::Real(&ELECTROMAGNETIC_CONSTANT), start)
        .range(0.0, 1.0)
        .describe("K, printed in Table 1 without a unit")
}

pub const fn driver_gain() -> Variable {
    Variable::parameter("driver_gain", Kind::Real(&DRIVER_GAIN), MaglevRig::PRINTED.driver_gain)
        .range(0.0, 100.0)
        .describe("k1, current per voltage of the driver with its inner loop, printed in Table 1")
}

pub const fn sensor_gain() -> Variable {
    Variable::parameter("sensor_gain", Kind::Real(&SENSOR_GAIN), PositionSensor::MANUAL.gain)
        .range(1e-3, 1e6)
        .describe("k2, sensor voltage per distance; from the rig's manual")
}

pub const fn sensor_offset() -> Variable {
    Variable::parameter("sensor_offset", Kind::Real(&SENSOR_VOLTAGE), PositionSensor::MANUAL.offset)
        .range(-1e3, 1e3)
        .describe("eta, sensor voltage at the coil; -2.8 V in the rig's manual")
}

/// Smallest voltage: the driver does not push, so that 0 is where its force ends.
pub const fn voltage_min(name: &'static str) -> Variable {
    Variable::tunable(name, Kind::Real(&DRIVER_VOLTAGE), 0.0).range(-100.0, 0.0).describe(
        "Smallest voltage; negative ones attract as positive ones do, as the force goes with the square",
    )
}

pub const fn voltage_max(name: &'static str) -> Variable {
    Variable::tunable(name, Kind::Real(&DRIVER_VOLTAGE), 5.0)
        .range(0.0, 100.0)
        .describe("Largest voltage; 5 V in the rig's manual")
}

/// The packaged rig's sensor is adjusted to read 0 V at the operating point, so that a wire at zero means no motion
/// and an open reference keeps the ball where it is.
const SENSOR_SHIFT: f64 = -OPERATING_SENSOR_VOLTAGE;

pub static RIG: System = System {
    name: "rig",
    plant: &MAGLEV_RIG_PLANT,
    controller: &MAGLEV_RIG_CONTROLLER,
    sensing: &[("sensor_voltage_measured", "sensor_voltage"), ("voltage_measured", "voltage_applied")],
    actuation: &[("voltage", "voltage")],
    plant_starts: &[
        ("sensor_offset", Start::Shifted(SENSOR_SHIFT)),
        ("sensor.minimum", Start::Shifted(SENSOR_SHIFT)),
        ("sensor.maximum", Start::Shifted(SENSOR_SHIFT)),
    ],
    controller_starts: &[
        USE_APPLIED_VOLTAGE,
        ("sensor_offset", Start::Shifted(SENSOR_SHIFT)),
        ("sensor_voltage", Start::Shifted(SENSOR_SHIFT)),
        ("reference", Start::Shifted(SENSOR_SHIFT)),
        // With the printed one, of the wrong sign, the estimate is off as soon as the voltage moves.
        ("observer.input_gain", Start::SameAs("controller.input_gain")),
    ],
    // With steps twice as long and a master that steps both models at once the loop is lost.
    longest_step: 1e-3,
    remark: " The sensor is adjusted to read 0 V at 9 mm, where a reference of 0 V keeps the ball.",
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operating_point_is_a_rest_of_the_rig() {
        assert_eq!(OPERATING_SENSOR_VOLTAGE, PositionSensor::MANUAL.voltage(9e-3));
        let difference = OPERATING_VOLTAGE - MaglevRig::PRINTED.operating_voltage(9e-3);
        assert!(difference.abs() < 1e-15, "{difference:e}");
    }
}
