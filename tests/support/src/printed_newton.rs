//! The Newton observer exactly as the paper prints it, independent of the shipped one: H from the expanded
//! formulas of section 3, its Jacobian differentiated by hand with d|x|/dx = sgn(x), a general 3x3 solve and
//! always d iterations. Reference for tests and baseline for benchmarks.

use nalgebra::{Matrix3, Vector3};

/// (4a) as printed; `x` = (position, velocity, flux).
pub fn printed_map(x: Vector3<f64>, u: f64, epsilon: f64, t: f64) -> Vector3<f64> {
    let s = sign(x[2]);
    let force = epsilon * x[2] + x[2] * x[2].abs();
    Vector3::new(
        x[0] + t * x[1]
            + t.powi(2) / 2.0 * force
            + t.powi(3) / 6.0 * u * (epsilon + 2.0 * s * x[2])
            + t.powi(4) / 12.0 * u * u * s,
        x[1] + t * force + t.powi(2) / 2.0 * u * (epsilon + 2.0 * s * x[2]) + t.powi(3) / 3.0 * u * u * s,
        x[2] + u * t,
    )
}

/// h1, h2, h3 of the paper, as printed.
pub fn outputs(x: Vector3<f64>, u: [f64; 2], epsilon: f64, t: f64) -> Vector3<f64> {
    let [u2, u1] = u;
    let z = t * u2 + x[2];
    let s = sign(x[2]);
    let sz = sign(z);
    Vector3::new(
        x[0],
        x[0] + t * x[1]
            + t.powi(2) / 2.0 * (epsilon * x[2] + x[2] * x[2].abs())
            + t.powi(3) / 6.0 * u2 * (epsilon + 2.0 * s * x[2])
            + t.powi(4) / 12.0 * u2 * u2 * s,
        (5.0 * t.powi(4) * s * u2 * u2
            + t.powi(4) * sz * u1 * u1
            + 2.0 * t.powi(3) * u2 * (7.0 * epsilon + 3.0 * z.abs() + 2.0 * t * sz * u1 + 8.0 * s * x[2])
            + 2.0 * t.powi(3) * u1 * (epsilon + 2.0 * sz * x[2])
            + 6.0
                * (2.0 * x[0] + t * (4.0 * x[1] + t * (4.0 * epsilon + 3.0 * x[2].abs() + z.abs()) * x[2])))
            / 12.0,
    )
}

/// Derivative of [`outputs`] with respect to x.
pub fn jacobian(x: Vector3<f64>, u: [f64; 2], epsilon: f64, t: f64) -> Matrix3<f64> {
    let [u2, u1] = u;
    let z = t * u2 + x[2];
    let s = sign(x[2]);
    let sz = sign(z);
    let second = t.powi(2) / 2.0 * (epsilon + 2.0 * x[2].abs()) + t.powi(3) / 3.0 * u2 * s;
    let third = (2.0 * t.powi(3) * u2 * (3.0 * sz + 8.0 * s)
        + 4.0 * t.powi(3) * u1 * sz
        + 6.0 * t * t * (4.0 * epsilon + 6.0 * x[2].abs() + z.abs() + sz * x[2]))
        / 12.0;
    Matrix3::new(1.0, 0.0, 0.0, 1.0, t, second, 1.0, 2.0 * t, third)
}

/// d iterations of (6); `None` when a Jacobian is singular.
pub fn invert(
    y: [f64; 3],
    u: [f64; 2],
    guess: Vector3<f64>,
    d: u32,
    alpha: f64,
    epsilon: f64,
    t: f64,
) -> Option<Vector3<f64>> {
    let mut w = guess;
    for _ in 0..d {
        let residual = Vector3::from(y) - outputs(w, u, epsilon, t);
        w += alpha * jacobian(w, u, epsilon, t).lu().solve(&residual)?;
    }
    Some(w)
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}
