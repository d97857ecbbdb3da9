//! The shipped, sampled regression, mixing and observer of the levitated ball against the continuous equations: fed with the
//! samples of a continuous loop whose voltage is held between them, both must agree but for terms of order T^2.

use maglev_fmu::observer::ball_observer::{
    BallEstimate, BallObserver, BallObserverSettings, FluxEstimator, InitialBallEstimate,
};
use maglev_fmu::observer::drem::{Drem, MixingSettings};
use maglev_fmu::observer::flux_regression::{FluxRegression, FluxRegressionSettings, Sample};
use maglev_fmu::plant::levitated_ball::LevitatedBall;
use maglev_fmu::signal::FirstOrderHold;

use super::literal::{Ball, Feedback, Row, Settings, Voltage, rows};

/// Steps of the continuous scheme between samples.
const SUBSTEPS: usize = 4;
/// T \[s\]
const SAMPLE_TIMES: [f64; 3] = [2e-4, 1e-4, 5e-5];

/// The observer only watches; the voltage is sampled from the true state and held.
fn watched(settings: Settings, sample_time: f64, substeps: usize) -> Settings {
    Settings {
        feedback: Feedback::State,
        voltage: Voltage::Held(substeps),
        step: sample_time / substeps as f64,
        ..settings
    }
}

/// c0..c4, Delta/kappa and Q1/kappa of the sampled form at each row.
fn sampled(settings: &Settings, rows: &[Row], sample_time: f64) -> Vec<[f64; 7]> {
    let ball = settings.ball;
    let flux_unit = ball.rest_flux();
    let rates = FluxRegressionSettings { rates: settings.prefilter_poles, gravity: ball.squared_frequency() };
    let prefilters = settings.prefilter_poles.map(|rate| FirstOrderHold::low_pass(rate, sample_time));
    let filters = settings.mixing.poles.map(|rate| FirstOrderHold::low_pass(rate, sample_time));
    let mut sample =
        Sample { flux: rows[0].integral / flux_unit, current: ball.normalised_current(rows[0].current) };
    let mut regression = FluxRegression::new(sample);
    let mut mixing = Drem::at_rest(regression.coefficients(&rates));
    let mut result = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        if k > 0 {
            let before = &rows[k - 1];
            let mean_current = (before.current + row.current) / 2.0;
            sample.flux += sample_time * (before.voltage - ball.resistance * mean_current) / flux_unit;
            sample.current = ball.normalised_current(row.current);
            regression.advance(&prefilters, sample);
            mixing.advance(&filters, regression.coefficients(&rates));
            if row.time < settings.hold + 1e-9 {
                mixing = Drem::at_rest(regression.coefficients(&rates));
            }
        }
        let [c0, c1, c2, c3, c4] = regression.coefficients(&rates);
        let mixed = mixing.mix();
        result.push([c0, c1, c2, c3, c4, mixed.excitation, mixed.right_side]);
    }
    result
}

/// Largest differences of c0..c4, Delta and Q1, relative to the largest magnitude of each.
fn differences(settings: Settings, sample_time: f64) -> [f64; 7] {
    let settings = watched(settings, sample_time, SUBSTEPS);
    let rows = rows(settings, 2.5, sample_time).expect("the ball does not reach the magnet");
    let scale = settings.mixing.scale;
    let sampled = sampled(&settings, &rows, sample_time);
    std::array::from_fn(|k| {
        let literal = |row: &Row| match k {
            5 => row.scalar.excitation / scale,
            6 => row.scalar.response / scale,
            q => row.coefficients[q],
        };
        let largest = rows.iter().map(|row| literal(row).abs()).fold(0.0, f64::max);
        let worst = rows
            .iter()
            .zip(&sampled)
            .map(|(row, sampled)| (literal(row) - sampled[k]).abs())
            .fold(0.0, f64::max);
        worst / largest
    })
}

#[test]
fn coefficients_and_mixed_equation_converge_with_order_two() {
    for settings in [Settings::sinusoids(), Settings::steps()] {
        let table = SAMPLE_TIMES.map(|sample_time| differences(settings, sample_time));
        for (sample_time, differences) in SAMPLE_TIMES.iter().zip(&table) {
            println!("{:?}, T = {sample_time:e} s: {differences:?}", settings.reference.waveform);
        }
        (0..7).for_each(|k| assert_order_two(table.map(|row| row[k]), 0.2));
        // At T = 0.1 ms; Delta and Q1 are differences of large terms.
        let [.., excitation, response] = table[1];
        assert!(table[1][..5].iter().all(|&difference| difference <= 2e-4), "{table:?}");
        assert!(excitation <= 5e-3 && response <= 3e-2, "{table:?}");
    }
}

/// The shipped observer with the settings of the continuous one.
fn observer(settings: &Settings, sample_time: f64) -> BallObserver {
    let Ball { mass, resistance, gap, force_constant, gravity } = settings.ball;
    let flux_unit = settings.ball.rest_flux();
    BallObserver::new(
        BallObserverSettings {
            ball: LevitatedBall { mass, resistance, inductance_constant: force_constant, gap, gravity },
            sample_time,
            prefilters: settings.prefilter_poles,
            filters: settings.mixing.poles,
            estimator: FluxEstimator::Mixing(MixingSettings {
                gain: settings.gain,
                excitation_scale: settings.mixing.scale,
            }),
            speed_rate: settings.mechanics.speed_rate,
            position_rate: settings.mechanics.position_rate,
            held_samples: (settings.hold / sample_time).round() as u32,
        },
        InitialBallEstimate {
            flux: settings.start.flux - settings.flux_offset * flux_unit,
            flux_offset: 0.0,
            velocity: settings.momentum_estimate / mass,
            position: None,
            filters_from_zero: false,
        },
    )
}

/// Flux/lambda_0, velocity/c and position/c of both observers at each sample.
fn estimates(settings: Settings, sample_time: f64, duration: f64) -> Vec<[[f64; 3]; 2]> {
    let ball = settings.ball;
    let rows = rows(settings, duration, sample_time).expect("the ball does not reach the magnet");
    let mut observer = observer(&settings, sample_time);
    let mut voltage = None;
    rows.iter()
        .map(|row| {
            let BallEstimate { state, .. } = match voltage {
                None => observer.start(row.current),
                Some(voltage) => observer.update(row.current, voltage),
            };
            voltage = Some(row.voltage);
            let literal = row.estimate;
            [
                [state.flux / ball.rest_flux(), state.velocity / ball.gap, state.position / ball.gap],
                [
                    literal.flux / ball.rest_flux(),
                    literal.momentum / ball.mass / ball.gap,
                    literal.position / ball.gap,
                ],
            ]
        })
        .collect()
}

/// Largest differences of normalised flux, velocity and position for each sample time.
fn estimate_differences(settings: Settings, substeps: usize) -> [[f64; 3]; 3] {
    SAMPLE_TIMES.map(|sample_time| {
        let estimates = estimates(watched(settings, sample_time, substeps), sample_time, 2.5);
        let differences = std::array::from_fn(|k| {
            estimates.iter().map(|[sampled, literal]| (sampled[k] - literal[k]).abs()).fold(0.0, f64::max)
        });
        println!("{:?}, T = {sample_time:e} s: {differences:?}", settings.reference.waveform);
        differences
    })
}

/// Whether halving the sample time twice divides a difference by four each time, give or take.
fn assert_order_two(differences: [f64; 3], tolerance: f64) {
    for pair in differences.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 4.0).abs() <= tolerance, "{ratio}: {differences:?}");
    }
}

#[test]
fn velocity_and_position_for_a_known_flux_converge_with_order_two() {
    for settings in [Settings::sinusoids(), Settings::steps()] {
        let settings = Settings { flux_offset: 0.0, gain: 0.0, momentum_estimate: 1e-3, ..settings };
        let table = estimate_differences(settings, SUBSTEPS);
        let [flux, velocity, position] = table[1];
        assert!(flux <= 1e-6 && velocity <= 5e-4 && position <= 2e-6, "{table:?}");
        assert_order_two(table.map(|row| row[1]), 0.2);
        assert_order_two(table.map(|row| row[2]), 0.2);
    }
}

#[test]
fn estimates_for_a_wrong_flux_converge_with_order_two() {
    for settings in [Settings::sinusoids(), Settings::steps()] {
        let table = estimate_differences(Settings { gain: 0.0, ..settings }, SUBSTEPS);
        let [flux, velocity, position] = table[1];
        assert!(flux <= 2e-6 && velocity <= 1e-3 && position <= 5e-6, "{table:?}");
        (0..3).for_each(|k| assert_order_two(table.map(|row| row[k]), 0.2));
    }
}

/// The shipped observer follows the current between samples and cuts samples longer than 0.1 ms, so that above that its
/// error grows with order two at most.
#[test]
fn estimates_by_the_mixed_equation_converge() {
    for (settings, limit) in [(Settings::sinusoids(), 1e-3), (Settings::steps(), 5e-3)] {
        let [longest, middle, shortest] = estimate_differences(settings, 10);
        assert!(middle[0] <= limit, "{middle:?}");
        (0..3).for_each(|k| {
            assert!(longest[k] <= 4.5 * middle[k], "{longest:?} {middle:?}");
            assert!(shortest[k] <= middle[k] / 3.0, "{middle:?} {shortest:?}");
        });
    }
}
