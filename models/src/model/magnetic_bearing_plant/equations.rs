//! The bearing: which rows its state, inputs and outputs are, and what follows from what.

use super::table::*;
use crate::model::Description;
use crate::model::continuous_plant::{ContinuousPlant, Motion, PlantEquations, ProcessNoise};
use crate::model::magnetic_bearing::map;
use crate::model::quantity::MAGNETIC_FLUX;
use crate::plant::magnetic_bearing::{MagneticBearing, State};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// The plant as a model.
pub type MagneticBearingPlant = ContinuousPlant<MagneticBearingEquations, COUNT, 3, 1>;

/// Hysteresis of the flux's sign, in units of the nominal flux: an event indicator must not be zero after an event.
const HYSTERESIS: f64 = 1e-9;

/// Equations of [`crate::plant::magnetic_bearing`].
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub struct MagneticBearingEquations;

/// On which side of zero the flux was at the last event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FluxSign {
    #[default]
    Positive,
    Negative,
}

/// Flux in units of its nominal value, not zero after an event.
fn flux_sign_indicator<S: Scalar>(flux: S, sign: FluxSign) -> S {
    let side = if sign == FluxSign::Positive { HYSTERESIS } else { -HYSTERESIS };
    flux / S::from(MAGNETIC_FLUX.nominal) + S::from(side)
}

fn bearing<S: Scalar>(values: &[S; COUNT]) -> MagneticBearing<S> {
    MagneticBearing { epsilon: values[EPSILON] }
}

fn state([position, velocity, flux]: [f64; 3]) -> State {
    State { position, velocity, flux }
}

impl PlantEquations<COUNT, 3, 1> for MagneticBearingEquations {
    type Mode = FluxSign;

    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const MODES: &'static [FluxSign] = &[FluxSign::Positive, FluxSign::Negative];
    const STATES: [usize; 3] = [POSITION, VELOCITY_OUTPUT, FLUX];
    const INPUTS: [usize; 1] = [VOLTAGE_INPUT];
    const READING: usize = POSITION_MEASURED;
    const PROCESS_NOISE: Option<ProcessNoise> =
        Some(ProcessNoise { state: 2, standard_deviation: PROCESS_FLUX_NOISE });

    fn new(_: &[f64; COUNT]) -> Self {
        Self
    }

    fn calculate_parameters<S: Scalar>(values: &mut [S; COUNT]) {
        values[EPSILON] = MagneticBearing::with_bias(values[BIAS_FLUX], values[SATURATION_FLUX]).epsilon;
    }

    fn initial_state<S: Scalar>(values: &[S; COUNT]) -> [S; 3] {
        [values[INITIAL_POSITION], values[INITIAL_VELOCITY], values[INITIAL_FLUX]]
    }

    fn initial_mode(_: &[f64; COUNT], &[_, _, flux]: &[f64; 3]) -> FluxSign {
        if flux >= 0.0 { FluxSign::Positive } else { FluxSign::Negative }
    }

    fn cause_of_initial_mode<S: Scalar>(_: &[S; COUNT], &[_, _, flux]: &[S; 3]) -> S {
        flux
    }

    /// (3)
    #[inline]
    fn evaluate<S: Scalar>(values: &mut [S; COUNT], sign: FluxSign) {
        let flux = values[FLUX];
        values[POSITION_DERIVATIVE] = values[VELOCITY_OUTPUT];
        values[ACCELERATION_LOCAL] = bearing(values).acceleration(flux);
        values[FLUX_DERIVATIVE] = values[VOLTAGE_INPUT];
        values[FLUX_SIGN] = flux_sign_indicator(flux, sign);
    }

    fn report_acting_voltage<S: Scalar>(values: &mut [S; COUNT], voltage: S) {
        values[VOLTAGE_MEASURED] = voltage;
    }

    fn measured<S: Scalar>(_: &[S; COUNT], &[position, _, _]: &[S; 3]) -> S {
        position
    }

    #[inline]
    fn advance(
        &self,
        values: &[f64; COUNT],
        begin: Motion<FluxSign, 3>,
        [voltage]: [f64; 1],
        duration: f64,
    ) -> Motion<FluxSign, 3> {
        let end = bearing(values).advance(map(values[MAP_CHOICE]), state(begin.state), voltage, duration);
        Motion { state: [end.position, end.velocity, end.flux], ..begin }
    }

    fn advance_under_ramp(
        &self,
        values: &[f64; COUNT],
        begin: Motion<FluxSign, 3>,
        [voltage]: [f64; 1],
        [slope]: [f64; 1],
        duration: f64,
    ) -> Motion<FluxSign, 3> {
        let end = bearing(values).advance_under_ramp(state(begin.state), voltage, slope, duration);
        Motion { state: [end.position, end.velocity, end.flux], ..begin }
    }

    /// The side of zero that the flux is on.
    #[inline]
    fn transition(_: &[f64; COUNT], motion: Motion<FluxSign, 3>, _: [f64; 1]) -> Motion<FluxSign, 3> {
        let flux = motion.state[2];
        let is_positive = if flux.abs() > 2.0 * HYSTERESIS * MAGNETIC_FLUX.nominal {
            // Beyond the hysteresis, without a division.
            flux > 0.0
        } else {
            let indicator = flux_sign_indicator(flux, motion.mode);
            if motion.mode == FluxSign::Positive { indicator > 0.0 } else { indicator >= 0.0 }
        };
        Motion { mode: if is_positive { FluxSign::Positive } else { FluxSign::Negative }, ..motion }
    }

    #[inline]
    fn at_communication_point(values: &[f64; COUNT], motion: Motion<FluxSign, 3>) -> Motion<FluxSign, 3> {
        Self::transition(values, motion, [0.0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The side on which a flux lies without a division is the one that its indicator names.
    #[test]
    fn the_side_of_a_flux_is_that_of_its_indicator() {
        let shares =
            [0.0, 1e-300, 0.5, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 2.0 - 1e-15, 2.0, 2.0 + 1e-15, 3.0, 1e9, 1e300];
        for share in shares.into_iter().flat_map(|share| [share, -share]) {
            let flux = share * HYSTERESIS * MAGNETIC_FLUX.nominal;
            for mode in [FluxSign::Positive, FluxSign::Negative] {
                let indicator = flux_sign_indicator(flux, mode);
                let is_positive = indicator > 0.0 || (indicator == 0.0 && mode == FluxSign::Negative);
                let motion = Motion { state: [0.0, 0.0, flux], mode };
                let after = MagneticBearingEquations::transition(&[0.0; COUNT], motion, [0.0]).mode;
                assert_eq!(after == FluxSign::Positive, is_positive, "{share} {mode:?}");
            }
        }
    }
}
