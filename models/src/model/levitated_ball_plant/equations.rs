//! The ball between its stops: which rows its state, inputs and outputs are, and what follows from what.

use super::table::*;
use crate::model::Description;
use crate::model::continuous_plant::{ContinuousPlant, Motion, PlantEquations};
use crate::model::end_stop_events::indicators;
use crate::model::end_stop_events::{cause_of_contact, imposed};
use crate::model::work::Load;
use crate::plant::contact::{Contact, rate_in_contact, settled, transition};
use crate::plant::levitated_ball::{BallConstants, Drive, DrivenBall, LevitatedBall, State};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// The plant as a model.
pub type LevitatedBallPlant = ContinuousPlant<LevitatedBallEquations, COUNT, 3, 2>;

/// What a step of the integrator costs \[s\], see [`crate::model::work`].
const COST_OF_SUBSTEP: f64 = 250e-9;

/// Flux \[Wb\] below which the acceleration is finite, whatever mass and coil are within their ranges.
const FINITE_FLUX: f64 = 1e140;

/// Equations of [`crate::plant::levitated_ball`].
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub struct LevitatedBallEquations {
    constants: BallConstants,
    /// \[s\]
    longest_substep: f64,
}

impl LevitatedBallEquations {
    fn driven(&self, values: &[f64; COUNT], [voltage, force]: [f64; 2]) -> DrivenBall {
        DrivenBall::with(self.constants, &ball(values), values[LOWER_STOP], Drive { voltage, force })
    }
}

fn ball<S: Scalar>(values: &[S; COUNT]) -> LevitatedBall<S> {
    LevitatedBall {
        mass: values[MASS],
        resistance: values[RESISTANCE],
        inductance_constant: values[INDUCTANCE_CONSTANT],
        gap: values[GAP],
        gravity: values[GRAVITY],
    }
}

/// The ball under these inputs.
fn driven<S: Scalar>(values: &[S; COUNT], [voltage, force]: [S; 2]) -> DrivenBall<S> {
    DrivenBall::new(&ball(values), values[LOWER_STOP], Drive { voltage, force })
}

/// What follows at one instant for the ball under its present inputs.
#[inline]
fn write_what_follows<S: Scalar>(values: &mut [S; COUNT], driven: &DrivenBall<S>, contact: Contact) {
    let state = LevitatedBallEquations::STATES.map(|row| values[row]);
    let [position_rate, acceleration, flux_rate] = rate_in_contact(driven, &state, contact);
    let [at_lower_stop, at_magnet] = indicators(driven, &state, contact);
    let ([position, _, flux], ball) = (state, ball(values));
    values[POSITION_DERIVATIVE] = position_rate;
    values[ACCELERATION_LOCAL] = acceleration;
    values[FLUX_DERIVATIVE] = flux_rate;
    values[LOWER_STOP_INDICATOR] = at_lower_stop;
    values[MAGNET_INDICATOR] = at_magnet;
    values[CURRENT_OUTPUT] = ball.current(position, flux);
    values[MAGNETIC_FORCE] = ball.magnetic_force(flux);
}

fn state([position, velocity, flux]: [f64; 3]) -> State {
    State { position, velocity, flux }
}

impl PlantEquations<COUNT, 3, 2> for LevitatedBallEquations {
    type Mode = Contact;

    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const MODES: &'static [Contact] = &Contact::ALL;
    const STATES: [usize; 3] = [POSITION_OUTPUT, VELOCITY_OUTPUT, FLUX_OUTPUT];
    const INPUTS: [usize; 2] = [VOLTAGE_INPUT, FORCE_INPUT];
    const READING: usize = CURRENT_MEASURED;

    fn new(values: &[f64; COUNT]) -> Self {
        let ball = ball(values);
        let longest_substep = ball.longest_substep(values[LOWER_STOP]);
        Self { constants: BallConstants::of(&ball), longest_substep }
    }

    fn initial_state<S: Scalar>(values: &[S; COUNT]) -> [S; 3] {
        let given = [values[INITIAL_POSITION], values[INITIAL_VELOCITY]];
        let [position, velocity] = settled(given, (values[LOWER_STOP], values[GAP]));
        [position, velocity, values[INITIAL_FLUX]]
    }

    /// Before the first step no voltage and no force have acted.
    fn initial_mode(values: &[f64; COUNT], state: &[f64; 3]) -> Contact {
        transition(&driven(values, [0.0; 2]), &mut { *state }, Contact::None)
    }

    fn cause_of_initial_mode<S: Scalar>(values: &[S; COUNT], state: &[S; 3]) -> S {
        let given = [values[INITIAL_POSITION], values[INITIAL_VELOCITY]];
        cause_of_contact(&driven(values, [S::from(0.0); 2]), given, state)
    }

    fn imposed(values: &[f64; COUNT], state: [f64; 3], contact: Contact) -> [f64; 3] {
        imposed(&driven(values, [0.0; 2]), state, contact)
    }

    #[inline]
    fn evaluate<S: Scalar>(values: &mut [S; COUNT], contact: Contact) {
        let driven = driven(values, Self::INPUTS.map(|row| values[row]));
        write_what_follows(values, &driven, contact);
    }

    #[inline]
    fn evaluate_at_step(&self, values: &mut [f64; COUNT], contact: Contact) {
        let driven = self.driven(values, Self::INPUTS.map(|row| values[row]));
        write_what_follows(values, &driven, contact);
    }

    fn report_acting_voltage<S: Scalar>(values: &mut [S; COUNT], voltage: S) {
        values[VOLTAGE_MEASURED] = voltage;
    }

    fn measured<S: Scalar>(values: &[S; COUNT], &[position, _, flux]: &[S; 3]) -> S {
        ball(values).current(position, flux)
    }

    #[inline]
    fn advance(
        &self,
        values: &[f64; COUNT],
        motion: Motion<Contact, 3>,
        inputs: [f64; 2],
        duration: f64,
    ) -> Motion<Contact, 3> {
        let (mut state, mut contact) = (state(motion.state), motion.mode);
        self.driven(values, inputs).advance(&mut state, &mut contact, duration, self.longest_substep);
        Motion { state: [state.position, state.velocity, state.flux], mode: contact }
    }

    fn advance_under_ramp(
        &self,
        values: &[f64; COUNT],
        motion: Motion<Contact, 3>,
        [voltage, force]: [f64; 2],
        [voltage_slope, force_slope]: [f64; 2],
        duration: f64,
    ) -> Motion<Contact, 3> {
        let (mut state, mut contact) = (state(motion.state), motion.mode);
        let (drive, slope) = (Drive { voltage, force }, Drive { voltage: voltage_slope, force: force_slope });
        let lower_stop = values[LOWER_STOP];
        ball(values).advance_under_ramp(lower_stop, &mut state, &mut contact, drive, slope, duration);
        Motion { state: [state.position, state.velocity, state.flux], mode: contact }
    }

    fn transition(values: &[f64; COUNT], motion: Motion<Contact, 3>, inputs: [f64; 2]) -> Motion<Contact, 3> {
        let mut state = motion.state;
        let mode = transition(&driven(values, inputs), &mut state, motion.mode);
        Motion { state, mode }
    }

    fn report_mode(values: &mut [f64; COUNT], contact: Contact) {
        values[CONTACT] = f64::from(u8::from(contact != Contact::None));
    }

    fn announcement(contact: Contact) -> Option<&'static str> {
        Some(match contact {
            Contact::None => "the ball is free",
            Contact::AtSmallestPosition => "the ball rests on the lower stop",
            Contact::AtLargestPosition => "the ball sticks to the magnet",
        })
    }

    #[inline]
    fn load(&self) -> Load {
        Load { cost: COST_OF_SUBSTEP, interval: self.longest_substep }
    }

    #[inline]
    fn also_finite(values: &[f64; COUNT], &[_, _, flux]: &[f64; 3]) -> Option<(usize, f64)> {
        if flux.abs() < FINITE_FLUX {
            return None;
        }
        let ball = ball(values);
        Some((ACCELERATION_LOCAL, ball.magnetic_force(flux) / ball.mass))
    }
}
