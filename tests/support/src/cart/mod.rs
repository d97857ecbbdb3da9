//! A cart on a rail and a controller that moves it to a place: a plant and a controller that the library does not have.
//!
//! A program that links this crate has them beside the library's models, so that tests of what holds for every model hold for
//! one that they have never seen. What is here is all that a new plant and a new controller take.

mod controller;
mod plant;

use linkme::distributed_slice;
use maglev_fmu::model::quantity::Quantity;
use maglev_fmu::model::system::{System, USE_APPLIED_VOLTAGE};
use maglev_fmu::model::unit_of_measure::{KILOGRAM, METRE, METRE_PER_SECOND, NEWTON_PER_VOLT, VOLT};
use maglev_fmu::model::{ADDED_MODELS, ADDED_SYSTEMS, ModelType, Registration};

static PLANT: ModelType = ModelType::of::<plant::CartPlant>(&plant::DESCRIPTION);

static CONTROLLER: ModelType = ModelType::of::<controller::CartController>(&controller::DESCRIPTION);

#[distributed_slice(ADDED_MODELS)]
static PLANT_REGISTRATION: Registration = Registration::of::<plant::CartPlant>(
    &PLANT,
    ICON,
    "m x'' = k u - d x'. The voltage is held over a communication step or has a slope.",
);

#[distributed_slice(ADDED_MODELS)]
static CONTROLLER_REGISTRATION: Registration = Registration::of::<controller::CartController>(
    &CONTROLLER,
    ICON,
    "u = kp (reference - y) - kd v, limited to the voltage limit.",
);

#[distributed_slice(ADDED_SYSTEMS)]
static SYSTEM: System = System {
    name: "cart",
    plant: &PLANT,
    controller: &CONTROLLER,
    sensing: &[("position_measured", "position"), ("voltage_measured", "voltage_applied")],
    actuation: &[("voltage", "voltage")],
    plant_starts: &[],
    controller_starts: &[USE_APPLIED_VOLTAGE],
    longest_step: 10e-3,
    remark: "",
};

static POSITION: Quantity = Quantity {
    name: "CartPosition",
    description: "Position of the cart on its rail",
    unit: &METRE,
    nominal: 0.1,
};
static VELOCITY: Quantity = Quantity {
    name: "CartVelocity",
    description: "Velocity of the cart",
    unit: &METRE_PER_SECOND,
    nominal: 0.1,
};
static VOLTAGE: Quantity =
    Quantity { name: "MotorVoltage", description: "Voltage of the motor", unit: &VOLT, nominal: 1.0 };

static MASS: Quantity =
    Quantity { name: "CartMass", description: "Mass of the cart", unit: &KILOGRAM, nominal: 1.0 };
static MOTOR_CONSTANT: Quantity = Quantity {
    name: "MotorConstant",
    description: "Force per voltage",
    unit: &NEWTON_PER_VOLT,
    nominal: 1.0,
};

/// Drawing of the cart.
const ICON: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200" width="200" height="200">
<rect x="40" y="80" width="120" height="50" fill="#1f4e79"/><circle cx="70" cy="145" r="15"/>
<circle cx="130" cy="145" r="15"/><path d="M10 162H190" stroke="#000" stroke-width="4"/>
</svg>
"##;
