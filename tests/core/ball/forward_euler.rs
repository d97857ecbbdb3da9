//! Why the sampled observer takes current and voltage for straight lines: with forward Euler in all its filters the ball is
//! lost, at the same sample time, gains and start-up. The loop here is a second, plain realisation of the paper's equations, so
//! that the two differ in nothing but the hold.

use maglev_fmu::controller::ball_feedback_linearisation::BallFeedbackLinearisation;
use maglev_fmu::observer::drem::{Drem, MixingSettings};
use maglev_fmu::observer::flux_regression::{FluxRegression, FluxRegressionSettings, Sample};
use maglev_fmu::plant::contact::Contact;
use maglev_fmu::plant::levitated_ball::{Drive, LevitatedBall, State};
use maglev_fmu::signal::{BallReferenceFilter, FirstOrderHold};
use maglev_fmu::study::ball::BallReference;

const OFFSET: f64 = 0.1;
const RATES: [f64; 2] = [100.0, 300.0];
const FILTERS: [f64; 4] = [10.0, 25.0, 60.0, 150.0];
/// w_p = w_y
const MECHANICAL_RATE: f64 = 200.0;
const MIXING: MixingSettings = MixingSettings { gain: 10.0, excitation_scale: 1e9 };

#[derive(Clone, Copy, PartialEq)]
enum Hold {
    FirstOrder,
    ForwardEuler,
}

/// Root mean square error of the position [m] and of the flux (share of lam0) over the last two of four seconds, if the ball
/// touches nothing.
fn run(hold: Hold, sample_time: f64) -> Option<(f64, f64)> {
    let ball = LevitatedBall::LABORATORY;
    let (flux, gravity) = (ball.equilibrium_flux(), ball.gravity / ball.gap);
    let (damping, unit_current) =
        (ball.resistance * ball.gap / ball.inductance_constant, ball.gap * flux / ball.inductance_constant);
    let low_pass = |rate| match hold {
        Hold::FirstOrder => FirstOrderHold::low_pass(rate, sample_time),
        Hold::ForwardEuler => FirstOrderHold::low_pass_by_euler(rate, sample_time),
    };
    let (prefilters, filters) = (RATES.map(low_pass), FILTERS.map(low_pass));
    let regression_settings = FluxRegressionSettings { rates: RATES, gravity };
    let law = BallFeedbackLinearisation { ball, pole: 60.0 };

    let (mut state, mut contact) = (ball.equilibrium(0.0), Contact::None);
    let mut reference = BallReferenceFilter::new(0.0);
    let mut current = ball.current(0.0, flux) / unit_current;
    let mut regression = FluxRegression::new(Sample { flux: 1.0 - OFFSET, current });
    let mut mixing = Drem::at_rest(regression.coefficients(&regression_settings));
    let (mut offset, mut velocity, mut gap) = (0.0, 0.0, current / (1.0 - OFFSET));
    let (mut squares, mut flux_squares, mut samples) = (0.0, 0.0, 0.0);
    for tick in 0..(4.0 / sample_time).round() as u32 {
        let estimated_flux = regression.sample().flux + offset;
        let estimate = State {
            position: ball.gap * (1.0 - gap),
            velocity: ball.gap * velocity,
            flux: flux * estimated_flux,
        };
        let smooth = reference.output(80.0);
        let voltage = law.voltage(estimate, unit_current * current, smooth).clamp(-12.0, 12.0);
        if f64::from(tick) * sample_time >= 2.0 {
            squares += (state.position - smooth.position).powi(2);
            flux_squares += (estimated_flux - state.flux / flux).powi(2);
            samples += 1.0;
        }
        ball.advance(-0.02, &mut state, &mut contact, Drive { voltage, force: 0.0 }, sample_time);
        if contact != Contact::None {
            return None;
        }
        let time = f64::from(tick + 1) * sample_time;
        reference.update(BallReference::Sinusoids.at(time), 80.0, sample_time);

        let past = regression.sample();
        let next_current = ball.current(state.position, state.flux) / unit_current;
        let induced = |current: f64| voltage / flux - damping * current;
        let integrated = match hold {
            Hold::FirstOrder => sample_time * (induced(current) + induced(next_current)) / 2.0,
            Hold::ForwardEuler => sample_time * induced(current),
        };
        regression.advance(&prefilters, Sample { flux: past.flux + integrated, current: next_current });
        let coefficients = regression.coefficients(&regression_settings);
        let integrated_velocity = velocity + MECHANICAL_RATE * current * estimated_flux;
        if time < 0.1 {
            mixing = Drem::at_rest(coefficients);
        } else {
            mixing.advance(&filters, coefficients);
            offset = mixing.mix().improve(&MIXING, offset, sample_time);
        }
        // (17) and (20) over the sample.
        let next_flux = regression.sample().flux + offset;
        let drive = |l: f64, i: f64| {
            gravity * (l * l - 1.0) + MECHANICAL_RATE * i * (MECHANICAL_RATE * l * l * l + 2.0 * induced(i))
        };
        let middle = 0.5 * (estimated_flux + next_flux);
        let (next_velocity, next_gap) = match hold {
            Hold::FirstOrder => {
                let relaxation = FirstOrderHold::relaxation(MECHANICAL_RATE * middle * middle, sample_time);
                let end = relaxation.after(
                    integrated_velocity,
                    drive(estimated_flux, current),
                    drive(next_flux, next_current),
                ) - MECHANICAL_RATE * next_current * next_flux;
                let gap = relaxation.after(
                    gap,
                    MECHANICAL_RATE * current * estimated_flux - velocity,
                    MECHANICAL_RATE * next_current * next_flux - end,
                );
                (end, gap)
            }
            Hold::ForwardEuler => {
                let square = MECHANICAL_RATE * estimated_flux * estimated_flux;
                let end = integrated_velocity
                    + sample_time * (drive(estimated_flux, current) - square * integrated_velocity)
                    - MECHANICAL_RATE * next_current * next_flux;
                (
                    end,
                    gap + sample_time
                        * (MECHANICAL_RATE * current * estimated_flux - velocity - square * gap),
                )
            }
        };
        (velocity, gap, current) = (next_velocity, next_gap, next_current);
    }
    Some((f64::sqrt(squares / samples), f64::sqrt(flux_squares / samples)))
}

#[test]
fn straight_lines_keep_the_ball() {
    let (position, flux) = run(Hold::FirstOrder, 1e-4).expect("the ball stays in the air");
    assert!(position <= 0.1e-3 && flux <= 0.01, "{position} {flux}");
}

#[test]
fn forward_euler_loses_it() {
    let lost = match run(Hold::ForwardEuler, 1e-4) {
        None => true,
        Some((position, flux)) => position > 1e-3 || flux > 0.05,
    };
    assert!(lost);
}

/// So that it is the hold which loses the ball, and nothing else in this file.
#[test]
fn forward_euler_keeps_it_at_a_fiftieth_of_the_sample_time() {
    let (position, flux) = run(Hold::ForwardEuler, 2e-6).expect("the ball stays in the air");
    assert!(position <= 0.5e-3 && flux <= 0.02, "{position} {flux}");
}
