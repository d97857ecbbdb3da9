//! A plant for importers that integrate it or ask for derivatives.

use super::shell::follow;
use super::{ContinuousPlant, PlantEquations};
use crate::model::continuous::{Stage, Tangents};
use crate::model::sensor::{Sensor, noisy};
use crate::model::{ContinuousModel, Solver, TIME};
use crate::scalar::{Dual, Scalar};
use crate::signal::quantise;

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> ContinuousModel
    for ContinuousPlant<E, N, X, U>
{
    #[inline]
    fn evaluate(&mut self) {
        let is_read = self.sensor.is_read(self.solver);
        let evaluate = |values: &mut [f64; N]| self.equations.evaluate_at_step(values, self.mode);
        follow::<E, f64, N, X, U>(&mut self.values, evaluate, self.solver, is_read);
    }

    fn set_solver(&mut self, solver: Solver) -> bool {
        core::mem::replace(&mut self.solver, solver) != solver
    }

    fn update_discrete_states(&mut self) -> bool {
        let before = self.motion();
        let after = E::transition(&self.values, before, self.inputs());
        self.set_motion(after);
        self.evaluate();
        if self.sensor.reaches_reading(self.values[TIME]) {
            self.read_sensor(E::measured(&self.values, &after.state));
        }
        after.state != before.state
    }

    fn next_event_time(&self) -> Option<f64> {
        self.sensor.next_reading(self.values[TIME])
    }

    fn tangents(&self, stage: Stage, seed: &mut dyn Iterator<Item = (usize, f64)>) -> Tangents {
        let mut values = self.values.map(Dual::from);
        for (known, along) in seed {
            values[known].tangent += along;
        }
        let is_read = self.sensor.is_read(self.solver);
        match stage {
            Stage::Initialisation => {
                let sample = Dual::from(Sensor::first_noise(self.values[E::SENSOR.seed]));
                initialise::<E, Dual, N, X, U>(&mut values, self.mode, self.solver, is_read, sample);
            }
            Stage::Running => {
                E::calculate_parameters(&mut values);
                follow::<E, Dual, N, X, U>(
                    &mut values,
                    |values| E::evaluate(values, self.mode),
                    self.solver,
                    is_read,
                );
            }
        }
        Tangents::of(values.iter().map(|value| value.tangent))
    }

    fn input_slope(&self, input: usize) -> f64 {
        E::INPUTS.iter().position(|row| *row == input).map_or(0.0, |place| self.slopes[place])
    }

    fn set_input_slope(&mut self, input: usize, slope: f64) {
        if let Some(place) = E::INPUTS.iter().position(|row| *row == input) {
            self.slopes[place] = slope;
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
