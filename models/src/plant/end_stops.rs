//! Motion of a body between two stops.
//!
//! Impacts and releases are found to the last digit of the step by bisection on the integrator itself: the step to an event
//! is a Runge-Kutta step that ends there. [`advance`] is made of what [`super::contact`] says of one instant, which is also
//! what another integrator needs to do the same.

use super::contact::{Contact, Guided, event_indicators, transition};
use super::runge_kutta;

/// Events within one sub-step after which a chattering body is left as it is until the sub-step's end. Each impact
/// but the first of a sub-step needs a release in between, so that a real motion has one or two.
const EVENTS_PER_SUBSTEP: u32 = 8;

/// Events that are located within one call of [`advance`]; beyond, the body is left as it is to the end of each sub-step with
/// one. Held or ramped inputs make few; so many are forces that balance but for rounding errors, and locating each would
/// make the computing endless.
const EVENTS_PER_ADVANCE: u32 = 10_000;

/// Halvings of an interval until its ends are neighbouring numbers or the rest does not matter.
const BISECTIONS: u32 = 64;

/// Lets `duration` \[s\] pass in sub-steps of at most `longest_substep` \[s\].
///
/// A motion that leaves and comes back within one sub-step is noticed for the position, not for the acceleration
/// during contact. Numbers that are not finite come out as they are; the caller judges them.
#[inline]
pub fn advance<const N: usize>(
    system: &impl Guided<N>,
    state: &mut [f64; N],
    contact: &mut Contact,
    duration: f64,
    longest_substep: f64,
) {
    let (mut substeps, mut substep) = (1, duration);
    if duration > longest_substep {
        // The cast saturates; a share of 1e-9 keeps a rounded quotient from costing a sub-step.
        substeps = (libm::ceil(duration / longest_substep * (1.0 - 1e-9)) as u64).max(1);
        substep = duration / substeps as f64;
    }
    *contact = transition(system, state, *contact);
    let mut located = 0;
    for _ in 0..substeps {
        let before = (*state, *contact);
        advance_substep(system, state, contact, substep, &mut located);
        if *contact != Contact::None && before.1 == *contact && is_same(&before.0, state) {
            // At rest with nothing in motion: every further sub-step would end where this one did.
            break;
        }
    }
}

/// Whether two states are the same to the bit.
#[inline]
fn is_same<const N: usize>(first: &[f64; N], second: &[f64; N]) -> bool {
    first.iter().zip(second).all(|(first, second)| first.to_bits() == second.to_bits())
}

fn advance_substep<const N: usize>(
    system: &impl Guided<N>,
    state: &mut [f64; N],
    contact: &mut Contact,
    substep: f64,
    located: &mut u32,
) {
    let mut remaining = substep;
    for _ in 0..EVENTS_PER_SUBSTEP {
        if *located >= EVENTS_PER_ADVANCE {
            break;
        }
        let end = flow(system, state, *contact, remaining);
        let Some(time) = first_event(system, state, &end, *contact, remaining) else {
            *state = end;
            return;
        };
        *state = flow(system, state, *contact, time);
        *contact = transition(system, state, *contact);
        *located += 1;
        remaining -= time;
        if remaining <= 0.0 {
            return;
        }
    }
    chatter(system, state, contact, remaining);
}

/// Forces about to balance at a stop, told apart by rounding errors only: the rest of the sub-step in one piece.
#[cold]
fn chatter<const N: usize>(
    system: &impl Guided<N>,
    state: &mut [f64; N],
    contact: &mut Contact,
    remaining: f64,
) {
    *state = flow(system, state, *contact, remaining);
    *contact = transition(system, state, *contact);
}

#[inline]
fn flow<const N: usize>(
    system: &impl Guided<N>,
    state: &[f64; N],
    contact: Contact,
    duration: f64,
) -> [f64; N] {
    match contact {
        Contact::None => runge_kutta::step(|state| system.rate(state), state, duration),
        _ => runge_kutta::step(|state| system.rate_at_rest(state), state, duration),
    }
}

/// Time of the first event in (0, `duration`\], given where the state would be at its end without one.
#[inline]
fn first_event<const N: usize>(
    system: &impl Guided<N>,
    start: &[f64; N],
    end: &[f64; N],
    contact: Contact,
    duration: f64,
) -> Option<f64> {
    let due = |state: &[f64; N]| event_indicators(system, state, contact).iter().any(|z| *z < 0.0);
    if due(end) {
        return Some(first_time(|time| due(&flow(system, start, contact, time)), duration));
    }
    // The position may have been beyond a stop in between, if the velocity has turned.
    let (smallest, largest) = system.stops();
    let reach = start[1].abs() * duration;
    let near = start[0] - smallest <= reach || largest - start[0] <= reach;
    if contact == Contact::None && near && start[1] * end[1] < 0.0 {
        let turned = |time| flow(system, start, contact, time)[1] * start[1] <= 0.0;
        let turning_point = first_time(turned, duration);
        if due(&flow(system, start, contact, turning_point)) {
            return Some(first_time(|time| due(&flow(system, start, contact, time)), turning_point));
        }
    }
    None
}

/// Smallest number found for which `happened` holds, given that it does at `latest`: bisection to the last digit.
#[cold]
fn first_time(happened: impl Fn(f64) -> bool, latest: f64) -> f64 {
    let (mut before, mut after) = (0.0, latest);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            break;
        }
        *(if happened(middle) { &mut after } else { &mut before }) = middle;
    }
    after
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::contact::settled;
    use proptest::prelude::*;

    /// A body under a constant acceleration and one that grows in time, the third state: all motions are polynomials.
    struct Thrown {
        acceleration: f64,
        jerk: f64,
    }

    impl Guided<3> for Thrown {
        fn rate(&self, state: &[f64; 3]) -> [f64; 3] {
            [state[1], self.acceleration + self.jerk * state[2], 1.0]
        }

        fn stops(&self) -> (f64, f64) {
            (-1.0, 2.0)
        }
    }

    #[test]
    fn impact_comes_at_the_exact_time() {
        // From 0 with 1 m/s upwards and 2 m/s2 down: at -1 m after (1 + sqrt 5) / 2 s.
        let system = Thrown { acceleration: -2.0, jerk: 0.0 };
        let golden = (1.0 + 5f64.sqrt()) / 2.0;
        for (until, expected) in
            [(golden - 1e-12, Contact::None), (golden + 1e-12, Contact::AtSmallestPosition)]
        {
            let (mut state, mut contact) = ([0.0, 1.0, 0.0], Contact::None);
            advance(&system, &mut state, &mut contact, until, 0.3);
            assert_eq!(contact, expected);
        }
        let (mut state, mut contact) = ([0.0, 1.0, 0.0], Contact::None);
        advance(&system, &mut state, &mut contact, 3.0, 0.3);
        assert_eq!((state[0], state[1], contact), (-1.0, 0.0, Contact::AtSmallestPosition));
        assert!((state[2] - 3.0).abs() < 1e-12, "the other states flow on");
    }

    #[test]
    fn release_comes_at_the_exact_time_and_the_flight_starts_from_rest() {
        // Pressed on the largest position until t = 1 s, then drawn away with a jerk of -3 m/s3.
        let system = Thrown { acceleration: 3.0, jerk: -3.0 };
        let (mut state, mut contact) = ([2.0, 0.0, 0.0], Contact::AtLargestPosition);
        advance(&system, &mut state, &mut contact, 1.5, 0.4);
        assert_eq!(contact, Contact::None);
        assert!((state[0] - (2.0 - 0.5 * 0.5f64.powi(3))).abs() < 1e-14, "{}", state[0]);
        assert!((state[1] + 1.5 * 0.5f64.powi(2)).abs() < 1e-14, "{}", state[1]);
    }

    #[test]
    fn a_short_touch_between_two_points_of_time_is_an_impact() {
        // The top of the throw lies 0.02 m beyond the stop and falls between the ends of one sub-step.
        let system = Thrown { acceleration: -4.0, jerk: 0.0 };
        let speed = (2.0 * 4.0 * 2.02f64).sqrt();
        let impact = (speed - (speed * speed - 2.0 * 4.0 * 2.0).sqrt()) / 4.0;
        let (mut state, mut contact) = ([0.0, speed, 0.0], Contact::None);
        advance(&system, &mut state, &mut contact, 1.2, 1.2);
        let fall = 1.2 - impact;
        assert_eq!(contact, Contact::None);
        assert!((state[0] - (2.0 - 2.0 * fall * fall)).abs() < 1e-13, "{}", state[0]);
        assert!((state[1] + 4.0 * fall).abs() < 1e-13, "{}", state[1]);
    }

    #[test]
    fn balanced_forces_at_a_stop_end() {
        // No acceleration at all, and one that changes its sign exactly when the body rests.
        for (acceleration, jerk) in [(0.0, 0.0), (0.0, 1.0), (0.0, -1.0), (-1e-300, 1e-300)] {
            let system = Thrown { acceleration, jerk };
            for start in [-1.0, 2.0] {
                let (mut state, mut contact) = ([start, 0.0, 0.0], Contact::None);
                advance(&system, &mut state, &mut contact, 1.0, 0.01);
                assert!((-1.0..=2.0).contains(&state[0]), "{state:?}");
            }
        }
    }

    /// Pressed on a stop by a force that counts how often it is asked for; the third state flows on at a rate.
    struct Pressed<'a>(f64, &'a core::cell::Cell<u64>);

    impl Guided<3> for Pressed<'_> {
        fn rate(&self, state: &[f64; 3]) -> [f64; 3] {
            self.1.set(self.1.get() + 1);
            [state[1], 2.0 - state[2], self.0]
        }

        fn stops(&self) -> (f64, f64) {
            (-1.0, 2.0)
        }

        fn rate_at_rest(&self, _: &[f64; 3]) -> [f64; 3] {
            [0.0, 0.0, self.0]
        }
    }

    #[test]
    fn rest_ends_in_the_same_state_however_it_is_cut_and_costs_no_forces() {
        for (flow, once_more) in [(0.0, 0), (1e-3, 999), (3.0, 999)] {
            let asked = core::cell::Cell::new(0);
            let system = Pressed(flow, &asked);
            let start = ([2.0, 0.0, 0.0], Contact::AtLargestPosition);
            let (mut whole, mut contact) = start;
            advance(&system, &mut whole, &mut contact, 1.0, 1e-3);
            let (at_once, end) = (asked.get(), contact);
            let (mut cut, mut contact) = start;
            let substep = 1.0 / 1000.0;
            (0..1000).for_each(|_| advance(&system, &mut cut, &mut contact, substep, 1e-3));
            assert!(is_same(&whole, &cut) && contact == end, "{whole:?} {cut:?}");
            // Is it pressed on: at the begin, and at the end of each sub-step that is taken.
            if end != Contact::None {
                assert_eq!(at_once, 2 + once_more);
            }
        }
    }

    #[test]
    fn a_body_that_rattles_without_end_costs_no_more_than_it_should() {
        /// Counts how often the forces are asked for; they change their sign a hundred times per sub-step.
        struct Rattling(core::cell::Cell<u64>);

        impl Guided<3> for Rattling {
            fn rate(&self, state: &[f64; 3]) -> [f64; 3] {
                self.0.set(self.0.get() + 1);
                [state[1], libm::sin(state[2]) - 0.1, 1e5]
            }

            fn stops(&self) -> (f64, f64) {
                (-1.0, 2.0)
            }
        }

        let system = Rattling(core::cell::Cell::new(0));
        let (mut state, mut contact) = ([-1.0, 0.0, 0.0], Contact::AtSmallestPosition);
        let substeps = 100_000u32;
        advance(&system, &mut state, &mut contact, 1e-3 * f64::from(substeps), 1e-3);
        assert!((-1.0..=2.0).contains(&state[0]));
        // Without a bound each sub-step may bisect for eight events, a thousand times six stages each.
        let events = f64::from(EVENTS_PER_ADVANCE) * f64::from(BISECTIONS) * 2.0 * 8.0;
        let plain = f64::from(substeps) * 2.0 * 8.0;
        assert!(system.0.get() as f64 <= events + plain, "{} {events} {plain}", system.0.get());
    }

    proptest! {
        #[test]
        fn a_start_is_a_transition_from_no_contact(
            position in prop_oneof![-2.0..3.0f64, Just(-1.0), Just(2.0)], velocity in prop_oneof![-1.0..1.0f64, Just(0.0)],
            acceleration in -1.0..1.0f64,
        ) {
            let system = Thrown { acceleration, jerk: 0.0 };
            let mut state = [position, velocity, 0.0];
            transition(&system, &mut state, Contact::None);
            prop_assert_eq!(settled([position, velocity], system.stops()), [state[0], state[1]]);
        }
    }

    #[test]
    fn what_is_not_a_number_ends_and_shows() {
        let (mut state, mut contact) = ([0.0, f64::NAN, 0.0], Contact::None);
        advance(&Thrown { acceleration: 1.0, jerk: 0.0 }, &mut state, &mut contact, 1.0, 0.01);
        assert!(state[0].is_nan());
    }

    /// A body between the stops on a spring, shaken with a period of 2 pi s.
    struct Shaken {
        stiffness: f64,
        amplitude: f64,
    }

    impl Guided<3> for Shaken {
        fn rate(&self, state: &[f64; 3]) -> [f64; 3] {
            [state[1], self.amplitude * libm::sin(state[2]) - self.stiffness * state[0], 1.0]
        }

        fn stops(&self) -> (f64, f64) {
            (-1.0, 2.0)
        }
    }

    proptest! {
        #[test]
        fn the_way_the_time_is_cut_does_not_matter(
            stiffness in 0.0..3.0f64, amplitude in 0.0..20.0f64, velocity in -5.0..5.0f64, share in 0.01..0.99f64,
        ) {
            let system = Shaken { stiffness, amplitude };
            let run = |cuts: &[f64], substep| {
                let (mut state, mut contact) = ([0.5, velocity, 0.0], Contact::None);
                cuts.iter().for_each(|cut| advance(&system, &mut state, &mut contact, *cut, substep));
                state
            };
            let fine = run(&[10.0], 1e-3);
            let coarse = run(&[10.0 * share, 10.0 * (1.0 - share)], 1e-2);
            prop_assert!((-1.0..=2.0).contains(&fine[0]));
            prop_assert!((fine[0] - coarse[0]).abs() < 1e-7 && (fine[1] - coarse[1]).abs() < 1e-6,
                "{:?} {:?}", fine, coarse);
        }
    }
}
