//! End stops as state events for importers that integrate a plant: impacts and releases.

use crate::plant::contact::{Contact, Guided, event_indicators};
use crate::scalar::Scalar;

/// Distance by which a body may be beyond a stop before that is an impact \[m\]: an event indicator must not be zero
/// after an event, and after a release the body is right at the stop.
const CLEARANCE: f64 = 1e-9;

/// Acceleration away from the stop up to which a resting body stays there, as a share of [`ACCELERATION`].
const HYSTERESIS: f64 = 1e-9;

/// Usual size of an acceleration \[m/s2\]: that of gravity.
const ACCELERATION: f64 = 9.81;

/// Indicators of the stops at the smallest and at the largest position, about 1 in size: the distance to a stop in
/// units of the free way, or the acceleration that presses the body on in units of gravity.
pub(super) fn indicators<const N: usize, S: Scalar>(
    system: &impl Guided<N, S>,
    state: &[S; N],
    contact: Contact,
) -> [S; 2] {
    let (smallest, largest) = system.stops();
    let way = largest - smallest;
    let [below, above] = event_indicators(system, state, contact);
    let distance = |metres: S| (metres + S::from(CLEARANCE)) / way;
    let pressure = |acceleration: S| acceleration / S::from(ACCELERATION) + S::from(HYSTERESIS);
    match contact {
        Contact::None => [distance(below), distance(above)],
        Contact::AtSmallestPosition => [pressure(below), distance(above)],
        Contact::AtLargestPosition => [distance(below), pressure(above)],
    }
}

/// A number that depends on whatever decides on which stop a body rests that starts with the `given` position and
/// velocity, from which `state` follows.
pub(super) fn cause_of_contact<const N: usize, S: Scalar>(
    system: &impl Guided<N, S>,
    given: [S; 2],
    state: &[S; N],
) -> S {
    let (smallest, largest) = system.stops();
    given[0] + given[1] + smallest + largest + system.rate(state)[1]
}

/// `state` as it is in contact: at the stop, at rest.
pub(super) fn imposed<const N: usize>(
    system: &impl Guided<N>,
    mut state: [f64; N],
    contact: Contact,
) -> [f64; N] {
    let (smallest, largest) = system.stops();
    match contact {
        Contact::None => return state,
        Contact::AtSmallestPosition => state[0] = smallest,
        Contact::AtLargestPosition => state[0] = largest,
    }
    state[1] = 0.0;
    state
}
