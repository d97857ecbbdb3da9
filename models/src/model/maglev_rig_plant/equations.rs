//! The rig's ball between its stops: which rows its state, inputs and outputs are, and what follows from what.

use super::table::*;
use crate::model::Description;
use crate::model::continuous_plant::{ContinuousPlant, Motion, PlantEquations};
use crate::model::end_stop_events::indicators;
use crate::model::end_stop_events::{cause_of_contact, imposed};
use crate::model::work::Load;
use crate::plant::contact::{Contact, rate_in_contact, settled, transition};
use crate::plant::maglev_rig::{HeldBall, LONGEST_SUBSTEP, MaglevRig, PositionSensor, State};
use crate::plant::maglev_rig_ramp::RampedBall;
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// The plant as a model.
pub type MaglevRigPlant = ContinuousPlant<MaglevRigEquations, COUNT, 2, 2>;

/// What a step of the integrator costs \[s\], see [`crate::model::work`].
const COST_OF_SUBSTEP: f64 = 200e-9;

/// Equations of [`crate::plant::maglev_rig`].
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub struct MaglevRigEquations;

/// The ball under a voltage \[V\] that acts and a force \[N\].
fn held<S: Scalar>(values: &[S; COUNT], [voltage, force]: [S; 2]) -> HeldBall<S> {
    HeldBall {
        rig: MaglevRig {
            mass: values[MASS],
            gravity: values[GRAVITY],
            electromagnetic_constant: values[FORCE_CONSTANT],
            driver_gain: values[DRIVER_GAIN_PARAMETER],
        },
        voltage,
        force,
        upper_stop: values[UPPER_STOP],
        lower_stop: values[LOWER_STOP],
    }
}

/// The ball under inputs, of which the driver limits the voltage.
fn driven<S: Scalar>(values: &[S; COUNT], [voltage, force]: [S; 2]) -> HeldBall<S> {
    held(values, [MaglevRigEquations::acting_voltage(values, voltage), force])
}

/// The ball under inputs that move.
fn ramped(values: &[f64; COUNT], inputs: [f64; 2], [voltage_slope, force_slope]: [f64; 2]) -> RampedBall {
    let voltage_limits = (values[VOLTAGE_MIN], values[VOLTAGE_MAX]);
    RampedBall { begin: held(values, inputs), voltage_slope, force_slope, voltage_limits }
}

fn state([position, velocity]: [f64; 2]) -> State {
    State { position, velocity }
}

fn motion((state, mode): (State, Contact)) -> Motion<Contact, 2> {
    Motion { state: [state.position, state.velocity], mode }
}

impl PlantEquations<COUNT, 2, 2> for MaglevRigEquations {
    type Mode = Contact;

    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const MODES: &'static [Contact] = &Contact::ALL;
    const STATES: [usize; 2] = [POSITION, VELOCITY];
    const INPUTS: [usize; 2] = [VOLTAGE_INPUT, FORCE];
    const READING: usize = SENSOR_VOLTAGE_MEASURED;

    fn new(_: &[f64; COUNT]) -> Self {
        Self
    }

    fn initial_state<S: Scalar>(values: &[S; COUNT]) -> [S; 2] {
        let given = [values[INITIAL_POSITION], values[INITIAL_VELOCITY]];
        settled(given, (values[UPPER_STOP], values[LOWER_STOP]))
    }

    /// Before the first step no voltage and no force have acted.
    fn initial_mode(values: &[f64; COUNT], state: &[f64; 2]) -> Contact {
        transition(&held(values, [0.0; 2]), &mut { *state }, Contact::None)
    }

    fn cause_of_initial_mode<S: Scalar>(values: &[S; COUNT], state: &[S; 2]) -> S {
        let given = [values[INITIAL_POSITION], values[INITIAL_VELOCITY]];
        cause_of_contact(&held(values, [S::from(0.0); 2]), given, state)
    }

    fn imposed(values: &[f64; COUNT], state: [f64; 2], contact: Contact) -> [f64; 2] {
        imposed(&held(values, [0.0; 2]), state, contact)
    }

    #[inline]
    fn evaluate<S: Scalar>(values: &mut [S; COUNT], contact: Contact) {
        let state = Self::STATES.map(|row| values[row]);
        let driven = driven(values, Self::INPUTS.map(|row| values[row]));
        let [position_rate, acceleration] = rate_in_contact(&driven, &state, contact);
        let [at_upper_stop, at_lower_stop] = indicators(&driven, &state, contact);
        values[POSITION_DERIVATIVE] = position_rate;
        values[ACCELERATION] = acceleration;
        values[UPPER_STOP_INDICATOR] = at_upper_stop;
        values[LOWER_STOP_INDICATOR] = at_lower_stop;
        values[SENSOR_VOLTAGE] = Self::measured(values, &state);
        values[MAGNETIC_FORCE] = driven.rig.magnetic_force(state[0].max(driven.upper_stop), driven.voltage);
    }

    #[inline]
    fn acting_voltage<S: Scalar>(values: &[S; COUNT], voltage: S) -> S {
        voltage.clamp(values[VOLTAGE_MIN], values[VOLTAGE_MAX])
    }

    #[inline]
    fn mean_acting_voltage(values: &[f64; COUNT], voltage: f64, slope: f64, duration: f64) -> f64 {
        if slope == 0.0 {
            return Self::acting_voltage(values, voltage);
        }
        ramped(values, [voltage, 0.0], [slope, 0.0]).mean_voltage(duration)
    }

    fn report_acting_voltage<S: Scalar>(values: &mut [S; COUNT], voltage: S) {
        values[VOLTAGE_MEASURED] = voltage;
        values[CURRENT] = values[DRIVER_GAIN_PARAMETER] * voltage;
    }

    fn measured<S: Scalar>(values: &[S; COUNT], &[position, _]: &[S; 2]) -> S {
        PositionSensor { gain: values[SENSOR_GAIN], offset: values[SENSOR_OFFSET] }.voltage(position)
    }

    fn within_range<S: Scalar>(values: &[S; COUNT], reading: S) -> S {
        reading.clamp(values[SENSOR_MINIMUM], values[SENSOR_MAXIMUM])
    }

    #[inline]
    fn advance(
        &self,
        values: &[f64; COUNT],
        begin: Motion<Contact, 2>,
        inputs: [f64; 2],
        duration: f64,
    ) -> Motion<Contact, 2> {
        motion(driven(values, inputs).advance(state(begin.state), begin.mode, duration))
    }

    fn advance_under_ramp(
        &self,
        values: &[f64; COUNT],
        begin: Motion<Contact, 2>,
        inputs: [f64; 2],
        slopes: [f64; 2],
        duration: f64,
    ) -> Motion<Contact, 2> {
        motion(ramped(values, inputs, slopes).advance(state(begin.state), begin.mode, duration))
    }

    fn transition(values: &[f64; COUNT], before: Motion<Contact, 2>, inputs: [f64; 2]) -> Motion<Contact, 2> {
        let mut state = before.state;
        let mode = transition(&driven(values, inputs), &mut state, before.mode);
        Motion { state, mode }
    }

    fn report_mode(values: &mut [f64; COUNT], contact: Contact) {
        values[CONTACT] = f64::from(u8::from(contact != Contact::None));
    }

    fn announcement(contact: Contact) -> Option<&'static str> {
        Some(match contact {
            Contact::None => "the ball has left its stop",
            Contact::AtSmallestPosition => "the ball rests at the coil, on upper_stop",
            Contact::AtLargestPosition => "the ball lies on lower_stop",
        })
    }

    fn load(&self) -> Load {
        Load { cost: COST_OF_SUBSTEP, interval: LONGEST_SUBSTEP }
    }
}
