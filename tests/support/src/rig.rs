//! Choices of the rig's controller.

/// Numbers of items of enumerations.
pub const NONLINEAR: f64 = 2.0;
pub const KALMAN: f64 = 3.0;
pub const WINDOWED_NEWTON: f64 = 4.0;
pub const EXACT: f64 = 1.0;
pub const RUNGE_KUTTA: f64 = 2.0;
pub const EULER: f64 = 3.0;
pub const CURRENT: f64 = 2.0;
pub const METRES: f64 = 2.0;
pub const MATCHED: f64 = 1.0;
pub const ZERO: f64 = 2.0;
pub const APPLIED: f64 = 2.0;
pub const DISTURBANCE_REJECTION: f64 = 2.0;

/// Parameters of a loop through the extended state that works.
pub const THROUGH_EXTENDED_STATE: [(&str, f64); 3] = [
    ("controller.kind", DISTURBANCE_REJECTION),
    ("observer.bandwidth", 300.0),
    ("observer.input_gain", -3705.0),
];
