//! Explicit Runge-Kutta step of order 5.
//!
//! The fifth-order formula of the pair by Dormand and Prince, "A family of embedded Runge-Kutta formulae", Journal
//! of Computational and Applied Mathematics 6(1), 1980, table 2 (RK5(4)7M). Without its error estimate six stages
//! are enough: the seventh only serves the fourth-order formula.

use core::array::from_fn;

/// Weights of the earlier rates in the stages 2 to 6.
const STAGES: [[f64; 5]; 5] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
];
/// Weights of the rates in the result.
const WEIGHTS: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// The solution of x' = `rate`(x) after `duration` \[s\], with an error of order `duration`^6.
#[inline]
pub fn step<const N: usize>(
    rate: impl Fn(&[f64; N]) -> [f64; N],
    state: &[f64; N],
    duration: f64,
) -> [f64; N] {
    let [second, third, fourth, fifth, sixth] = &STAGES;
    let k1 = rate(state);
    let k2 = rate(&moved(state, duration, second, &[&k1]));
    let k3 = rate(&moved(state, duration, third, &[&k1, &k2]));
    let k4 = rate(&moved(state, duration, fourth, &[&k1, &k2, &k3]));
    let k5 = rate(&moved(state, duration, fifth, &[&k1, &k2, &k3, &k4]));
    let k6 = rate(&moved(state, duration, sixth, &[&k1, &k2, &k3, &k4, &k5]));
    moved(state, duration, &WEIGHTS, &[&k1, &k2, &k3, &k4, &k5, &k6])
}

#[inline(always)]
fn moved<const N: usize, const K: usize>(
    state: &[f64; N],
    duration: f64,
    weights: &[f64],
    rates: &[&[f64; N]; K],
) -> [f64; N] {
    from_fn(|i| {
        let mean: f64 = weights.iter().zip(rates).map(|(weight, rate)| weight * rate[i]).sum();
        state[i] + duration * mean
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row sums of the stages: the time of each stage, as a share of the step.
    fn nodes() -> [f64; 6] {
        from_fn(|stage| if stage == 0 { 0.0 } else { STAGES[stage - 1].iter().sum() })
    }

    #[test]
    fn quadrature_conditions_hold_up_to_order_five() {
        let nodes = nodes();
        for power in 0..5 {
            let sum: f64 = (0..6).map(|i| WEIGHTS[i] * nodes[i].powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14, "power {power}: {sum}");
        }
    }

    /// A nonlinear system with a known solution, from (0, 1): x = sin t / (1 + t), y = cos t / (1 + t).
    fn spiral(state: &[f64; 2]) -> [f64; 2] {
        let radius = libm::sqrt(state[0] * state[0] + state[1] * state[1]);
        [state[1] - radius * state[0], -state[0] - radius * state[1]]
    }

    fn error(steps: u32) -> f64 {
        let mut state = [0.0, 1.0];
        for _ in 0..steps {
            state = step(spiral, &state, 4.0 / f64::from(steps));
        }
        (state[0] - 4f64.sin() / 5.0).abs().max((state[1] - 4f64.cos() / 5.0).abs())
    }

    #[test]
    fn error_falls_at_least_with_the_fifth_power_of_the_step() {
        for steps in [32, 64, 128] {
            let order = (error(steps) / error(2 * steps)).log2();
            assert!(order > 4.8, "{steps} steps: order {order}");
        }
        assert!(error(1024) < 1e-13, "{}", error(1024));
    }

    #[test]
    fn a_single_step_errs_with_the_sixth_power() {
        // x' = x: the step is the Taylor polynomial up to order 5 plus one term of order 6 (1/600 instead of 1/720).
        for duration in [0.1, 0.2] {
            let [grown] = step(|state: &[f64; 1]| *state, &[1.0], duration);
            let excess = (grown - f64::exp(duration)) / f64::powi(duration, 6);
            assert!((excess - (1.0 / 600.0 - 1.0 / 720.0)).abs() < 1e-4, "{excess}");
        }
    }
}
