//! Figures 6 and 7: the speed observer for a known flux and a frozen wrong one, and a flux estimate that a higher
//! gain makes worse. Which symbol the paper varies in these two figures is not in its text; it says that the
//! steady-state error grows with the adaptation gain and that the excitation condition is not met.

use crate::ball::literal::{
    Ball, Feedback, FilterStart, Mixing, Reference, Settings, mechanics::Mechanics, run,
};

#[test]
fn figure_6_the_speed_error_decays_with_the_integral_of_the_squared_flux() {
    // p~(t) = p~(0) exp(-g_p int lambda^2) for a known flux.
    for settings in [Settings::sinusoids(), Settings::steps()] {
        let settings = Settings {
            flux_offset: 0.0,
            momentum_estimate: 1e-3,
            feedback: Feedback::State,
            step: 2.5e-5,
            ..settings
        };
        let gain = settings.mechanics.speed_rate / settings.ball.rest_flux().powi(2);
        let (mut integral, mut before, mut worst) = (0.0, None, 0.0f64);
        run(settings, 0.1, |this| {
            let row = this.row();
            let squared_flux = row.motion.flux.powi(2);
            integral += settings.step * before.map_or(0.0, |before: f64| (before + squared_flux) / 2.0);
            before = Some(squared_flux);
            let error = row.estimate.momentum - row.motion.momentum;
            let expected = settings.momentum_estimate * (-gain * integral).exp();
            worst = worst.max((error / expected - 1.0).abs());
        })
        .unwrap();
        println!("{:?}: speed error off its law by {worst:.1e}", settings.reference.waveform);
        assert!(worst <= 1e-3, "{worst:e}");
    }
}

/// Offset y - y* and speed estimate at rest for a flux estimate of `ratio` times the flux, in closed form.
fn rest_with_wrong_flux(settings: &Settings, target: f64, ratio: f64) -> (f64, f64) {
    let Settings { ball, mechanics, pole, .. } = settings;
    let (a0, a1, a2) = (pole.powi(3), 3.0 * pole.powi(2), 3.0 * pole);
    let acceleration = ball.gravity * (ratio.powi(2) - 1.0);
    let speed = acceleration / (mechanics.speed_rate * ratio.powi(2));
    let estimate = target - (a2 * acceleration + a1 * speed) / a0;
    let gap = ball.gap - estimate + speed / (mechanics.position_rate * ratio.powi(2));
    (ball.gap - ratio * gap - target, speed)
}

#[test]
fn figure_6_a_frozen_flux_error_leaves_an_offset_that_mechanical_gains_reduce() {
    let target = 1e-3;
    for (rate, millimetres) in [(100.0, 0.6367), (200.0, 0.5067), (400.0, 0.4494)] {
        let settings = Settings {
            reference: Reference::constant(target),
            start: Ball::LABORATORY.rest(target),
            flux_offset: 0.02,
            gain: 0.0,
            mechanics: Mechanics { speed_rate: rate, position_rate: rate },
            ..Settings::sinusoids()
        };
        let mut last = None;
        run(settings, 3.0, |this| last = Some(this.row())).unwrap();
        let row = last.unwrap();
        let (offset, speed) = (row.motion.position - target, row.estimate.momentum / settings.ball.mass);
        println!("rate {rate} 1/s: {:.4} mm, speed estimate {speed:.3e} m/s", 1e3 * offset);
        assert!((1e3 * offset / millimetres - 1.0).abs() <= 0.01, "{rate} 1/s: {offset:e} m");
        let (closed_offset, closed_speed) = rest_with_wrong_flux(&settings, target, 0.98);
        assert!((offset / closed_offset - 1.0).abs() <= 1e-6, "{offset:e} {closed_offset:e}");
        assert!((speed / closed_speed - 1.0).abs() <= 1e-6, "{speed:e} {closed_speed:e}");
    }
}

/// |lambda~|/lambda_0 after ten seconds of steps with the observer only watching and little excitation: kappa is
/// a millionth of the usual.
fn final_flux_error(gain: f64, filters: FilterStart, hold: f64) -> f64 {
    let steps = Settings::steps();
    let settings = Settings {
        gain,
        filters,
        hold,
        feedback: Feedback::State,
        mixing: Mixing { scale: 1e4, ..steps.mixing },
        ..steps
    };
    let mut error = 0.0;
    run(settings, 10.0, |this| {
        let row = this.row();
        error = (row.estimate.flux - row.motion.flux).abs() / settings.ball.rest_flux();
    })
    .unwrap();
    println!("gain {gain:e}, {filters:?}, hold {hold} s: {error:.6}");
    error
}

/// Gains and the flux errors the prototype ends with.
const ZERO_START: [(f64, f64); 5] =
    [(1e-4, 0.1001), (1e-3, 0.1006), (1e-2, 0.1058), (0.1, 0.1287), (1.0, 0.1310)];

#[test]
fn figure_7_filters_that_start_at_zero_leave_an_error_that_grows_with_the_gain() {
    let mut before = 0.1;
    for (gain, prototype) in ZERO_START {
        let error = final_flux_error(gain, FilterStart::Zero, 0.0);
        assert!((error - prototype).abs() <= 1e-4, "gain {gain:e}: {error}");
        assert!(error >= before, "gain {gain:e}: {error}");
        before = error;
    }
}

#[test]
fn figure_7_held_or_well_started_filters_leave_the_same_error_alone() {
    for (gain, _) in ZERO_START {
        for (filters, hold) in [(FilterStart::Zero, 0.1), (FilterStart::ConstantHistory, 0.0)] {
            let error = final_flux_error(gain, filters, hold);
            assert!((error - 0.1).abs() <= 1e-6, "gain {gain:e}, {filters:?}: {error}");
        }
    }
}
