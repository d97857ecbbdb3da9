//! The levitated ball's plant against closed forms, an energy balance and another integrator.

use maglev_fmu::model::{LevitatedBallPlant, Model, ModelError, NullLogSink};
use maglev_fmu::plant::contact::Contact;
use maglev_fmu::plant::levitated_ball::{Drive, LevitatedBall, State};
use maglev_fmu_test::values::{get, set};
use proptest::prelude::*;

const BALL: LevitatedBall = LevitatedBall::LABORATORY;
const LOWER_STOP: f64 = -0.02;

fn advance(state: State, contact: Contact, drive: Drive, duration: f64) -> (State, Contact) {
    let (mut state, mut contact) = (state, contact);
    BALL.advance(LOWER_STOP, &mut state, &mut contact, drive, duration);
    (state, contact)
}

#[test]
fn equilibrium_is_a_rest() {
    for position in [-0.01, 0.0, 0.004] {
        let start = BALL.equilibrium(position);
        let voltage = BALL.resistance * BALL.current(position, start.flux);
        // Unstable: rounding errors grow e-fold every 15 ms or so.
        let (end, contact) = advance(start, Contact::None, Drive { voltage, force: 0.0 }, 0.05);
        assert_eq!(contact, Contact::None);
        assert!((end.position - position).abs() < 1e-14 && end.velocity.abs() < 1e-13);
        assert!((end.flux / start.flux - 1.0).abs() < 1e-13);
    }
}

#[test]
fn without_flux_the_ball_falls_and_lies() {
    let start = State::default();
    let fall = (2.0 * -LOWER_STOP / BALL.gravity).sqrt();
    let (end, contact) = advance(start, Contact::None, Drive::default(), 0.9 * fall);
    assert_eq!(contact, Contact::None);
    assert!((end.position - 0.81 * LOWER_STOP).abs() < 1e-15);
    let (end, contact) = advance(start, Contact::None, Drive::default(), 1.1 * fall);
    assert_eq!((end.position, end.velocity, contact), (LOWER_STOP, 0.0, Contact::AtSmallestPosition));
}

#[test]
fn flux_of_a_lying_ball_is_that_of_a_constant_inductance() {
    let drive = Drive { voltage: 1.0, force: 0.0 };
    let rate = BALL.resistance * (BALL.gap - LOWER_STOP) / BALL.inductance_constant;
    let mut state = State { position: LOWER_STOP, velocity: 0.0, flux: 0.0 };
    let mut contact = Contact::AtSmallestPosition;
    for tick in 1..=200 {
        (state, contact) = advance(state, contact, drive, 1e-4);
        let expected = drive.voltage / rate * (1.0 - f64::exp(-rate * 1e-4 * f64::from(tick)));
        assert!((state.flux / expected - 1.0).abs() < 1e-9, "{tick}: {} {expected}", state.flux);
        assert_eq!(contact, Contact::AtSmallestPosition);
    }
}

/// Lift-off of a lying ball: the flux follows the closed form until it carries the ball.
#[test]
fn ball_lifts_off_when_the_flux_carries_it() {
    let drive = Drive { voltage: 20.0, force: 0.0 };
    let rate = BALL.resistance * (BALL.gap - LOWER_STOP) / BALL.inductance_constant;
    let final_flux = drive.voltage / rate;
    let carrying = BALL.equilibrium_flux();
    let lift_off = -f64::ln(1.0 - carrying / final_flux) / rate;
    let start = State { position: LOWER_STOP, velocity: 0.0, flux: 0.0 };
    for (time, expected) in [(lift_off - 1e-9, Contact::AtSmallestPosition), (lift_off + 1e-9, Contact::None)]
    {
        let (end, contact) = advance(start, Contact::AtSmallestPosition, drive, time);
        assert_eq!(contact, expected);
        assert!((end.flux / carrying - 1.0).abs() < 1e-6);
    }
}

/// Classical Runge-Kutta with tiny steps; stops by the sign of the position only, so exact to its step size.
fn fine(mut state: State, drive: Drive, duration: f64, steps: u32) -> (State, bool) {
    let h = duration / f64::from(steps);
    let mut touched = false;
    let rate = |s: State| {
        let current = BALL.current(s.position, s.flux);
        let acceleration = (BALL.magnetic_force(s.flux) + drive.force) / BALL.mass - BALL.gravity;
        let flux = drive.voltage - BALL.resistance * current;
        let lies = s.position <= LOWER_STOP && s.velocity <= 0.0 && acceleration <= 0.0;
        let sticks = s.position >= BALL.gap && s.velocity >= 0.0 && acceleration >= 0.0;
        if lies || sticks {
            State { position: 0.0, velocity: 0.0, flux }
        } else {
            State { position: s.velocity, velocity: acceleration, flux }
        }
    };
    let add = |s: State, k: State, h: f64| State {
        position: s.position + h * k.position,
        velocity: s.velocity + h * k.velocity,
        flux: s.flux + h * k.flux,
    };
    for _ in 0..steps {
        let k1 = rate(state);
        let k2 = rate(add(state, k1, h / 2.0));
        let k3 = rate(add(state, k2, h / 2.0));
        let k4 = rate(add(state, k3, h));
        state = add(add(add(add(state, k1, h / 6.0), k2, h / 3.0), k3, h / 3.0), k4, h / 6.0);
        for (stop, beyond) in
            [(LOWER_STOP, state.position < LOWER_STOP), (BALL.gap, state.position > BALL.gap)]
        {
            if beyond {
                state.position = stop;
                state.velocity = 0.0;
                touched = true;
            }
        }
    }
    (state, touched)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// One step of 0.1 ms against 64 of the other integrator, 1e-9 relative to the nominal values.
    #[test]
    fn a_step_is_good_to_nine_digits(
        position in -0.0199..0.0049f64, velocity in -0.3..0.3f64, flux in 0.0..0.02f64, voltage in -12.0..12.0f64,
        force in -0.5..0.5f64,
    ) {
        let start = State { position, velocity, flux };
        let drive = Drive { voltage, force };
        let (reference, touched) = fine(start, drive, 1e-4, 64);
        prop_assume!(!touched);
        let (end, contact) = advance(start, Contact::None, drive, 1e-4);
        prop_assert_eq!(contact, Contact::None);
        prop_assert!((end.position - reference.position).abs() < 1e-9 * 1e-3);
        prop_assert!((end.velocity - reference.velocity).abs() < 1e-9 * 0.1);
        prop_assert!((end.flux - reference.flux).abs() < 1e-9 * 1e-2);
    }

    /// Through impacts and releases the tiny steps err by their size.
    #[test]
    fn impacts_agree_with_tiny_steps(voltage in -12.0..30.0f64, force in -2.0..2.0f64, flux in 0.0..0.02f64) {
        let start = State { position: 0.0, velocity: 0.0, flux };
        let drive = Drive { voltage, force };
        let (reference, _) = fine(start, drive, 0.2, 400_000);
        let (end, _) = advance(start, Contact::None, drive, 0.2);
        prop_assert!((end.position - reference.position).abs() < 2e-6, "{end:?} {reference:?}");
        prop_assert!((end.velocity - reference.velocity).abs() < 1e-4, "{end:?} {reference:?}");
        prop_assert!((end.flux - reference.flux).abs() < 1e-7, "{end:?} {reference:?}");
    }

    #[test]
    fn the_step_size_does_not_matter(voltage in -12.0..12.0f64, force in -1.0..1.0f64, cut in 1u32..40) {
        let start = BALL.equilibrium(0.0);
        let drive = Drive { voltage, force };
        let whole = advance(start, Contact::None, drive, 0.1);
        let (mut state, mut contact) = (start, Contact::None);
        for _ in 0..cut {
            (state, contact) = advance(state, contact, drive, 0.1 / f64::from(cut));
        }
        prop_assert!((state.position - whole.0.position).abs() < 1e-10);
        prop_assert!((state.velocity - whole.0.velocity).abs() < 1e-8);
        prop_assert!((state.flux / whole.0.flux - 1.0).abs() < 1e-8);
        prop_assert_eq!(contact, whole.1);
    }

    /// What the source gives is stored in field, motion and height or turned into heat.
    #[test]
    fn energy_is_balanced(voltage in 0.0..4.0f64, flux in 0.005..0.012f64) {
        let drive = Drive { voltage, force: 0.0 };
        let energy = |s: State| BALL.mass * (0.5 * s.velocity * s.velocity + BALL.gravity * s.position)
            + 0.5 * (BALL.gap - s.position) * s.flux * s.flux / BALL.inductance_constant;
        let power = |s: State| {
            let current = BALL.current(s.position, s.flux);
            voltage * current - BALL.resistance * current * current
        };
        let mut state = State { position: 0.0, velocity: 0.0, flux };
        let (start, mut work) = (energy(state), 0.0);
        // Simpson's rule over the two halves of each step.
        for _ in 0..200 {
            let (middle, _) = advance(state, Contact::None, drive, 5e-5);
            let (end, contact) = advance(middle, Contact::None, drive, 5e-5);
            if contact != Contact::None {
                break;
            }
            work += 1e-4 / 6.0 * (power(state) + 4.0 * power(middle) + power(end));
            state = end;
        }
        prop_assert!((energy(state) - start - work).abs() < 1e-10, "{}", energy(state) - start - work);
    }

    /// Whatever an importer wires in, the outputs are finite or the step is refused and nothing has changed.
    #[test]
    fn outputs_are_never_anything_but_numbers(
        inputs in prop::collection::vec((prop::num::f64::NORMAL, prop::num::f64::NORMAL, 1e-6..0.1f64), 1..20),
        moderate in prop::collection::vec((-1e3..1e3f64, -1e3..1e3f64, 1e-6..0.1f64), 1..20),
    ) {
        let mut plant = LevitatedBallPlant::new();
        plant.initialise(0.0).unwrap();
        for (voltage, force, duration) in moderate.into_iter().chain(inputs) {
            set(&mut plant, "voltage", voltage);
            set(&mut plant, "force", force.clamp(-1e6, 1e6));
            let before = plant.values().to_vec();
            if plant.advance(duration, &mut NullLogSink).is_err() {
                prop_assert_eq!(plant.values(), &before[..]);
            }
            prop_assert!(plant.values().iter().all(|value| value.is_finite()));
            prop_assert!((LOWER_STOP..=BALL.gap).contains(&get(&plant, "position")));
        }
    }
}

#[test]
fn sensor_noise_has_its_deviation_and_repeats() {
    let readings = |seed: f64| -> Vec<f64> {
        let mut plant = LevitatedBallPlant::new();
        set(&mut plant, "sensor.noise", 1e-3);
        set(&mut plant, "sensor.seed", seed);
        plant.initialise(0.0).unwrap();
        let reading = |_| {
            plant.advance(1e-6, &mut NullLogSink).unwrap();
            get(&plant, "current_measured") - get(&plant, "current")
        };
        (0..4000).map(reading).collect()
    };
    let noise = readings(1.0);
    let deviation = (noise.iter().map(|x| x * x).sum::<f64>() / 4000.0).sqrt();
    assert!((deviation / 1e-3 - 1.0).abs() < 0.06, "{deviation}");
    assert_eq!(noise, readings(1.0));
    assert_ne!(noise, readings(2.0));
}

#[test]
fn an_endless_step_is_refused_with_its_limit() {
    let mut plant = LevitatedBallPlant::new();
    plant.initialise(0.0).unwrap();
    let refused = plant.advance(1e9, &mut NullLogSink).unwrap_err();
    assert!(matches!(refused, ModelError::StepTooLong { duration: 1e9, .. }), "{refused}");
    assert_eq!(get(&plant, "time"), 0.0);
}

#[test]
fn contact_shows_and_ends() {
    let mut plant = LevitatedBallPlant::new();
    plant.initialise(0.0).unwrap();
    plant.advance(0.5, &mut NullLogSink).unwrap();
    assert_eq!((get(&plant, "position"), get(&plant, "contact")), (LOWER_STOP, 1.0));
    assert_eq!((get(&plant, "velocity"), get(&plant, "acceleration")), (0.0, 0.0));
    set(&mut plant, "force", 1.0);
    plant.advance(1e-3, &mut NullLogSink).unwrap();
    assert_eq!(get(&plant, "contact"), 0.0);
    assert!(get(&plant, "position") > LOWER_STOP);
}
