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

/// From which of three parameters a start position comes: the one given, or that of the stop it lies beyond.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub given: f64,
    pub smallest: f64,
    pub largest: f64,
}

impl Start {
    /// Partial derivative of the position at the start with respect to the given one, to the smallest and to the
    /// largest.
    pub(super) fn position_slopes(self) -> [f64; 3] {
        if self.given <= self.smallest {
            [0.0, 1.0, 0.0]
        } else if self.given >= self.largest {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, 0.0, 0.0]
        }
    }

    /// Partial derivative of the velocity at the start with respect to the given one, which a stop takes away unless
    /// it points inwards.
    pub(super) fn velocity_slope(self, velocity: f64) -> f64 {
        let inwards = match self.position_slopes() {
            [_, 1.0, _] => velocity,
            [_, _, 1.0] => -velocity,
            _ => return 1.0,
        };
        if inwards > 0.0 { 1.0 } else { 0.0 }
    }
}
