//! Figures 2 to 5: sensorless tracking from a wrong flux, and what the adaptation gain does to it. The paper's
//! text names the experiments; references, offsets and gains are assumed, so the figures held here are those of
//! the reconstruction.

use crate::ball::literal::{Settings, rows, run};

/// What a run of ten seconds shows.
#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    /// Last time \[s\] the flux estimate is a hundredth of lambda_0 or more off.
    flux_time: f64,
    /// Last time \[s\] the ball is 0.05 mm or more off its target.
    tracking_time: f64,
    /// Largest |y - y*| \[m\] ever and in the last second.
    peak_error: f64,
    last_error: f64,
    /// Largest |p~|/m \[m/s\] and |y~| \[m\] in the last second.
    last_speed_error: f64,
    last_position_error: f64,
    /// |lambda~|/lambda_0 at the end.
    flux_error: f64,
}

fn outcome(settings: Settings) -> Outcome {
    let (duration, ball) = (10.0, settings.ball);
    let mut result = Outcome::default();
    run(settings, duration, |this| {
        let row = this.row();
        result.flux_error = (row.estimate.flux - row.motion.flux).abs() / ball.rest_flux();
        if result.flux_error >= 0.01 {
            result.flux_time = row.time;
        }
        let error = (row.motion.position - row.target.position).abs();
        if error >= 0.05e-3 {
            result.tracking_time = row.time;
        }
        result.peak_error = result.peak_error.max(error);
        if row.time > duration - 1.0 {
            let speed_error = (row.estimate.momentum - row.motion.momentum).abs() / ball.mass;
            let position_error = (row.estimate.position - row.motion.position).abs();
            result.last_error = result.last_error.max(error);
            result.last_speed_error = result.last_speed_error.max(speed_error);
            result.last_position_error = result.last_position_error.max(position_error);
        }
    })
    .expect("the ball does not reach the magnet");
    println!(
        "{:?}, offset {}, gain {}: {result:?}",
        settings.reference.waveform, settings.flux_offset, settings.gain
    );
    result
}

/// Times to a part in a hundred and peaks to a part in two hundred of the prototype's.
fn assert_prototype(outcome: Outcome, flux_time: f64, tracking_time: f64, peak_millimetres: f64) {
    let near = |value: f64, expected: f64, part: f64| (value / expected - 1.0).abs() <= part;
    assert!(near(outcome.flux_time, flux_time, 0.01), "{outcome:?}");
    assert!(near(outcome.tracking_time, tracking_time, 0.01), "{outcome:?}");
    assert!(near(1e3 * outcome.peak_error, peak_millimetres, 0.005), "{outcome:?}");
}

#[test]
fn figure_2_the_ball_tracks_sinusoids_from_a_wrong_flux() {
    for (flux_offset, flux_time, tracking_time, peak) in [
        (0.1, 0.354, 0.488, 2.50),
        (-0.1, 0.273, 0.419, 3.02),
        (0.05, 0.348, 0.463, 1.30),
        (-0.05, 0.296, 0.414, 1.40),
    ] {
        let outcome = outcome(Settings { flux_offset, ..Settings::sinusoids() });
        assert!(outcome.flux_time <= 0.6 && outcome.tracking_time <= 0.8, "{outcome:?}");
        assert!(outcome.peak_error <= 3.3e-3 && outcome.last_error <= 1e-7, "{outcome:?}");
        assert_prototype(outcome, flux_time, tracking_time, peak);
    }
}

#[test]
fn figure_3_the_ball_tracks_steps_from_a_wrong_flux() {
    for (flux_offset, flux_time, tracking_time, peak) in [
        (0.1, 3.05, 3.18, 2.48),
        (-0.1, 2.03, 2.16, 2.92),
        (0.05, 2.04, 2.15, 1.29),
        (-0.05, 2.03, 2.15, 1.40),
    ] {
        let outcome = outcome(Settings { flux_offset, ..Settings::steps() });
        assert!(outcome.flux_time <= 3.2 && outcome.tracking_time <= 3.4, "{outcome:?}");
        assert!(outcome.peak_error <= 3.3e-3 && outcome.last_error <= 1e-7, "{outcome:?}");
        assert_prototype(outcome, flux_time, tracking_time, peak);
    }
}

#[test]
fn figure_4_a_higher_gain_finds_the_flux_sooner_under_sinusoids() {
    let outcomes = [1.0, 3.0, 10.0].map(|gain| outcome(Settings { gain, ..Settings::sinusoids() }));
    let times = outcomes.map(|outcome| outcome.flux_time);
    assert!(times[0] > times[1] && times[1] > times[2], "{times:?}");
    assert!((5.0..=8.0).contains(&times[0]), "{times:?}");
    assert!((2.0..=3.2).contains(&times[1]), "{times:?}");
    assert!(times[2] <= 0.6, "{times:?}");
    for (time, prototype) in times.into_iter().zip([6.33, 2.56, 0.354]) {
        assert!((time / prototype - 1.0).abs() <= 0.01, "{times:?}");
    }
    for outcome in outcomes {
        assert!(outcome.last_speed_error <= 1e-5 && outcome.last_position_error <= 1e-6, "{outcome:?}");
    }
}

#[test]
fn figure_5_steps_find_the_flux_only_with_a_high_gain() {
    for (gain, range, prototype) in [(1.0, 0.045..=0.06, 0.052), (3.0, 0.01..=0.022, 0.016)] {
        let outcome = outcome(Settings { gain, ..Settings::steps() });
        assert!(range.contains(&outcome.flux_error), "{outcome:?}");
        assert!((outcome.flux_error - prototype).abs() <= 5e-4, "{outcome:?}");
    }
    for (gain, prototype) in [(10.0, 3.05), (100.0, 2.04)] {
        let outcome = outcome(Settings { gain, ..Settings::steps() });
        assert!(outcome.flux_error <= 1e-6, "{outcome:?}");
        assert!((outcome.flux_time / prototype - 1.0).abs() <= 0.01, "{outcome:?}");
    }
}

#[test]
fn figure_5_the_flux_error_is_a_staircase_with_an_edge_at_each_step() {
    let settings = Settings { gain: 1.0, ..Settings::steps() };
    let rows = rows(settings, 10.0, 0.01).unwrap();
    let error = |time: f64| {
        let row = &rows[(time / 0.01).round() as usize];
        (row.estimate.flux - row.motion.flux).abs() / settings.ball.rest_flux()
    };
    let (mut flat, mut drop) = (0.0f64, 0.0);
    for second in 1..10 {
        let edge = f64::from(second);
        flat = flat.max((error(edge + 0.99) - error(edge + 0.5)).abs());
        drop += error(edge) - error(edge + 0.5);
    }
    println!("between edges the flux error moves by {flat:.1e} at most, at edges by {drop:.3} in all");
    assert!(drop >= 0.04, "{drop}");
    assert!(flat <= 1e-3 * drop, "{flat:e}");
}
