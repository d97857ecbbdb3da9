//! All values of a plant at one instant, for whatever scalar: stepped, differentiated or traced.

use super::PlantEquations;
use crate::model::Solver;
use crate::model::sensor::noisy;
use crate::scalar::Scalar;
use crate::signal::quantise;

/// All that follows at one instant from the rows of states, inputs and parameters, and that `evaluate` does not compute. The
/// outputs of the voltage and of a sensor that `is_read` tell of the past, unless an importer solves the plant.
#[inline]
pub(super) fn follow<E, S: Scalar, const N: usize, const X: usize, const U: usize>(
    values: &mut [S; N],
    evaluate: impl FnOnce(&mut [S; N]),
    solver: Solver,
    is_read: bool,
) where
    E: PlantEquations<N, X, U>,
{
    evaluate(values);
    if solver == Solver::Importer {
        let voltage = E::acting_voltage(values, values[E::INPUTS[0]]);
        E::report_acting_voltage(values, voltage);
        if !is_read {
            let measured = E::measured(values, &E::STATES.map(|row| values[row]));
            values[E::READING] = E::within_range(values, measured);
        }
    }
}

/// What initialisation computes from parameters and inputs, given the mode that follows from them and the first `sample`
/// of the sensor's noise.
pub(super) fn initialise<E, S: Scalar, const N: usize, const X: usize, const U: usize>(
    values: &mut [S; N],
    mode: E::Mode,
    solver: Solver,
    is_read: bool,
    sample: S,
) where
    E: PlantEquations<N, X, U>,
{
    E::calculate_parameters(values);
    let state = E::initial_state(values);
    for (row, value) in E::STATES.into_iter().zip(state) {
        values[row] = value;
    }
    E::report_acting_voltage(values, S::from(0.0));
    follow::<E, S, N, X, U>(values, |values| E::evaluate(values, mode), solver, is_read);
    if is_read {
        let rows = E::SENSOR;
        let reading = noisy(E::measured(values, &state), values[rows.noise], sample);
        values[E::READING] = E::within_range(values, quantise(reading, values[rows.resolution]));
    }
}
