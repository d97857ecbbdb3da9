//! Windowed Gauss-Newton observer of any model: the state at the window's oldest sample from which the model explains all
//! measurements in the window best, carried to the newest one. For N samples of N states that is the Newton observer (5),
//! (6) of the magnetic bearing's paper; for more it is the footnote to (5) (Mystkowski, Kotta, Kaparin 2018).

use core::array::from_fn;

use super::factored_covariance::sum;
use super::process_model::ProcessModel;
use super::sample_window::SampleWindow;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

pub use super::sample_window::MAX_WINDOW;

/// Share of the measurement that a step has to move the predictions by to be followed by another one. What a step leaves
/// goes with the square of it.
const RESOLUTION: f64 = 1e-6;

/// How much is explained, and by how much work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GaussNewtonSettings {
    /// Samples, up to [`MAX_WINDOW`] and at least as many as states.
    pub window: usize,
    /// Largest number of iterations per sample, at least 1; they start from the last solution.
    pub max_iterations: u32,
    /// How many of the states, the first ones, are estimated; the others keep their values.
    pub estimated_states: usize,
}

/// Past samples, and the states at both ends of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaussNewtonObserver<const N: usize> {
    #[serde(with = "BigArray")]
    oldest: [f64; N],
    #[serde(with = "BigArray")]
    newest: [f64; N],
    window: SampleWindow,
}

impl<const N: usize> GaussNewtonObserver<N> {
    /// An observer that expects `initial` at its first sample.
    pub const fn new(initial: [f64; N]) -> Self {
        Self { oldest: initial, newest: initial, window: SampleWindow::EMPTY }
    }

    /// Begins anew from `state` at a sample.
    pub fn reset(&mut self, state: [f64; N], measured: f64) {
        *self = Self::new(state);
        self.window.push(measured, 0.0);
    }

    /// State at the newest sample.
    pub fn state(&self) -> &[f64; N] {
        &self.newest
    }

    /// Takes a sample and the input that acted since the sample before; returns the innovation. Until there are more
    /// samples than unknowns, or as many in a window no longer than that, the model alone carries the initial state.
    #[inline]
    pub fn update(
        &mut self,
        model: &impl ProcessModel<N>,
        settings: &GaussNewtonSettings,
        measured: f64,
        input: f64,
    ) -> f64 {
        if self.window.len() > 0 {
            self.newest = model.predict(&self.newest, input);
        }
        let innovation = measured - self.newest[0];
        let length = settings.window.clamp(N, MAX_WINDOW);
        while self.window.len() >= length {
            if let Some(first) = self.window.inputs().first() {
                self.oldest = model.predict(&self.oldest, *first);
            }
            self.window.drop_oldest();
        }
        self.window.push(measured, input);
        let unknowns = settings.estimated_states.min(N);
        if self.window.len() > unknowns || self.window.len() == length {
            self.iterate(model, settings.max_iterations, unknowns);
        }
        innovation
    }

    /// Improves both ends of the window.
    fn iterate(&mut self, model: &impl ProcessModel<N>, max_iterations: u32, unknowns: usize) {
        let [.., newest] = self.window.measurements() else { return };
        let resolution = RESOLUTION * newest.abs();
        for _ in 0..max_iterations {
            let problem = self.linearise(model);
            let Some(step) = problem.solve(unknowns) else { break };
            for (component, change) in self.oldest.iter_mut().zip(step) {
                *component += change;
            }
            if problem.change(&step) <= resolution * resolution {
                // So small a step moves the newest state, too, as the linearisation says.
                self.newest = problem.newest_after(&step);
                return;
            }
        }
        self.newest =
            self.window.inputs().iter().fold(self.oldest, |state, input| model.predict(&state, *input));
    }

    /// The least-squares problem around the present state.
    #[inline]
    fn linearise(&self, model: &impl ProcessModel<N>) -> LeastSquares<N> {
        let mut problem = LeastSquares::at(self.oldest);
        let (measurements, inputs) = (self.window.measurements(), self.window.inputs());
        for (index, measured) in measurements.iter().enumerate() {
            if index > 0 {
                let (state, slope) = model.linearised(&problem.newest, inputs[index - 1]);
                problem.advance(state, &slope);
            }
            problem.add(*measured);
        }
        problem
    }
}

/// Normal equations of a window's deviations.
struct LeastSquares<const N: usize> {
    /// Sum of the products of the sensitivities; what is right of the diagonal is not used.
    normal: [[f64; N]; N],
    /// Sum of the sensitivities times the deviations.
    right: [f64; N],
    /// Predicted state at the last sample so far, and its derivative by the oldest one.
    newest: [f64; N],
    sensitivity: [[f64; N]; N],
}

impl<const N: usize> LeastSquares<N> {
    fn at(oldest: [f64; N]) -> Self {
        let identity = from_fn(|row| from_fn(|column| if row == column { 1.0 } else { 0.0 }));
        Self { normal: [[0.0; N]; N], right: [0.0; N], newest: oldest, sensitivity: identity }
    }

    #[inline(always)]
    fn advance(&mut self, state: [f64; N], slope: &[[f64; N]; N]) {
        let before = self.sensitivity;
        self.newest = state;
        self.sensitivity =
            from_fn(|row| from_fn(|column| sum((0..N).map(|k| slope[row][k] * before[k][column]))));
    }

    #[inline(always)]
    fn add(&mut self, measured: f64) {
        let (sensitivity, deviation) = (&self.sensitivity[0], measured - self.newest[0]);
        for row in 0..N {
            for column in 0..=row {
                self.normal[row][column] += sensitivity[row] * sensitivity[column];
            }
            self.right[row] += sensitivity[row] * deviation;
        }
    }

    /// The step of the first `unknowns` states by Cholesky's factors; none where the samples do not determine it.
    fn solve(&self, unknowns: usize) -> Option<[f64; N]> {
        // Scaled to a unit diagonal: the states have different units.
        let scale: [f64; N] = from_fn(|row| 1.0 / self.normal[row][row].sqrt());
        let mut factor = [[0.0; N]; N];
        let mut step = [0.0; N];
        for row in 0..unknowns {
            for column in 0..=row {
                let product: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
                let rest = self.normal[row][column] * scale[row] * scale[column] - product;
                factor[row][column] = if row == column { rest.sqrt() } else { rest / factor[column][column] };
            }
            let known: f64 = (0..row).map(|k| factor[row][k] * step[k]).sum();
            step[row] = (self.right[row] * scale[row] - known) / factor[row][row];
        }
        for row in (0..unknowns).rev() {
            let known: f64 = (row + 1..unknowns).map(|k| factor[k][row] * step[k]).sum();
            step[row] = (step[row] - known) / factor[row][row];
        }
        for row in 0..unknowns {
            step[row] *= scale[row];
        }
        step.iter().all(|component| component.is_finite()).then_some(step)
    }

    /// Sum of the squares of what a solution `step` changes the predictions by.
    fn change(&self, step: &[f64; N]) -> f64 {
        step.iter().zip(self.right).map(|(change, right)| change * right).sum()
    }

    fn newest_after(&self, step: &[f64; N]) -> [f64; N] {
        from_fn(|row| self.newest[row] + (0..N).map(|k| self.sensitivity[row][k] * step[k]).sum::<f64>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x1' = x2, x2' = -sin x1 + x3 + u by a step of a symplectic method, and its derivative.
    struct Pendulum;

    const STEP: f64 = 0.1;

    impl ProcessModel<3> for Pendulum {
        fn predict(&self, state: &[f64; 3], input: f64) -> [f64; 3] {
            self.linearised(state, input).0
        }

        fn linearised(&self, &[angle, rate, torque]: &[f64; 3], input: f64) -> ([f64; 3], [[f64; 3]; 3]) {
            let after = rate + STEP * (torque + input - libm::sin(angle));
            let [by_angle, by_rate, by_torque] = [-STEP * libm::cos(angle), 1.0, STEP];
            let slope = [
                [1.0 + STEP * by_angle, STEP * by_rate, STEP * by_torque],
                [by_angle, by_rate, by_torque],
                [0.0, 0.0, 1.0],
            ];
            ([angle + STEP * after, after, torque], slope)
        }
    }

    fn inputs() -> impl Iterator<Item = f64> {
        (0..60).map(|k| libm::sin(0.4 * f64::from(k)))
    }

    /// Largest differences between the states and an observer's over the last 20 samples of 60.
    fn errors(settings: GaussNewtonSettings, torque: f64) -> [f64; 3] {
        let (mut state, mut observer) = ([0.3, -0.5, torque], GaussNewtonObserver::new([0.0; 3]));
        let mut largest = [0.0f64; 3];
        for (k, input) in inputs().enumerate() {
            if k > 0 {
                state = Pendulum.predict(&state, input);
            }
            observer.update(&Pendulum, &settings, state[0], input);
            if k >= 40 {
                largest = from_fn(|i| largest[i].max((state[i] - observer.state()[i]).abs()));
            }
        }
        largest
    }

    #[test]
    fn true_state_is_recovered_from_data_of_the_model() {
        for window in [3, 4, 12, 64, 1000] {
            let settings = GaussNewtonSettings { window, max_iterations: 20, estimated_states: 3 };
            let [angle, rate, torque] = errors(settings, 0.4);
            assert!(angle < 1e-10 && rate < 1e-9 && torque < 1e-8, "{window}: {angle:e} {rate:e} {torque:e}");
            let settings = GaussNewtonSettings { estimated_states: 2, ..settings };
            let [angle, rate, torque] = errors(settings, 0.0);
            assert!(angle < 1e-10 && rate < 1e-9 && torque == 0.0, "{window}: {angle:e} {rate:e} {torque:e}");
        }
        let ignorant = GaussNewtonSettings { window: 12, max_iterations: 20, estimated_states: 2 };
        assert!(errors(ignorant, 0.4)[1] > 1e-2);
    }

    #[test]
    fn solution_has_no_gradient() {
        // With measurements that no state explains: J^T (Y - H) = 0 at the least sum of squares.
        let settings = GaussNewtonSettings { window: 10, max_iterations: 50, estimated_states: 3 };
        let mut observer = GaussNewtonObserver::new([0.0; 3]);
        for (k, input) in inputs().enumerate() {
            let measured = 0.2 * libm::cos(0.5 * k as f64) + 0.01 * libm::sin(37.0 * k as f64);
            observer.update(&Pendulum, &settings, measured, input);
        }
        let problem = observer.linearise(&Pendulum);
        assert!(problem.right.iter().all(|component| component.abs() < 1e-9), "{:?}", problem.right);
        let newest = observer.state();
        assert!(newest.iter().zip(problem.newest).all(|(kept, again)| (kept - again).abs() < 1e-9));
    }

    #[test]
    fn what_the_samples_do_not_determine_is_no_step() {
        let problem = LeastSquares::<3>::at([0.0; 3]);
        assert_eq!(problem.solve(3), None);
    }
}
