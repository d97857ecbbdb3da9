//! The flux regression, its mixing and the filters on a motion that is known exactly.

use maglev_fmu::observer::drem::{Drem, MixingSettings};
use maglev_fmu::observer::flux_regression::{
    FluxRegression, FluxRegressionSettings, Sample, residual_and_slope,
};
use maglev_fmu::observer::polynomial_newton::limited_error;
use maglev_fmu::plant::levitated_ball::LevitatedBall;
use maglev_fmu::signal::FirstOrderHold;
use nalgebra::{Matrix4, Matrix5, Vector4};
use proptest::prelude::*;

const RATES: [f64; 2] = [100.0, 300.0];
const FILTERS: [f64; 4] = [10.0, 25.0, 60.0, 150.0];
/// theta, as a share of lam0.
const OFFSET: f64 = 0.1;

fn settings() -> FluxRegressionSettings {
    let ball = LevitatedBall::LABORATORY;
    FluxRegressionSettings { rates: RATES, gravity: ball.gravity / ball.gap }
}

/// A motion of the ball in closed form: z = 1 - A/c (sin w t + sin 2.2 w t + sin 3.7 w t) under the flux it needs,
/// l^2 = 1 + v' / W2 = 1 - z'' / W2.
fn motion(amplitude: f64, time: f64) -> Sample {
    let LevitatedBall { gap, gravity, .. } = LevitatedBall::LABORATORY;
    let (mut height, mut acceleration) = (0.0, 0.0);
    for multiple in [1.0, 2.2, 3.7] {
        let rate = 15.0 * multiple;
        height += amplitude * (rate * time).sin();
        acceleration -= amplitude * rate * rate * (rate * time).sin();
    }
    let flux = (1.0 + acceleration / gravity).sqrt();
    Sample { flux: flux - OFFSET, current: (1.0 - height / gap) * flux }
}

/// Regression and mixing over `duration` [s] of the motion; `seen` gets time, regression and mixing after each sample.
fn run(amplitude: f64, step: f64, duration: f64, mut seen: impl FnMut(f64, &FluxRegression, &Drem)) {
    let settings = settings();
    let prefilters = RATES.map(|rate| FirstOrderHold::low_pass(rate, step));
    let filters = FILTERS.map(|rate| FirstOrderHold::low_pass(rate, step));
    let mut regression = FluxRegression::new(motion(amplitude, 0.0));
    let mut mixing = Drem::at_rest(regression.coefficients(&settings));
    for sample in 1..=(duration / step).round() as u32 {
        let time = step * f64::from(sample);
        regression.advance(&prefilters, motion(amplitude, time));
        let coefficients = regression.coefficients(&settings);
        if time < 0.2 {
            mixing = Drem::at_rest(coefficients);
        } else {
            mixing.advance(&filters, coefficients);
        }
        seen(time, &regression, &mixing);
    }
}

/// Largest residual at the true offset from 0.5 s on.
fn residual(step: f64) -> f64 {
    let mut largest = 0f64;
    run(0.6e-3, step, 1.0, |time, regression, _| {
        if time > 0.5 {
            largest = largest.max(residual_and_slope(&regression.coefficients(&settings()), OFFSET).0.abs());
        }
    });
    largest
}

#[test]
fn residual_at_the_true_offset_falls_with_the_square_of_the_sample_time() {
    let residuals = [2e-4, 1e-4, 5e-5, 2.5e-5, 6.25e-6].map(residual);
    for pair in residuals[..4].windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{residuals:?}");
    }
    assert!(residuals[1] < 1e-4 && residuals[4] < 3e-7, "{residuals:?}");
}

#[test]
fn a_wrong_offset_leaves_a_residual() {
    run(0.6e-3, 1e-4, 1.0, |time, regression, _| {
        if time > 0.5 {
            let (residual, slope) = residual_and_slope(&regression.coefficients(&settings()), OFFSET + 0.01);
            assert!(residual > 0.005 && slope > 0.5, "{time}: {residual} {slope}");
        }
    });
}

/// The equation of five monomials, (theta, ..., theta^5), with the regression itself and its four low-passes as rows.
#[test]
fn both_forms_of_the_mixing_have_the_same_determinants() {
    let mut compared = 0;
    run(0.6e-3, 1e-4, 2.0, |time, regression, mixing| {
        if time < 0.5 || !((time * 1e4).round() as u32).is_multiple_of(100) {
            return;
        }
        let coefficients = regression.coefficients(&settings());
        let high_passed = mixing.filtered();
        let low_passed = |row: usize, q: usize| match row {
            0 => coefficients[q],
            _ => coefficients[q] - high_passed[row - 1][q],
        };
        let five = Matrix5::from_fn(|row, q| if q < 4 { low_passed(row, q + 1) } else { 1.0 });
        let right_side = Matrix5::from_fn(|row, q| if q == 0 { -low_passed(row, 0) } else { five[(row, q)] });
        let equation = mixing.mix();
        // The excitation is some 1e-8; where it is nearly zero, rounding errors of the larger determinant decide.
        assert!((five.determinant() - equation.excitation).abs() < 1e-17, "{time}");
        assert!((right_side.determinant() - equation.right_side).abs() < 1e-17, "{time}");
        if equation.excitation.abs() > 1e-9 {
            let relative = five.determinant() / equation.excitation - 1.0;
            assert!(relative.abs() < 1e-9, "{time}: {relative:e}");
            compared += 1;
        }
    });
    assert!(compared > 20, "{compared}");
}

fn root_mean_square_excitation(amplitude: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    run(amplitude, 1e-4, 4.0, |time, _, mixing| {
        if time > 1.0 {
            sum += mixing.mix().excitation.powi(2);
            count += 1.0;
        }
    });
    f64::sqrt(sum / count)
}

#[test]
fn excitation_grows_with_the_sixth_power_of_the_amplitude() {
    let amplitudes = [0.1e-3, 0.2e-3, 0.4e-3, 0.8e-3];
    let excitations = amplitudes.map(root_mean_square_excitation);
    for (small, large) in [(0, 1), (1, 2), (2, 3), (0, 3)] {
        let growth =
            (excitations[large] / excitations[small]).ln() / (amplitudes[large] / amplitudes[small]).ln();
        assert!((growth - 6.0).abs() < 0.3, "{excitations:?}: {growth}");
    }
}

#[test]
fn a_ball_at_rest_excites_nothing_and_balances_forces() {
    for offset in [-0.2, 0.0, 0.3] {
        let sample = Sample { flux: 1.0 - offset, current: 0.7 };
        let regression = FluxRegression::new(sample);
        let coefficients = regression.coefficients(&settings());
        // f = l^5 - l^3
        for theta in [-0.1, 0.0, 0.2] {
            let flux = sample.flux + theta;
            let (residual, slope) = residual_and_slope(&coefficients, theta);
            assert!((residual - (flux.powi(5) - flux.powi(3))).abs() < 1e-13, "{residual}");
            assert!((slope - (5.0 * flux.powi(4) - 3.0 * flux.powi(2))).abs() < 1e-12, "{slope}");
        }
        assert!(limited_error(&coefficients, offset).abs() < 1e-15);
        assert_eq!(Drem::at_rest(coefficients).mix().excitation, 0.0);
    }
}

/// Four rows of coefficients that are all straight jumps: the mixing is Cramer's rule.
fn jumped(rows: &[[f64; 5]; 4]) -> (Drem, Matrix4<f64>, Vector4<f64>) {
    let holds = FILTERS.map(|rate| FirstOrderHold::low_pass(rate, 1e-2));
    let mut mixing = Drem::at_rest([0.0; 5]);
    rows.iter().for_each(|row| mixing.advance(&holds, *row));
    let filtered = mixing.filtered();
    let matrix = Matrix4::from_fn(|j, q| filtered[j][q + 1]);
    let right_side = Vector4::from_fn(|j, _| -filtered[j][0]);
    (mixing, matrix, right_side)
}

proptest! {
    #[test]
    fn mixing_is_cramers_rule(rows in prop::array::uniform4(prop::array::uniform5(-1.0..1.0f64))) {
        let (mixing, matrix, right_side) = jumped(&rows);
        let equation = mixing.mix();
        let mut replaced = matrix;
        replaced.set_column(0, &right_side);
        prop_assert!((equation.excitation - matrix.determinant()).abs() < 1e-14);
        prop_assert!((equation.right_side - replaced.determinant()).abs() < 1e-14);
    }

    /// The gradient is the exact solution over a sample: two halves make a whole.
    #[test]
    fn gradient_composes(excitation in -50.0..50.0f64, theta in -1.0..1.0f64, estimate in -1.0..1.0f64) {
        let settings = MixingSettings { gain: 10.0, excitation_scale: 1.0 };
        let equation = maglev_fmu::observer::drem::MixedEquation { excitation, right_side: excitation * theta };
        let whole = equation.improve(&settings, estimate, 2e-3);
        let half = equation.improve(&settings, estimate, 1e-3);
        let halves = equation.improve(&settings, half, 1e-3);
        prop_assert!((whole - halves).abs() < 1e-13);
        let decay = f64::exp(-10.0 * excitation * excitation * 2e-3);
        prop_assert!((whole - theta - (estimate - theta) * decay).abs() < 1e-13);
    }
}
