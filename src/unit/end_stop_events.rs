//! End stops as state events for importers that integrate a plant: impacts and releases.

use crate::plant::end_stops::{self, Contact, Guided};

/// Distance by which a body may be beyond a stop before that is an impact \[m\]: an event indicator must not be zero
/// after an event, and after a release the body is right at the stop.
const CLEARANCE: f64 = 1e-9;

/// Acceleration away from the stop up to which a resting body stays there, as a share of [`ACCELERATION`].
const HYSTERESIS: f64 = 1e-9;

/// Usual size of an acceleration \[m/s2\]: that of gravity.
const ACCELERATION: f64 = 9.81;

/// Indicators of the stops at the smallest and at the largest position, about 1 in size: the distance to a stop in
/// units of the free way, or the acceleration that presses the body on in units of gravity.
pub(super) fn indicators<const N: usize>(
    system: &impl Guided<N>,
    state: &[f64; N],
    contact: Contact,
) -> [f64; 2] {
    let (smallest, largest) = system.stops();
    let way = largest - smallest;
    let [below, above] = end_stops::event_indicators(system, state, contact);
    let distance = |metres: f64| (metres + CLEARANCE) / way;
    let pressure = |acceleration: f64| acceleration / ACCELERATION + HYSTERESIS;
    match contact {
        Contact::None => [distance(below), distance(above)],
        Contact::AtSmallestPosition => [pressure(below), distance(above)],
        Contact::AtLargestPosition => [distance(below), pressure(above)],
    }
}

/// Slope of a state's start value that is the smallest or largest position if the body starts there.
pub(super) fn start_slope(contact: Contact, is_initial: bool, is_smallest: bool, is_largest: bool) -> f64 {
    let moves = match contact {
        Contact::None => is_initial,
        Contact::AtSmallestPosition => is_smallest,
        Contact::AtLargestPosition => is_largest,
    };
    f64::from(u8::from(moves))
}
