//! The levitated ball's regression in continuous time: it vanishes at the true flux offset, and mixing leaves
//! the scalar equation it promises. Identities first, then the excitation the two references give.

use crate::ball::literal::{
    Ball, Feedback, Mixing, Motion, POLES, Reference, Regression, Settings,
    mixing::{LowPasses, Scalar},
    regression::{Coefficients, Prefilters, quintic},
    run,
};

/// The flux offset of these runs in units of lambda_0.
const OFFSET: f64 = 0.1;

/// The observer only watches a loop closed over the true state.
fn watching(settings: Settings) -> Settings {
    Settings { feedback: Feedback::State, flux_offset: OFFSET, ..settings }
}

/// z = (c - y)/c and v = y'/c of (N).
fn gap_and_speed(ball: &Ball, motion: Motion) -> (f64, f64) {
    ((ball.gap - motion.position) / ball.gap, motion.momentum / ball.mass / ball.gap)
}

/// Largest value of the quintic at the true offset after half a second.
fn residual(settings: Settings) -> f64 {
    let mut worst = 0.0f64;
    run(settings, 4.5, |this| {
        if this.time() > 0.5 {
            worst = worst.max(quintic(&this.coefficients(), OFFSET).abs());
        }
    })
    .unwrap();
    println!("{:?}, step {:e} s: {worst:.2e}", settings.reference.waveform, settings.step);
    worst
}

#[test]
fn the_quintic_vanishes_at_the_true_offset_with_the_order_of_the_scheme() {
    for settings in [Settings::sinusoids(), Settings::steps()].map(watching) {
        let coarse = residual(Settings { step: 1e-4, ..settings });
        let fine = residual(Settings { step: 5e-5, ..settings });
        assert!(coarse <= 1e-9, "{coarse:e}");
        let ratio = coarse / fine;
        assert!((12.0..=20.0).contains(&ratio), "{ratio}");
    }
}

#[test]
fn true_flux_and_current_satisfy_the_identity_of_degree_five() {
    // (D): l^2 I'' - l l'' I - 2 l l' I' + 2 l'^2 I = W2 (l^3 - l^5), derivatives by central differences.
    let settings = watching(Settings::sinusoids());
    let (ball, h) = (settings.ball, settings.step);
    let mut signals = Vec::new();
    run(settings, 2.0, |this| {
        let row = this.row();
        signals.push([row.motion.flux / ball.rest_flux(), ball.normalised_current(row.current)]);
    })
    .unwrap();
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for window in signals.windows(5) {
        let at = |k: usize, signal: usize| window[k][signal];
        let first = |s| (at(0, s) - 8.0 * at(1, s) + 8.0 * at(3, s) - at(4, s)) / (12.0 * h);
        let second =
            |s| (-at(0, s) + 16.0 * at(1, s) - 30.0 * at(2, s) + 16.0 * at(3, s) - at(4, s)) / (12.0 * h * h);
        let ([l, i], [l1, i1], [l2, i2]) = (window[2], [first(0), first(1)], [second(0), second(1)]);
        let left = l * l * i2 - l * l2 * i - 2.0 * l * l1 * i1 + 2.0 * l1 * l1 * i;
        let right = ball.squared_frequency() * (l.powi(3) - l.powi(5));
        worst = worst.max((left - right).abs());
        scale = scale.max(right.abs());
    }
    println!("identity of degree five: {worst:.1e} of {scale:.1e}");
    assert!(worst <= 1e-6 * scale, "{worst:e} of {scale:e}");
}

/// Numbers in [-1, 1) without a pattern that matters: fractional parts of multiples of the golden ratio.
fn scattered(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.618_033_988_749_895).fract() - 1.0
}

#[test]
fn the_swapped_equation_obeys_its_own_decay_in_any_state() {
    // S_j' = -alpha_j S_j with S_j = z h_j + v g_j - F_j[I] - e_j; all six derivatives are known exactly, so a
    // central difference along them, which is exact for products of two, leaves round-off.
    let regression = Regression { poles: [100.0, 300.0], squared_frequency: 1962.0 };
    for case in 0..200 {
        let number = |k: usize| scattered(20 * case + k);
        let states = Prefilters::from_fn(|k, _| number(k));
        let (z, v, theta, l) =
            (1.0 + 0.5 * number(12), 40.0 * number(13), 0.3 * number(14), 1.0 + 0.5 * number(15));
        let rates = regression.derivative(&states, l - theta, z * l);
        let (z_rate, v_rate) = (-v, regression.squared_frequency * (l * l - 1.0));
        let at = |h: f64| regression.swapped(&(states + h * rates), theta, z + h * z_rate, v + h * v_rate);
        let h = 1e-3;
        let (before, now, after) = (at(-h), at(0.0), at(h));
        for j in 0..POLES {
            let (rate, expected) = ((after[j] - before[j]) / (2.0 * h), -regression.poles[j] * now[j]);
            let scale = regression.poles[j] * (1.0 + v.abs() / regression.poles[j] + now[j].abs());
            assert!((rate - expected).abs() <= 1e-10 * scale, "case {case}: {rate} {expected}");
        }
    }
}

#[test]
fn a_wrong_start_of_the_prefilters_is_forgotten_as_the_swapped_equation_says() {
    let start =
        Motion { flux: 1.1 * Ball::LABORATORY.rest_flux(), position: 0.5e-3, momentum: 0.0844 * 0.01 };
    let settings = Settings { start, ..watching(Settings::sinusoids()) };
    let ball = settings.ball;
    let mut first = None;
    run(settings, 0.05, |this| {
        let (z, v) = gap_and_speed(&ball, this.row().motion);
        let swapped = this.regression().swapped(&this.prefilters(), OFFSET, z, v);
        let first = *first.get_or_insert(swapped);
        for (j, pole) in settings.prefilter_poles.into_iter().enumerate() {
            let expected = first[j] * (-pole * this.time()).exp();
            assert!(
                (swapped[j] - expected).abs() <= 1e-6 * first[j].abs(),
                "{} s: {} {expected}",
                this.time(),
                swapped[j]
            );
        }
    })
    .unwrap();
    assert!(first.unwrap().iter().all(|swapped| swapped.abs() > 1e-3), "{first:?}");
}

/// The scalar regressions of a run after `from` \[s\], by four and by five equations.
fn scalars(settings: Settings, from: f64, duration: f64) -> Vec<[Scalar; 2]> {
    let mut result = Vec::new();
    run(settings, duration, |this| {
        if this.time() > from {
            let (mixing, coefficients) = (&settings.mixing, this.coefficients());
            let low_passes = this.low_passes();
            result.push([
                mixing.scalar(&low_passes, &coefficients),
                mixing.scalar_of_five(&low_passes, &coefficients),
            ]);
        }
    })
    .unwrap();
    result
}

fn peak(scalars: &[[Scalar; 2]]) -> f64 {
    scalars.iter().map(|[four, _]| four.excitation.abs()).fold(0.0, f64::max)
}

#[test]
fn mixing_leaves_one_linear_equation_in_the_offset() {
    for settings in [Settings::sinusoids(), Settings::steps()].map(watching) {
        let scalars = scalars(settings, 0.5, 4.5);
        let worst = scalars
            .iter()
            .map(|[four, _]| (four.response - four.excitation * OFFSET).abs())
            .fold(0.0, f64::max)
            / peak(&scalars);
        println!("{:?}: |Q1 - Delta theta| {worst:.1e} of the largest Delta", settings.reference.waveform);
        assert!(worst <= 1e-5, "{worst:e}");
    }
}

#[test]
fn four_filtered_equations_and_five_unfiltered_have_the_same_determinants() {
    // On the trajectories the rows of the five are nearly equal, so round-off is judged where Delta is not small
    // and Q1 against the largest Delta.
    for settings in [Settings::sinusoids(), Settings::steps()].map(watching) {
        let scalars = scalars(settings, 0.5, 4.5);
        let peak = peak(&scalars);
        let (mut ratio, mut response) = (0.0f64, 0.0f64);
        for [four, five] in &scalars {
            response = response.max((five.response - four.response).abs() / peak);
            if four.excitation.abs() > 0.1 * peak {
                ratio = ratio.max((five.excitation / four.excitation - 1.0).abs());
            }
        }
        println!("{:?}: Delta differs by {ratio:.1e}, Q1 by {response:.1e}", settings.reference.waveform);
        assert!(ratio <= 1e-9 && response <= 1e-9, "{ratio:e} {response:e}");
    }
    // Anywhere else the identity holds to round-off.
    let mixing = Mixing { scale: 1.0, ..Settings::sinusoids().mixing };
    for case in 0..200 {
        let coefficients = Coefficients::from_fn(|q, _| scattered(25 * case + q));
        let low_passes = LowPasses::from_fn(|q, j| scattered(25 * case + 5 + 5 * j + q));
        let four = mixing.scalar(&low_passes, &coefficients);
        let five = mixing.scalar_of_five(&low_passes, &coefficients);
        assert!((five.excitation - four.excitation).abs() <= 1e-13, "case {case}: {four:?} {five:?}");
        assert!((five.response - four.response).abs() <= 1e-13, "case {case}: {four:?} {five:?}");
    }
}

/// Root mean square of Delta/kappa from the first second to the fourth, three edges of the steps.
fn excitation(settings: Settings, amplitude: f64) -> f64 {
    let settings = Settings {
        reference: Reference { amplitude, ..settings.reference },
        mixing: Mixing { scale: 1.0, ..settings.mixing },
        ..settings
    };
    let scalars = scalars(settings, 1.0, 4.0);
    let sum: f64 = scalars.iter().map(|[four, _]| four.excitation.powi(2)).sum();
    (sum / scalars.len() as f64).sqrt()
}

#[test]
fn excitation_grows_with_the_sixth_power_of_the_amplitude() {
    let cases = [
        (Settings::sinusoids(), [0.1e-3, 0.2e-3, 0.4e-3, 0.8e-3]),
        (Settings::steps(), [0.25e-3, 0.5e-3, 1e-3, 2e-3]),
    ];
    for (settings, amplitudes) in cases {
        let points =
            amplitudes.map(|amplitude: f64| (amplitude.ln(), excitation(watching(settings), amplitude).ln()));
        let mean = |pick: fn(&(f64, f64)) -> f64| points.iter().map(pick).sum::<f64>() / points.len() as f64;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
            / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
        println!("{:?}: slope {slope:.3}", settings.reference.waveform);
        assert!((slope - 6.0).abs() <= 0.3, "{slope}");
    }
}

#[test]
fn sinusoids_excite_ten_times_as_much_as_steps() {
    // Figures of the prototype: 1.36e-9 and 1.32e-10.
    let sinusoids = excitation(watching(Settings::sinusoids()), 0.6e-3);
    let steps = excitation(watching(Settings::steps()), 1e-3);
    println!("root mean square of Delta/kappa: sinusoids {sinusoids:.3e}, steps {steps:.3e}");
    assert!((sinusoids / 1.36e-9 - 1.0).abs() <= 0.01, "{sinusoids:e}");
    assert!((steps / 1.32e-10 - 1.0).abs() <= 0.01, "{steps:e}");
}
