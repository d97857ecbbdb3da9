//! A plant for importers that integrate it or ask for derivatives.

use super::evaluation::{follow, initialise};
use super::{ContinuousPlant, PlantEquations};
use crate::model::continuous::{Stage, Tangents};
use crate::model::sensor::Sensor;
use crate::model::{ContinuousModel, Solver, TIME};
use crate::scalar::Dual;

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
