//! Choices of the bearing's controller.

/// Every observer of the controller, as its parameters; the square Newton observer also with the exact map, with a
/// line search and with small steps.
pub const OBSERVERS: [(&str, &[(&str, f64)]); 8] = [
    ("newton", &[]),
    ("newton, exact map", &[("observer.map", EXACT)]),
    ("newton, line search", &[("observer.map", EXACT), ("observer.line_search", 1.0)]),
    ("newton, small steps", &[("observer.max_iterations", 20.0), ("observer.step_size", 0.7)]),
    ("newton, N = 10", &[("observer.map", EXACT), ("observer.window", 10.0)]),
    ("reduced_newton", &[("observer.kind", 2.0), ("observer.filter_time", 2e-3)]),
    ("reduced_newton_compensated", &[("observer.kind", 3.0), ("observer.map", EXACT)]),
    (
        "kalman",
        &[("observer.kind", KALMAN), ("observer.position_noise", 1e-7), ("observer.flux_noise", 1e-7)],
    ),
];

/// Numbers of items of enumerations.
pub const EXACT: f64 = 1.0;
pub const KALMAN: f64 = 4.0;
pub const APPLIED: f64 = 2.0;
pub const FLUX_CASCADE: f64 = 4.0;
