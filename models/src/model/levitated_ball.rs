//! What plant and controller of the levitated ball share: quantities, the parameters of ball and coil, their loop.

use super::quantity::Quantity;
use super::system::{Start, System, USE_APPLIED_VOLTAGE};
use super::unit_of_measure::{
    AMPERE, KILOGRAM, METRE, METRE_PER_SECOND, METRE_PER_SECOND_SQUARED, NEWTON,
    NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE, OHM, PER_SECOND, PER_SECOND_SQUARED, VOLT, WEBER,
};
use super::variable::{Kind, Variable};
use super::{LEVITATED_BALL_CONTROLLER, LEVITATED_BALL_PLANT};
use crate::plant::levitated_ball::LevitatedBall;

pub static POSITION: Quantity = Quantity {
    name: "BallPosition",
    description: "Position of the ball, positive upwards",
    unit: &METRE,
    nominal: 1e-3,
};
pub static VELOCITY: Quantity = Quantity {
    name: "BallVelocity",
    description: "Velocity of the ball, positive upwards",
    unit: &METRE_PER_SECOND,
    nominal: 0.1,
};
pub static ACCELERATION: Quantity = Quantity {
    name: "BallAcceleration",
    description: "Acceleration of the ball, positive upwards",
    unit: &METRE_PER_SECOND_SQUARED,
    nominal: 1.0,
};
pub static FLUX: Quantity =
    Quantity { name: "FluxLinkage", description: "Flux linkage of the coil", unit: &WEBER, nominal: 1e-2 };
pub static VOLTAGE: Quantity =
    Quantity { name: "MagnetVoltage", description: "Voltage at the coil", unit: &VOLT, nominal: 1.0 };
pub static CURRENT: Quantity =
    Quantity { name: "MagnetCurrent", description: "Current through the coil", unit: &AMPERE, nominal: 1.0 };
pub static FORCE: Quantity = Quantity {
    name: "BallForce",
    description: "Force on the ball, positive upwards",
    unit: &NEWTON,
    nominal: 1.0,
};
pub static MASS: Quantity =
    Quantity { name: "BallMass", description: "Mass of the ball", unit: &KILOGRAM, nominal: 0.1 };
pub static RESISTANCE: Quantity =
    Quantity { name: "Resistance", description: "Resistance of the coil", unit: &OHM, nominal: 1.0 };
pub static INDUCTANCE_CONSTANT: Quantity = Quantity {
    name: "InductanceConstant",
    description: "Inductance of the coil times gap",
    unit: &NEWTON_SQUARE_METRE_PER_SQUARE_AMPERE,
    nominal: 1e-4,
};
pub static RATE: Quantity = Quantity {
    name: "ObserverRate",
    description: "Reciprocal of a time constant of an observer, a filter or a loop",
    unit: &PER_SECOND,
    nominal: 100.0,
};
pub static ADAPTATION_GAIN: Quantity = Quantity {
    name: "AdaptationGain",
    description: "Gain of an integral term",
    unit: &PER_SECOND_SQUARED,
    nominal: 1e3,
};

/// lam0 of [`LevitatedBall::LABORATORY`] \[Wb\], a start value.
pub const LABORATORY_FLUX: f64 = 0.010_298_006_650_609_622;

pub const fn mass() -> Variable {
    Variable::parameter("mass", Kind::Real(&MASS), LevitatedBall::LABORATORY.mass)
        .range(1e-6, 1e3)
        .describe("m, assumed: a typical laboratory rig; the paper's value is lost")
}

pub const fn resistance() -> Variable {
    Variable::parameter("resistance", Kind::Real(&RESISTANCE), LevitatedBall::LABORATORY.resistance)
        .range(1e-3, 1e3)
        .describe("R, assumed as the mass is")
}

pub const fn inductance_constant() -> Variable {
    Variable::parameter(
        "inductance_constant",
        Kind::Real(&INDUCTANCE_CONSTANT),
        LevitatedBall::LABORATORY.inductance_constant,
    )
    .range(1e-7, 1.0)
    .describe("k: the inductance is k / (gap - position); assumed as the mass is")
}

pub const fn gap() -> Variable {
    Variable::parameter("gap", Kind::Real(&POSITION), LevitatedBall::LABORATORY.gap)
        .range(1e-5, 1.0)
        .describe("c, position of the magnet's face; assumed as the mass is")
}

pub const fn gravity() -> Variable {
    Variable::parameter("gravity", Kind::Real(&ACCELERATION), LevitatedBall::LABORATORY.gravity)
        .range(1e-3, 100.0)
        .describe("g")
}

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
    plant_starts: &[],
    // The estimator of the paper needs a moving reference; in a package the reference rests until a tool drives it.
    controller_starts: &[USE_APPLIED_VOLTAGE, ("observer.kind", Start::Item("polynomial_newton"))],
    // With steps twice as long and a master that steps both models at once the loop is lost.
    longest_step: 1e-3,
    remark: " The observer is polynomial_newton, which needs no motion; the paper's, drem, needs a moving reference.",
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_value_is_the_flux_that_carries_the_ball() {
        assert_eq!(LABORATORY_FLUX, LevitatedBall::LABORATORY.equilibrium_flux());
    }
}
