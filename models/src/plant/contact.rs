//! A body on one axis that rests at a stop or moves freely between two.
//!
//! State 0 is the position \[m\], state 1 the velocity \[m/s\]; further states (flux, current) flow on during contact.
//! An impact is perfectly inelastic: the position becomes the stop's, the velocity zero. The body rests until the
//! free acceleration points away from the stop.

use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// Where the body rests, named by the position and not by up and down, which depend on the rig's axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Contact {
    /// It moves freely.
    #[default]
    None,
    AtSmallestPosition,
    AtLargestPosition,
}

impl Contact {
    pub const ALL: [Self; 3] = [Self::None, Self::AtSmallestPosition, Self::AtLargestPosition];
}

/// A body guided along one axis, with all its inputs held.
pub trait Guided<const N: usize, S: Scalar = f64> {
    /// Rate of the state in free flight; `rate[0]` is the velocity, `rate[1]` the acceleration \[m/s2\].
    fn rate(&self, state: &[S; N]) -> [S; N];

    /// Rate of the state while the body rests at a stop: neither position nor velocity change. To be overridden where
    /// nothing else needs the forces, which nobody feels.
    #[inline]
    fn rate_at_rest(&self, state: &[S; N]) -> [S; N] {
        let mut rate = self.rate(state);
        rate[0] = S::from(0.0);
        rate[1] = S::from(0.0);
        rate
    }

    /// Smallest and largest position \[m\], in this order and different.
    fn stops(&self) -> (S, S);
}

/// Rate of the state, in free flight or at a stop.
#[inline]
pub fn rate_in_contact<const N: usize, S: Scalar>(
    system: &impl Guided<N, S>,
    state: &[S; N],
    contact: Contact,
) -> [S; N] {
    match contact {
        Contact::None => system.rate(state),
        _ => system.rate_at_rest(state),
    }
}

/// One number per stop, the smallest position first: positive while nothing happens there, negative once
/// [`transition`] is due. For a stop the body does not touch it is the distance \[m\], for the one it rests on the
/// acceleration \[m/s2\] that presses it on.
#[inline]
pub fn event_indicators<const N: usize, S: Scalar>(
    system: &impl Guided<N, S>,
    state: &[S; N],
    contact: Contact,
) -> [S; 2] {
    let (smallest, largest) = system.stops();
    let mut indicators = [state[0] - smallest, largest - state[0]];
    match contact {
        Contact::None => {}
        Contact::AtSmallestPosition => indicators[0] = -system.rate(state)[1],
        Contact::AtLargestPosition => indicators[1] = system.rate(state)[1],
    }
    indicators
}

/// What an event makes of the state, and the contact after it: an impact stops the body, an acceleration away from
/// the stop releases it. Without an event both stay as they are.
#[inline]
pub fn transition<const N: usize>(
    system: &impl Guided<N>,
    state: &mut [f64; N],
    contact: Contact,
) -> Contact {
    let (smallest, largest) = system.stops();
    let (stop, touched, inwards) = match contact {
        Contact::AtSmallestPosition => (smallest, Contact::AtSmallestPosition, 1.0),
        Contact::AtLargestPosition => (largest, Contact::AtLargestPosition, -1.0),
        Contact::None if state[0] <= smallest => (smallest, Contact::AtSmallestPosition, 1.0),
        Contact::None if state[0] >= largest => (largest, Contact::AtLargestPosition, -1.0),
        Contact::None => return Contact::None,
    };
    state[0] = stop;
    if contact == Contact::None && inwards * state[1] > 0.0 {
        return Contact::None;
    }
    state[1] = 0.0;
    if inwards * system.rate(state)[1] > 0.0 { Contact::None } else { touched }
}

/// Position and velocity with which a body starts that is given these: what [`transition`] makes of them, whichever
/// contact that is.
pub fn settled<S: Scalar>([position, velocity]: [S; 2], (smallest, largest): (S, S)) -> [S; 2] {
    let still = S::from(0.0);
    let upwards = velocity.if_at_most(still, still, velocity);
    let downwards = still.if_at_most(velocity, still, velocity);
    let below_the_largest = largest.if_at_most(position, downwards, velocity);
    let velocity = position.if_at_most(smallest, upwards, below_the_largest);
    [largest.min(smallest.max(position)), velocity]
}
