//! How the levitated ball may start: what the start-up hold is for, which flux errors the loop survives and how
//! fast the speed observer must be.

use crate::ball::literal::{Collision, FilterStart, Motion, Settings, mechanics::Mechanics, rows};

/// Whether the ball stays off the magnet for five seconds; a ball that does must also be tracked in the end.
fn survives(settings: Settings) -> bool {
    match rows(settings, 5.0, 0.01) {
        Ok(rows) => {
            let row = rows.last().unwrap();
            let error = (row.motion.position - row.target.position).abs();
            assert!(error <= 1e-6, "{:?} offset {}: {error:e} m", settings.reference, settings.flux_offset);
            true
        }
        Err(Collision(time)) => {
            println!(
                "{:?} offset {}: lost at {time:.4} s",
                settings.reference.waveform, settings.flux_offset
            );
            false
        }
    }
}

/// A ball that does not start at rest: a tenth more flux, 0.01 m/s, half a millimetre up.
fn disturbed(settings: Settings) -> Settings {
    let ball = settings.ball;
    let start = Motion { flux: 1.1 * ball.rest_flux(), position: 0.5e-3, momentum: 0.01 * ball.mass };
    Settings { start, ..settings }
}

fn both() -> [Settings; 2] {
    [Settings::sinusoids(), Settings::steps()]
}

#[test]
fn without_the_hold_a_disturbed_start_loses_the_ball() {
    for settings in both().map(disturbed) {
        for flux_offset in [0.1, -0.1] {
            assert!(!survives(Settings { flux_offset, hold: 0.0, ..settings }));
        }
    }
}

#[test]
fn a_hold_of_ten_time_constants_forgives_disturbed_starts_and_zero_filters() {
    for hold in [0.1, 0.2] {
        for filters in [FilterStart::ConstantHistory, FilterStart::Zero] {
            for flux_offset in [0.1, -0.1] {
                for settings in both() {
                    assert!(survives(Settings { flux_offset, hold, filters, ..settings }));
                    assert!(survives(Settings { flux_offset, hold, filters, ..disturbed(settings) }));
                }
            }
        }
    }
}

#[test]
fn a_hold_of_five_time_constants_is_too_short_for_sinusoids() {
    // exp(-5) of a wrong start is left and the sinusoids' Delta acts on it at once.
    for flux_offset in [0.1, -0.1] {
        let settings = Settings { flux_offset, hold: 0.05, ..Settings::sinusoids() };
        assert!(!survives(disturbed(settings)));
        assert!(!survives(Settings { filters: FilterStart::Zero, ..settings }));
        assert!(survives(settings));
    }
}

#[test]
fn at_rest_right_filters_need_no_hold_and_zero_filters_do() {
    for settings in both() {
        assert!(survives(Settings { hold: 0.0, ..settings }));
        assert!(!survives(Settings { hold: 0.0, filters: FilterStart::Zero, ..settings }));
    }
}

#[test]
fn the_pole_of_the_loop_decides_which_flux_errors_it_survives() {
    for settings in both() {
        let settings = |pole, flux_offset| Settings { pole, flux_offset, hold: 0.05, ..settings };
        for flux_offset in [-0.2, -0.15, -0.1, -0.05, 0.05, 0.1, 0.15, 0.2] {
            assert!(survives(settings(60.0, flux_offset)), "{flux_offset}");
        }
        for flux_offset in [-0.15, -0.1, -0.05, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3] {
            assert!(survives(settings(100.0, flux_offset)), "{flux_offset}");
        }
        for (pole, flux_offset) in [(60.0, -0.3), (60.0, 0.25), (60.0, 0.3), (100.0, -0.3), (100.0, -0.2)] {
            assert!(!survives(settings(pole, flux_offset)), "{flux_offset}");
        }
    }
}

#[test]
fn a_slow_speed_observer_lets_the_ball_reach_the_magnet() {
    for (rate, expected) in [(20.0, false), (50.0, false), (100.0, true), (200.0, true)] {
        let settings = Settings::sinusoids();
        let mechanics = Mechanics { speed_rate: rate, ..settings.mechanics };
        assert_eq!(survives(Settings { mechanics, ..settings }), expected, "{rate} 1/s");
    }
}
